#include "toolkit/mesh/subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/surface.h"

namespace mimetra {
namespace {

using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Edge = std::pair<VertexIndex, VertexIndex>;

Edge edge_of(VertexIndex a, VertexIndex b) {
  return std::minmax(a, b);
}

/// Triangles on representative vertices, with the neighbourhood of each edge and vertex.
struct Surroundings {
  Surface surface;
  /// Corners opposite to each edge that exactly two triangles share.
  std::map<Edge, std::array<VertexIndex, 2>> opposite;
  /// Neighbours of each vertex along border edges, ascending.
  std::vector<std::vector<VertexIndex>> along_border;

  Surroundings(int vertices, const Triangles& triangles)
      : surface(vertices, triangles), along_border(static_cast<std::size_t>(vertices)) {
    const auto corner = [&triangles](int side, int ahead) {
      return triangles(side / 3, (side + ahead) % 3);
    };
    EdgeSides(vertices, triangles).for_each_edge([&](std::span<const int> sides) {
      const Edge edge = edge_of(corner(sides[0], 0), corner(sides[0], 1));
      if (sides.size() == 2) {
        opposite[edge] = {corner(sides[0], 2), corner(sides[1], 2)};
      } else {
        along_border[static_cast<std::size_t>(edge.first)].push_back(edge.second);
        along_border[static_cast<std::size_t>(edge.second)].push_back(edge.first);
      }
    });
  }
};

/// Rows of a weight matrix, appended one after the other.
class WeightRows {
 public:
  using Row = std::vector<std::pair<VertexIndex, double>>;

  void add(const Row& row) {
    for (const auto& [vertex, weight] : row) entries_.emplace_back(rows_, vertex, weight);
    ++rows_;
  }
  int rows() const { return rows_; }
  Weights matrix(int columns) const {
    Weights weights(rows_, columns);
    weights.setFromTriplets(entries_.begin(), entries_.end());
    return weights;
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  int rows_ = 0;
};

/// Weight of each neighbour of an inner vertex that has `neighbors` neighbours.
double loop_weight(std::size_t neighbors) {
  const auto n = static_cast<double>(neighbors);
  const double inner = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4;
  return (5.0 / 8 - inner * inner) / n;
}

/// Weights that give the new place of a given vertex.
WeightRows::Row moved_vertex(VertexIndex vertex, const Surroundings& around,
                             SubdivisionScheme scheme) {
  const std::vector<VertexIndex> neighbors = around.surface.neighbors(vertex);
  const auto& border = around.along_border[static_cast<std::size_t>(vertex)];
  // A vertex stays if borders meet there or if it has no triangle.
  if (scheme == SubdivisionScheme::midpoint || neighbors.empty() ||
      (!border.empty() && border.size() != 2)) {
    return {{vertex, 1}};
  }
  if (!border.empty()) return {{vertex, 0.75}, {border[0], 0.125}, {border[1], 0.125}};
  const double weight = loop_weight(neighbors.size());
  WeightRows::Row row = {{vertex, 1 - weight * static_cast<double>(neighbors.size())}};
  for (const VertexIndex neighbor : neighbors) row.emplace_back(neighbor, weight);
  return row;
}

/// Weights that give the place of an edge's new vertex.
WeightRows::Row middle_of(const Edge& edge, const Surroundings& around, SubdivisionScheme scheme) {
  const auto across = around.opposite.find(edge);
  if (scheme == SubdivisionScheme::midpoint || across == around.opposite.end()) {
    return {{edge.first, 0.5}, {edge.second, 0.5}};
  }
  return {{edge.first, 3.0 / 8},
          {edge.second, 3.0 / 8},
          {across->second[0], 1.0 / 8},
          {across->second[1], 1.0 / 8}};
}

/// Numbers edges in the order in which they are first requested.
class EdgeNumbers {
 public:
  explicit EdgeNumbers(int first) : next_(first) {}

  /// Returns the edge's number and whether it is new.
  std::pair<int, bool> operator()(int a, int b) {
    const auto [found, is_new] = number_.try_emplace(edge_of(a, b), next_);
    if (is_new) ++next_;
    return {found->second, is_new};
  }

 private:
  std::map<Edge, int> number_;
  int next_;
};

/// Corners of the four triangles that replace a triangle. Its corners are 0 to 2, and the middle of
/// the edge from corner c is 3 + c.
constexpr int kFourTriangles[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};

/// Indices of the texture coordinates at each triangle's corners (3M); empty without a texture.
std::vector<int> texture_of_triangles(const Connectivity& mesh) {
  std::vector<int> corners;
  if (mesh.texture.coordinates.empty()) return corners;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto polygon =
        static_cast<std::size_t>(mesh.polygon_of_triangle[static_cast<std::size_t>(t)]);
    const int first = mesh.polygons.offsets[polygon], last = mesh.polygons.offsets[polygon + 1];
    for (int c = 0; c < 3; ++c) {
      const auto begin = mesh.polygons.corners.begin();
      const auto found = std::find(begin + first, begin + last, mesh.triangles(t, c));
      corners.push_back(mesh.texture.corners[static_cast<std::size_t>(found - begin)]);
    }
  }
  return corners;
}

TextureCoordinates finer_texture(const Connectivity& mesh) {
  TextureCoordinates texture;
  const std::vector<int> given = texture_of_triangles(mesh);
  if (given.empty()) return texture;
  texture.coordinates = mesh.texture.coordinates;
  EdgeNumbers middles(static_cast<int>(texture.coordinates.size()));
  for (std::size_t t = 0; t < given.size(); t += 3) {
    int six[6];
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = given[t + c], b = given[t + (c + 1) % 3];
      six[c] = a;
      six[3 + c] = -1;
      if (a < 0 || b < 0) continue;
      const auto [place, is_new] = middles(a, b);
      six[3 + c] = place;
      if (!is_new) continue;
      texture.coordinates.emplace_back((mesh.texture.coordinates[static_cast<std::size_t>(a)] +
                                        mesh.texture.coordinates[static_cast<std::size_t>(b)]) /
                                       2);
    }
    for (const auto& triangle : kFourTriangles) {
      for (const int corner : triangle) texture.corners.push_back(six[corner]);
    }
  }
  return texture;
}

std::vector<FaceGroup> finer_groups(const Connectivity& mesh) {
  std::vector<FaceGroup> groups = mesh.groups;
  for (FaceGroup& group : groups) {
    const auto first = std::ranges::lower_bound(mesh.polygon_of_triangle, group.first_face);
    group.first_face = 4 * static_cast<int>(first - mesh.polygon_of_triangle.begin());
  }
  return groups;
}

Subdivision subdivided_once(const Positions& rest, const Connectivity& mesh,
                            SubdivisionScheme scheme) {
  const Weld weld = Weld::exact(rest);
  const Surroundings around(mesh.vertices, weld.welded(mesh.triangles));
  const auto place = [&weld](VertexIndex v) {
    return weld.representative[static_cast<std::size_t>(v)];
  };
  WeightRows rows;
  for (VertexIndex v = 0; v < mesh.vertices; ++v) rows.add(moved_vertex(place(v), around, scheme));
  EdgeNumbers middles(mesh.vertices);
  Triangles triangles(4 * mesh.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    VertexIndex six[6];
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = mesh.triangles(t, c), b = mesh.triangles(t, (c + 1) % 3);
      const auto [middle, is_new] = middles(a, b);
      if (is_new) rows.add(middle_of(edge_of(place(a), place(b)), around, scheme));
      six[c] = a;
      six[3 + c] = middle;
    }
    for (int part = 0; part < 4; ++part) {
      for (int c = 0; c < 3; ++c) triangles(4 * t + part, c) = six[kFourTriangles[part][c]];
    }
  }
  Connectivity finer = Connectivity::from_triangles(rows.rows(), triangles);
  finer.texture = finer_texture(mesh);
  finer.groups = finer_groups(mesh);
  finer.materials = mesh.materials;
  return {rows.matrix(mesh.vertices), std::make_shared<const Connectivity>(std::move(finer))};
}

/// Frames whose vertices are weighted sums of another source's vertices.
class SummedFrames : public FrameSource {
 public:
  SummedFrames(std::shared_ptr<const FrameSource> source, const Subdivision& subdivision)
      : FrameSource(source->header()), source_(std::move(source)), weights_(subdivision.weights) {
    header_.connectivity = subdivision.connectivity;
    header_.rest = Positions(weights_ * header_.rest);
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const FrameBlock block(*source_, first + static_cast<int>(row), 1);
      Eigen::Map<Positions>(poses.row(row).data(), weights_.rows(), 3) = weights_ * block.frame(0);
    }
  }

  std::shared_ptr<const FrameSource> source_;
  Weights weights_;
};

}  // namespace

Subdivision subdivide(const Positions& rest, const Connectivity& connectivity,
                      const SubdivideOptions& options) {
  check_options(options);
  const double triangles =
      std::pow(4.0, options.times) * static_cast<double>(connectivity.triangles.rows());
  if (12 * triangles > std::numeric_limits<int>::max()) {
    throw std::invalid_argument("times: " + std::to_string(connectivity.triangles.rows()) +
                                " triangles would become more than can be counted");
  }
  Subdivision result = subdivided_once(rest, connectivity, options.scheme);
  Positions finer = result.weights * rest;
  for (int level = 1; level < options.times; ++level) {
    Subdivision next = subdivided_once(finer, *result.connectivity, options.scheme);
    finer = next.weights * finer;
    next.weights = Weights(next.weights * result.weights);
    result = std::move(next);
  }
  return result;
}

std::shared_ptr<const FrameSource> subdivided(std::shared_ptr<const FrameSource> source,
                                              const Subdivision& subdivision) {
  if (source->vertices() != subdivision.weights.cols()) {
    throw std::invalid_argument(std::to_string(source->vertices()) +
                                " vertices in the frames, expected " +
                                std::to_string(subdivision.weights.cols()));
  }
  return std::make_shared<const SummedFrames>(std::move(source), subdivision);
}

}  // namespace mimetra
