#include "toolkit/correspondence/renumbering.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "toolkit/correspondence/vertex_map.h"
#include "toolkit/mesh/disjoint_sets.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

int corners_of(const Polygons& polygons, int face) {
  return polygons.offsets[face + 1] - polygons.offsets[face];
}

/// `fine` with successive faces joined across shared edges, so that each face has as many corners
/// as in `coarse`. Empty if that is impossible.
std::optional<Polygons> joined_like(const Polygons& coarse, const Polygons& fine) {
  Polygons joined;
  int at = 0;
  for (int face = 0; face < coarse.size(); ++face) {
    // A polygon of c corners equals c - 2 triangles.
    int wanted = corners_of(coarse, face) - 2;
    const int first = at;
    for (; wanted > 0 && at < fine.size(); ++at) wanted -= corners_of(fine, at) - 2;
    if (wanted != 0) return {};
    std::vector<int> faces(static_cast<std::size_t>(at - first));
    std::iota(faces.begin(), faces.end(), first);
    const std::vector<VertexIndex> cycle = outline(fine, faces);
    if (static_cast<int>(cycle.size()) != corners_of(coarse, face)) return {};
    joined.corners.insert(joined.corners.end(), cycle.begin(), cycle.end());
    joined.offsets.push_back(static_cast<int>(joined.corners.size()));
  }
  if (at != fine.size()) return {};
  return joined;
}

/// Below this share of the squared distances, a fit's residual is rounding.
constexpr double kFitRounding = 1e-9;

std::string counted(const MapSide& side) {
  return std::to_string(side.vertices) + " vertices and " + std::to_string(side.polygons->size()) +
         " faces";
}

Renumbering without_map(std::string why) {
  Renumbering result;
  result.why_not = std::move(why);
  return result;
}

Renumbering with_map(std::vector<VertexIndex> vertices) {
  Renumbering result;
  result.vertices = std::move(vertices);
  return result;
}

Renumbering by_graph(const MapSide& from, const MapSide& to) {
  FoundMap found = map_by_graph(from, to);
  return found.why_not.empty() ? with_map(std::move(found.vertices)) : without_map(found.why_not);
}

/// Returns true if a mirror image of `from` fits the images of its vertices clearly better than
/// `from` itself. Both are placed by their best similarity. [Umeyama 1991]
bool is_mirrored(const std::vector<VertexIndex>& image, const MapSide& from, const MapSide& to) {
  const auto centred = [](const Positions& positions) -> Eigen::MatrixXd {
    return positions.rowwise() - positions.colwise().mean();
  };
  const Eigen::MatrixXd a = centred(*from.positions);
  const Eigen::MatrixXd b = centred((*to.positions)(image, Eigen::all));
  const Eigen::Matrix3d products = a.transpose() * b;
  const Eigen::Vector3d sizes = Eigen::JacobiSVD<Eigen::Matrix3d>(products).singularValues();
  const double turn = products.determinant() < 0 ? -sizes[2] : sizes[2];
  const double straight = sizes[0] + sizes[1] + turn, mirrored = sizes[0] + sizes[1] - turn;
  const double whole = a.squaredNorm() * b.squaredNorm();
  const double left = whole - straight * straight, left_mirrored = whole - mirrored * mirrored;
  return left > kFitRounding * whole && kClearlyFarther * kClearlyFarther * left_mirrored < left;
}

/// Faces with the opposite orientation.
Polygons turned_round(Polygons polygons) {
  for (int f = 0; f < polygons.size(); ++f) {
    std::reverse(polygons.corners.begin() + polygons.offsets[f],
                 polygons.corners.begin() + polygons.offsets[f + 1]);
  }
  return polygons;
}

/// Map by the graph, unless the faces' orientation is opposite. A symmetric face then has a map
/// that exchanges left and right.
Renumbering by_graph_and_sides(const MapSide& from, const MapSide& to) {
  Renumbering found = by_graph(from, to);
  if (found.found() && !(from.positions && is_mirrored(found.vertices, from, to))) return found;
  const Polygons turned = turned_round(*to.polygons);
  if (!by_graph(from, {&turned, to.vertices, to.positions}).found()) return found;
  return without_map("the same faces, but they lead the other way round (inside out): turn them");
}

/// Lowest vertex of each vertex's connected part (N).
std::vector<VertexIndex> parts_of(const MapSide& side) {
  DisjointSets sets(side.vertices);
  for (int f = 0; f < side.polygons->size(); ++f) {
    const int begin = side.polygons->offsets[f], end = side.polygons->offsets[f + 1];
    for (int corner = begin; corner < end; ++corner) {
      sets.join(side.polygons->corners[begin], side.polygons->corners[corner]);
    }
  }
  std::vector<VertexIndex> parts;
  parts.reserve(static_cast<std::size_t>(side.vertices));
  for (VertexIndex v = 0; v < side.vertices; ++v) parts.push_back(sets.lowest(v));
  return parts;
}

/// Returns true if the image of some part is farther away than the part is large. The distance is
/// between centres after the similarity of all vertices. The size is the root mean square distance
/// from the centre.
bool has_part_elsewhere(const std::vector<VertexIndex>& image, const MapSide& from,
                        const MapSide& to) {
  const Positions carried = told_by(image, from, to).apply(*from.positions);
  const Positions images = (*to.positions)(image, Eigen::all);
  const std::vector<VertexIndex> parts = parts_of(from);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(from.vertices), squares = counts;
  Positions centres = Positions::Zero(from.vertices, 3), ways = centres;
  for (VertexIndex v = 0; v < from.vertices; ++v) {
    counts[parts[v]] += 1;
    centres.row(parts[v]) += carried.row(v);
    ways.row(parts[v]) += images.row(v) - carried.row(v);
  }
  for (VertexIndex v = 0; v < from.vertices; ++v) {
    squares[parts[v]] += (carried.row(v) - centres.row(parts[v]) / counts[parts[v]]).squaredNorm();
  }
  for (VertexIndex part = 0; part < from.vertices; ++part) {
    if (counts[part] > 1 && ways.row(part).squaredNorm() > counts[part] * squares[part])
      return true;
  }
  return false;
}

/// Map by the order of faces, unless it exchanges parts that positions distinguish. Examples are
/// two eyes of one shape, or triangles that share no vertex, in another order.
Renumbering in_order_or_by_places(std::vector<VertexIndex> in_order, const MapSide& from,
                                  const MapSide& to) {
  if (from.positions && has_part_elsewhere(in_order, from, to)) {
    Renumbering found = by_graph(from, to);
    if (found.found() && !has_part_elsewhere(found.vertices, from, to)) return found;
  }
  return with_map(std::move(in_order));
}

/// Map of meshes whose coinciding vertices are not welded.
Renumbering by_faces_or_graph(const MapSide& reference, const MapSide& other) {
  MapSide from = reference, to = other;
  std::optional<Polygons> joined;
  if (from.polygons->size() < to.polygons->size()) {
    joined = joined_like(*from.polygons, *to.polygons);
    if (joined) to.polygons = &*joined;
  } else if (from.polygons->size() > to.polygons->size()) {
    joined = joined_like(*to.polygons, *from.polygons);
    if (joined) from.polygons = &*joined;
  }
  if (from.vertices != to.vertices || from.polygons->size() != to.polygons->size() ||
      from.polygons->corners.size() != to.polygons->corners.size()) {
    return without_map("another mesh: " + counted(other) + ", expected " + counted(reference));
  }
  std::optional<std::vector<VertexIndex>> in_order = map_by_corners(from, to);
  if (!in_order) in_order = map_by_faces(from, to);
  Renumbering result = in_order ? in_order_or_by_places(std::move(*in_order), from, to)
                                : by_graph_and_sides(from, to);
  result.splits = joined && result.found();
  return result;
}

/// Mesh with coinciding vertices welded, numbered by their lowest vertex.
struct WeldedMesh {
  explicit WeldedMesh(const TriMesh& mesh) : weld(Weld::exact(mesh.positions)) {
    number.resize(weld.representative.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
      const VertexIndex lowest = weld.representative[v];
      if (lowest == static_cast<VertexIndex>(v)) {
        number[v] = static_cast<VertexIndex>(vertices.size());
        vertices.push_back(lowest);
      } else {
        number[v] = number[lowest];
      }
    }
    positions = mesh.positions(vertices, Eigen::all);
    polygons = mesh.connectivity.polygons;
    for (VertexIndex& corner : polygons.corners) corner = number[corner];
  }

  MapSide side() const { return {&polygons, static_cast<int>(vertices.size()), &positions}; }

  Weld weld;
  std::vector<VertexIndex> number;    ///< welded number of each vertex
  std::vector<VertexIndex> vertices;  ///< lowest vertex of each welded number
  Positions positions;
  Polygons polygons;
};

Renumbering by_places(const TriMesh& reference, const TriMesh& other) {
  const WeldedMesh from(reference), to(other);
  if (from.weld.count == 0 && to.weld.count == 0) return without_map("no seams");
  Renumbering welded = by_faces_or_graph(from.side(), to.side());
  if (!welded.found()) return welded;
  Renumbering result;
  result.splits = welded.splits;
  result.seams = true;
  for (const VertexIndex number : from.number) {
    result.vertices.push_back(to.vertices[welded.vertices[number]]);
  }
  return result;
}

void check_positions(const TriMesh& mesh, const char* name) {
  if (mesh.positions.rows() != mesh.connectivity.vertices) {
    throw std::invalid_argument(std::string(name) + ": " + std::to_string(mesh.positions.rows()) +
                                " positions for " + std::to_string(mesh.connectivity.vertices) +
                                " vertices");
  }
  if (!mesh.positions.allFinite()) {
    throw std::invalid_argument(std::string(name) + ": a position is not finite");
  }
}

MapSide side_of(const Connectivity& connectivity, const Positions* positions = nullptr) {
  return {&connectivity.polygons, connectivity.vertices, positions};
}

class RenumberedFrames : public FrameSource {
 public:
  RenumberedFrames(std::shared_ptr<const FrameSource> source,
                   std::shared_ptr<const Connectivity> connectivity,
                   std::vector<VertexIndex> vertices)
      : FrameSource(source->header()), source_(std::move(source)), vertices_(std::move(vertices)) {
    header_.connectivity = std::move(connectivity);
    header_.rest = Positions(header_.rest(vertices_, Eigen::all));
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    const FrameBlock block(*source_, first, static_cast<int>(poses.rows()));
    for (int row = 0; row < block.frames(); ++row) {
      Eigen::Map<Positions>(poses.row(row).data(), poses.cols() / 3, 3) =
          block.frame(row)(vertices_, Eigen::all);
    }
  }

  std::shared_ptr<const FrameSource> source_;
  std::vector<VertexIndex> vertices_;
};

}  // namespace

int Renumbering::moved() const {
  int count = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v] != static_cast<VertexIndex>(v)) ++count;
  }
  return count;
}

std::string Renumbering::summary() const {
  if (!found()) return why_not;
  std::string text = "the same faces";
  if (splits) text += " but for polygons that one of them splits";
  if (seams) text += splits ? " and seams" : " but for seams";
  if (seams) text += " along which one of them has its vertices twice";
  if (moved() > 0) {
    text +=
        ", " + std::to_string(moved()) + (moved() == 1 ? " vertex" : " vertices") + " renumbered";
  }
  return text;
}

Renumbering renumbering(const Connectivity& reference, const Connectivity& other) {
  return by_faces_or_graph(side_of(reference), side_of(other));
}

Renumbering renumbering(const TriMesh& reference, const TriMesh& other) {
  check_positions(reference, "the reference");
  check_positions(other, "the other mesh");
  Renumbering found = by_faces_or_graph(side_of(reference.connectivity, &reference.positions),
                                        side_of(other.connectivity, &other.positions));
  if (found.found()) return found;
  Renumbering welded = by_places(reference, other);
  return welded.found() ? welded : found;
}

std::shared_ptr<const FrameSource> renumbered(std::shared_ptr<const FrameSource> source,
                                              std::shared_ptr<const Connectivity> connectivity,
                                              std::vector<VertexIndex> vertices) {
  const bool are_there = std::ranges::all_of(
      vertices, [&source](VertexIndex v) { return v >= 0 && v < source->vertices(); });
  if (static_cast<int>(vertices.size()) != connectivity->vertices || !are_there) {
    throw std::invalid_argument("expected a vertex of the source for each of " +
                                std::to_string(connectivity->vertices) + " vertices");
  }
  return std::make_shared<const RenumberedFrames>(std::move(source), std::move(connectivity),
                                                  std::move(vertices));
}

Field renumbered(const Field& field, const std::vector<VertexIndex>& vertices) {
  Field result = field;
  result.values = field.values(vertices, Eigen::all);
  return result;
}

}  // namespace mimetra
