#include "toolkit/mesh/simplification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/pose_decimation.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

using Vector = Eigen::Vector3d;

/// Number of frames besides the rest pose: those whose planes count, and those checked for folds.
constexpr int kPlanePoses = 5, kExtremePoses = 12;
/// Approximate number of vertices used to compare frames.
constexpr int kSamples = 500;
/// Number of rounds, and of frames with folds that join the poses after each round.
constexpr int kRounds = 3, kFoldedPoses = 4;

/// Surface on which the collapses work, with tables of its half-edges.
struct Sheets {
  Surface surface;
  /// Given vertex of each of the surface's vertices.
  std::vector<VertexIndex> given;
  /// Corners of each triangle (M x 3) as vertices of the surface; as given if it is left out.
  Triangles triangles;
};

Sheets sheets_of(const Connectivity& mesh) {
  Sheets sheets{{mesh.vertices, mesh.triangles}, {}, mesh.triangles};
  const Surface::HalfEdges& half_edges = sheets.surface.half_edges();
  for (const auto v : half_edges.vertices()) sheets.given.push_back(sheets.surface.vertex_of(v));
  for (const auto face : half_edges.faces()) {
    int corner = 0;
    for (const auto h : half_edges.fh_range(face)) {
      sheets.triangles(face.idx(), corner++) = h.from().idx();
    }
  }
  return sheets;
}

/// Charts of a texture. Polygons with the same coordinates at a common vertex share a chart,
/// directly or through others.
struct TextureCharts {
  /// Chart of each polygon; empty without a texture.
  std::vector<int> of_polygon;
  /// Pairs of chart and coordinates at each vertex (N): several at seams, otherwise one.
  std::vector<std::set<std::pair<int, int>>> of_vertex;
};

TextureCharts charts_of(const Connectivity& mesh) {
  TextureCharts charts;
  charts.of_vertex.resize(static_cast<std::size_t>(mesh.vertices));
  if (mesh.texture.corners.empty()) return charts;
  const Polygons& polygons = mesh.polygons;
  const auto for_corners = [&](int polygon, const auto& visit) {
    const auto p = static_cast<std::size_t>(polygon);
    for (auto c = std::size_t(polygons.offsets[p]); c < std::size_t(polygons.offsets[p + 1]); ++c) {
      visit(std::pair(polygons.corners[c], mesh.texture.corners[c]));
    }
  };
  std::map<std::pair<int, int>, std::vector<int>> around;
  for (int polygon = 0; polygon < polygons.size(); ++polygon) {
    for_corners(polygon, [&](const auto& corner) { around[corner].push_back(polygon); });
  }
  charts.of_polygon.assign(static_cast<std::size_t>(polygons.size()), -1);
  int chart = 0;
  for (int first = 0; first < polygons.size(); ++first) {
    std::vector<int> open;
    const auto reach = [&](int polygon) {
      int& known = charts.of_polygon[static_cast<std::size_t>(polygon)];
      if (known >= 0) return;
      known = chart;
      open.push_back(polygon);
    };
    reach(first);
    if (open.empty()) continue;
    while (!open.empty()) {
      const int polygon = open.back();
      open.pop_back();
      for_corners(polygon, [&](const auto& corner) {
        charts.of_vertex[static_cast<std::size_t>(corner.first)].emplace(chart, corner.second);
        std::ranges::for_each(around[corner], reach);
      });
    }
    ++chart;
  }
  return charts;
}

/// Whether each vertex of the input must be kept (N).
std::vector<bool> locked_vertices(const FrameSource& sequence, const Surface& surface,
                                  const TextureCharts& charts) {
  const auto count = static_cast<std::size_t>(sequence.vertices());
  std::vector<int> at_place(count, 0);
  const Weld weld = Weld::exact(sequence.rest());
  for (const VertexIndex v : weld.representative) ++at_place[static_cast<std::size_t>(v)];
  std::vector<bool> locked(count);
  for (std::size_t v = 0; v < count; ++v) {
    const auto place = static_cast<std::size_t>(weld.representative[v]);
    const auto vertex = static_cast<VertexIndex>(v);
    locked[v] = surface.half_edges().is_isolated(OpenMesh::VertexHandle(vertex)) ||
                surface.copies_of(vertex).size() > 1 || at_place[place] > 1 ||
                charts.of_vertex[v].size() > 1;
  }
  return locked;
}

/// Positions of the surface's vertices in a frame, relative to `middle` and times `scale`.
Positions on_surface(const PositionsView& pose, const Sheets& sheets, const Vector& middle,
                     double scale) {
  Positions result = pose(sheets.given, Eigen::all);
  result.rowwise() -= middle.transpose();
  return result * scale;
}

/// Frames that differ most from the rest pose and from each other, most different first.
std::vector<int> extreme_frames(const FrameSource& sequence, const Context& context) {
  std::vector<VertexIndex> sample;
  const int step = std::max(1, sequence.vertices() / kSamples);
  for (VertexIndex v = 0; v < sequence.vertices(); v += step) sample.push_back(v);
  const auto count = static_cast<Eigen::Index>(sample.size());
  Eigen::MatrixXd poses(sequence.frames(), 3 * count);
  for_each_block(
      sequence,
      [&](int first, const Frames& block) {
        for (Eigen::Index row = 0; row < block.rows(); ++row) {
          const PositionsView pose(block.row(row).data(), sequence.vertices(), 3);
          poses.row(first + row) = Positions(pose(sample, Eigen::all)).reshaped<Eigen::RowMajor>();
        }
      },
      context);
  const Eigen::RowVectorXd rest =
      Positions(sequence.rest()(sample, Eigen::all)).reshaped<Eigen::RowMajor>().transpose();
  Eigen::VectorXd farthest = (poses.rowwise() - rest).rowwise().squaredNorm();
  std::vector<int> frames;
  while (static_cast<int>(frames.size()) < kExtremePoses) {
    Eigen::Index next = 0;
    if (!(farthest.maxCoeff(&next) > 0)) break;
    frames.push_back(static_cast<int>(next));
    farthest = farthest.cwiseMin((poses.rowwise() - poses.row(next)).rowwise().squaredNorm());
  }
  return frames;
}

/// Triangles made by collapses that are turned over, unlike the given triangle they come from.
struct Folds {
  std::vector<int> in_frame;   ///< number of such triangles in each frame (F)
  std::vector<bool> triangle;  ///< whether each row of `corners` is such a triangle in some frame
};

Folds folds_of(const FrameSource& sequence, const Sheets& sheets, const CollapsedSurface& mesh,
               const Context& context) {
  std::vector<int> made;
  for (Eigen::Index i = 0; i < mesh.corners.rows(); ++i) {
    auto before = std::array<int, 3>{}, after = std::array<int, 3>{};
    for (int c = 0; c < 3; ++c) {
      before[std::size_t(c)] = sheets.triangles(mesh.triangles[std::size_t(i)], c);
      after[std::size_t(c)] = mesh.corners(i, c);
    }
    std::ranges::sort(before);
    std::ranges::sort(after);
    if (before != after) made.push_back(static_cast<int>(i));
  }
  Folds folds;
  folds.in_frame.resize(static_cast<std::size_t>(sequence.frames()), 0);
  std::vector<std::vector<int>> folded(folds.in_frame.size());
  for_each_block(
      sequence,
      [&](int first, const Frames& poses) {
        for (Eigen::Index row = 0; row < poses.rows(); ++row) {
          const Positions pose =
              on_surface(PositionsView(poses.row(row).data(), sequence.vertices(), 3), sheets,
                         Vector::Zero(), 1);
          const Positions normals = vertex_normals(pose, sheets.triangles).rowwise().normalized();
          for (const int i : made) {
            const auto is_turned = [&](const auto& c) {
              const Vector around = normals.row(c[0]) + normals.row(c[1]) + normals.row(c[2]);
              return agreement(pose.row(c[0]), pose.row(c[1]), pose.row(c[2]), around) <= 0;
            };
            if (!is_turned(mesh.corners.row(i))) continue;
            // The given triangle may also be turned over, for example when an eyelid closes.
            if (is_turned(sheets.triangles.row(mesh.triangles[std::size_t(i)]))) continue;
            folded[static_cast<std::size_t>(first + row)].push_back(i);
          }
        }
      },
      context);
  folds.triangle.resize(static_cast<std::size_t>(mesh.corners.rows()));
  for (std::size_t f = 0; f < folded.size(); ++f) {
    folds.in_frame[f] = static_cast<int>(folded[f].size());
    for (const int i : folded[f]) folds.triangle[static_cast<std::size_t>(i)] = true;
  }
  return folds;
}

/// Frames with the most folds, in descending order.
std::vector<int> worst_frames(const std::vector<int>& folds) {
  std::vector<int> frames(folds.size());
  std::iota(frames.begin(), frames.end(), 0);
  std::ranges::stable_sort(
      frames, [&folds](int a, int b) { return folds[std::size_t(a)] > folds[std::size_t(b)]; });
  const auto none =
      std::ranges::find_if(frames, [&folds](int frame) { return folds[std::size_t(frame)] == 0; });
  frames.erase(none, frames.end());
  frames.resize(std::min<std::size_t>(frames.size(), kFoldedPoses));
  return frames;
}

/// Locks the surface's vertices around the corners of folded triangles.
void keep_around(const Folds& folds, const CollapsedSurface& mesh, const Sheets& sheets,
                 std::vector<bool>& locked) {
  std::vector<bool> near(locked.size(), false);
  for (Eigen::Index i = 0; i < mesh.corners.rows(); ++i) {
    if (!folds.triangle[std::size_t(i)]) continue;
    for (const int v : mesh.corners.row(i)) near[std::size_t(v)] = true;
  }
  for (const auto& t : sheets.triangles.rowwise()) {
    if (!near[std::size_t(t[0])] && !near[std::size_t(t[1])] && !near[std::size_t(t[2])]) continue;
    for (const int v : t) locked[std::size_t(v)] = true;
  }
}

/// Builds the connectivity of the simplified mesh.
class Remaining {
 public:
  Remaining(const Connectivity& mesh, const Sheets& sheets, const CollapsedSurface& left,
            const TextureCharts& charts)
      : mesh_(mesh),
        left_(left),
        charts_(charts),
        corners_(left.corners.unaryExpr(
            [&sheets](VertexIndex v) { return sheets.given[std::size_t(v)]; })) {
    for (std::size_t i = 0; i < left.triangles.size(); ++i) {
      if (std::ranges::binary_search(sheets.surface.turned(), left.triangles[i])) {
        corners_.row(Eigen::Index(i)).reverseInPlace();
      }
    }
  }

  /// Vertices of the input that are kept, ascending.
  std::vector<VertexIndex> vertices() const {
    std::vector<VertexIndex> vertices;
    for (VertexIndex v = 0; v < mesh_.vertices; ++v) {
      if (left_.kept[std::size_t(v)]) vertices.push_back(v);
    }
    return vertices;
  }

  std::shared_ptr<const Connectivity> connectivity(const std::vector<VertexIndex>& vertices) const {
    std::vector<VertexIndex> number(static_cast<std::size_t>(mesh_.vertices), -1);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      number[std::size_t(vertices[i])] = static_cast<VertexIndex>(i);
    }
    Connectivity made = Connectivity::from_triangles(
        static_cast<int>(vertices.size()),
        corners_.unaryExpr([&number](VertexIndex v) { return number[std::size_t(v)]; }));
    made.materials = mesh_.materials;
    add_texture(made);
    add_groups(made);
    return std::make_shared<const Connectivity>(std::move(made));
  }

 private:
  int polygon(std::size_t i) const {
    return mesh_.polygon_of_triangle[std::size_t(left_.triangles[i])];
  }

  /// Texture coordinates of a vertex in the polygon's chart: the polygon's own at its corners,
  /// elsewhere those nearest to the middle of the polygon's coordinates.
  int texture_at(VertexIndex vertex, int polygon) const {
    const TextureCoordinates& texture = mesh_.texture;
    const auto p = static_cast<std::size_t>(polygon);
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    int corners = 0;
    for (int c = mesh_.polygons.offsets[p]; c < mesh_.polygons.offsets[p + 1]; ++c) {
      const int own = texture.corners[std::size_t(c)];
      if (mesh_.polygons.corners[std::size_t(c)] == vertex) return own;
      if (own < 0) continue;
      middle += texture.coordinates[std::size_t(own)];
      ++corners;
    }
    middle /= std::max(1, corners);
    // Coordinates in the polygon's chart come before others.
    const auto distance = [&](const std::pair<int, int>& at) {
      const double apart =
          at.second < 0 ? HUGE_VAL
                        : (texture.coordinates[std::size_t(at.second)] - middle).squaredNorm();
      return std::pair(at.first != charts_.of_polygon[p], apart);
    };
    const auto& known = charts_.of_vertex[std::size_t(vertex)];
    return known.empty() ? -1 : std::ranges::min_element(known, {}, distance)->second;
  }

  void add_texture(Connectivity& made) const {
    if (mesh_.texture.coordinates.empty()) return;
    std::map<int, int> number;
    for (std::size_t i = 0; i < left_.triangles.size(); ++i) {
      for (const VertexIndex v : corners_.row(static_cast<Eigen::Index>(i))) {
        const int given = texture_at(v, polygon(i));
        const auto [place, is_new] =
            number.try_emplace(given, int(made.texture.coordinates.size()));
        if (given < 0) place->second = -1;
        if (given >= 0 && is_new) {
          made.texture.coordinates.push_back(mesh_.texture.coordinates[std::size_t(given)]);
        }
        made.texture.corners.push_back(place->second);
      }
    }
  }

  /// Copies group statements; those of removed faces move to the next remaining face.
  void add_groups(Connectivity& made) const {
    std::size_t face = 0;
    for (const FaceGroup& group : mesh_.groups) {
      while (face < left_.triangles.size() && polygon(face) < group.first_face) ++face;
      made.groups.push_back({static_cast<int>(face), group.statement});
    }
  }

  const Connectivity& mesh_;
  const CollapsedSurface& left_;
  const TextureCharts& charts_;
  Triangles corners_;  // corners of the remaining triangles as given vertices, wound as given
};

}  // namespace

Simplification simplify(const FrameSource& sequence, const SimplifyOptions& options,
                        const Context& context) {
  check_options(options);
  const Sheets sheets = sheets_of(sequence.connectivity());
  const TextureCharts charts = charts_of(sequence.connectivity());
  const std::vector<bool> locked = locked_vertices(sequence, sheets.surface, charts);
  std::vector<bool> staying;
  for (const VertexIndex v : sheets.given) staying.push_back(locked[std::size_t(v)]);
  const Vector middle = sequence.rest().colwise().mean();
  const double size = sequence.diameter(), scale = size > 0 ? 1 / size : 1;
  DecimationPoses poses;
  const auto add = [&](const PositionsView& pose) {
    poses.add(on_surface(pose, sheets, middle, scale), sheets.triangles);
  };
  add(PositionsView(sequence.rest().data(), sequence.vertices(), 3));
  for (const int frame : extreme_frames(sequence, context.part(0, 0.1))) {
    add(FrameBlock(sequence, frame, 1).frame(0));
  }
  poses.planes = std::min(1 + kPlanePoses, static_cast<int>(poses.positions.size()));
  const auto wanted = static_cast<int>(std::ceil(options.share * sequence.vertices()));
  const auto collapses = static_cast<std::size_t>(std::max(0, sequence.vertices() - wanted));
  CollapsedSurface left;
  Folds folds;
  for (int round = 0; round < kRounds; ++round) {
    const double from = 0.1 + 0.9 * round / kRounds;
    left = collapsed(sheets.surface, poses, staying, collapses,
                     context.part(from, from + 0.5 / kRounds));
    folds =
        folds_of(sequence, sheets, left, context.part(from + 0.5 / kRounds, from + 0.9 / kRounds));
    const std::vector<int> frames = worst_frames(folds.in_frame);
    if (frames.empty()) break;
    keep_around(folds, left, sheets, staying);
    for (const int frame : frames) add(FrameBlock(sequence, frame, 1).frame(0));
  }
  const Remaining remaining(sequence.connectivity(), sheets, left, charts);
  Simplification result;
  result.vertices = remaining.vertices();
  result.connectivity = remaining.connectivity(result.vertices);
  result.locked = static_cast<int>(std::ranges::count(locked, true));
  result.folded = static_cast<int>(std::ranges::count(folds.triangle, true));
  context.report(1);
  return result;
}

}  // namespace mimetra
