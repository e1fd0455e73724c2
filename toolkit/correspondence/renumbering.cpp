#include "toolkit/correspondence/renumbering.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "toolkit/correspondence/face_graph.h"
#include "toolkit/correspondence/polygon_split.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Of two maps of one part the nearer one is taken where the other is this many times as far.
constexpr double kClearlyFarther = 2;

/// What a fit leaves of the squared distances is rounding below this share.
constexpr double kFitRounding = 1e-9;

/// Half-edges that are followed in all for one part before it counts as too symmetric.
constexpr double kMostWork = 1e8;

/// A map of half-edges and vertices that grows by whole parts.
class GraphMap {
 public:
  /// With `keeps_faces` each face goes to that of its number only.
  GraphMap(const FaceGraph& from, int from_vertices, const FaceGraph& to, int to_vertices,
           bool keeps_faces)
      : from_(from),
        to_(to),
        keeps_faces_(keeps_faces),
        image_(from.size(), -1),
        preimage_(to.size(), -1),
        vertex_image_(from_vertices, -1),
        vertex_preimage_(to_vertices, -1) {}

  const std::vector<VertexIndex>& vertices() const { return vertex_image_; }
  const std::vector<VertexIndex>& preimages() const { return vertex_preimage_; }

  /// Maps the part of `half_edge` so that this goes to `image`. False where that does not fit; then
  /// nothing changes.
  bool grow(int half_edge, int image) {
    added_.clear();
    added_vertices_.clear();
    if (add(half_edge, image)) {
      std::size_t done = 0;
      bool fits = true;
      for (; fits && done < added_.size(); ++done) fits = follow(added_[done]);
      if (fits) return true;
    }
    undo();
    return false;
  }

  /// Takes the last part back.
  void undo() {
    for (const int h : added_) preimage_[std::exchange(image_[h], -1)] = -1;
    for (const VertexIndex v : added_vertices_) {
      vertex_preimage_[std::exchange(vertex_image_[v], -1)] = -1;
    }
  }

  /// Half-edges and vertices of the last part.
  const std::vector<int>& added() const { return added_; }
  const std::vector<VertexIndex>& added_vertices() const { return added_vertices_; }

 private:
  bool add(int h, int g) {
    if (image_[h] >= 0 || preimage_[g] >= 0) return image_[h] == g;
    if (from_.kind[h] != to_.kind[g]) return false;
    if (keeps_faces_ && from_.face[h] != to_.face[g]) return false;
    const VertexIndex v = from_.vertex[h], w = to_.vertex[g];
    if (vertex_image_[v] < 0 && vertex_preimage_[w] < 0) {
      vertex_image_[v] = w;
      vertex_preimage_[w] = v;
      added_vertices_.push_back(v);
    } else if (vertex_image_[v] != w) {
      return false;
    }
    image_[h] = g;
    preimage_[g] = h;
    added_.push_back(h);
    return true;
  }

  bool follow(int h) {
    const int g = image_[h];
    return add(from_.next[h], to_.next[g]) &&
           (from_.opposite[h] < 0 || add(from_.opposite[h], to_.opposite[g]));
  }

  const FaceGraph& from_;
  const FaceGraph& to_;
  bool keeps_faces_;
  std::vector<int> image_, preimage_;
  std::vector<VertexIndex> vertex_image_, vertex_preimage_;
  std::vector<int> added_;
  std::vector<VertexIndex> added_vertices_;
};

/// What one of the two meshes is in the search.
struct Side {
  const Polygons* polygons;
  int vertices;
  const Positions* positions;  ///< null where positions may not decide
};

/// The similarity from `from` to `to` that the vertices with an image tell; the identity where they
/// tell none.
Similarity told_by(const std::vector<VertexIndex>& image, const Side& from, const Side& to) {
  std::vector<VertexIndex> known, images;
  for (VertexIndex v = 0; v < from.vertices; ++v) {
    if (image[v] < 0) continue;
    known.push_back(v);
    images.push_back(image[v]);
  }
  try {
    if (known.size() > 3) {
      return similarity_fit((*from.positions)(known, Eigen::all),
                            (*to.positions)(images, Eigen::all));
    }
  } catch (const MismatchError&) {
    // Points on a line tell no similarity.
  }
  return {};
}

/// Vertices that no face holds are paired in ascending order, each with the nearest one left where
/// positions may decide. \pre as many in both meshes
std::vector<VertexIndex> with_loose(std::vector<VertexIndex> image,
                                    const std::vector<VertexIndex>& preimage, const Side& from,
                                    const Side& to) {
  std::vector<VertexIndex> left;
  for (VertexIndex w = 0; w < to.vertices; ++w) {
    if (preimage[w] < 0) left.push_back(w);
  }
  if (left.empty()) return image;
  Positions carried;
  if (from.positions) carried = told_by(image, from, to).apply(*from.positions);
  for (VertexIndex v = 0; v < from.vertices; ++v) {
    if (image[v] >= 0) continue;
    const auto distance = [&](VertexIndex w) {
      return from.positions ? (carried.row(v) - to.positions->row(w)).squaredNorm() : 0;
    };
    const auto nearest = std::ranges::min_element(left, {}, distance);
    image[v] = *nearest;
    left.erase(nearest);
  }
  return image;
}

/// Finds the images of one part after another.
class Search {
 public:
  /// Half-edges of the other mesh that may be the image of one.
  using Candidates = std::function<std::vector<int>(int)>;

  Search(Side from, Side to, bool keeps_faces)
      : from_(from),
        to_(to),
        graph_(*from.polygons),
        other_(*to.polygons),
        map_(graph_, from.vertices, other_, to.vertices, keeps_faces) {}

  const FaceGraph& graph() const { return graph_; }
  const FaceGraph& other() const { return other_; }

  /// Why there is no map; empty where vertices() has it.
  std::string run(const std::vector<int>& starts, const Candidates& candidates) {
    std::vector<int> left = starts;
    while (!left.empty()) {
      // Parts that touch one with a known image may have one map only: again until nothing changes.
      const std::size_t before = left.size();
      std::vector<int> open;
      for (const int start : left) {
        const std::vector<int> images = fitting(start, candidates(start));
        if (images.empty())
          return "another mesh: nothing in it is joined and bounded as the faces around " +
                 at(start);
        if (images.size() == 1) {
          map_.grow(start, images.front());
        } else {
          open.push_back(start);
        }
      }
      left = std::move(open);
      if (left.size() == before) return decide_by_positions(left, candidates);
    }
    return {};
  }

  std::vector<VertexIndex> vertices() const {
    return with_loose(map_.vertices(), map_.preimages(), from_, to_);
  }

 private:
  std::string at(int half_edge) const {
    return "face " + std::to_string(graph_.face[half_edge]) + " of the reference";
  }

  /// The first images of `start` that fit, up to two.
  std::vector<int> fitting(int start, const std::vector<int>& candidates) {
    std::vector<int> images;
    for (const int candidate : candidates) {
      if (!map_.grow(start, candidate)) continue;
      map_.undo();
      images.push_back(candidate);
      if (images.size() == 2) break;
    }
    return images;
  }

  /// How far the vertices of the last part are from their images: sum of squares.
  double distance(const Positions& carried) const {
    double sum = 0;
    for (const VertexIndex v : map_.added_vertices()) {
      sum += (carried.row(v) - to_.positions->row(map_.vertices()[v])).squaredNorm();
    }
    return sum;
  }

  /// The image of `start` that is clearly nearer than all others; -1 where none is.
  int nearest_image(int start, const std::vector<int>& candidates, const Positions& carried) {
    int nearest = -1;
    double least = std::numeric_limits<double>::infinity(), second = least, work = 0;
    for (const int image : candidates) {
      if (!map_.grow(start, image)) continue;
      const double far = distance(carried);
      work += static_cast<double>(map_.added().size());
      map_.undo();
      if (work > kMostWork) return -1;
      if (far < least) nearest = image;
      second = std::min(second, std::max(far, least));
      least = std::min(least, far);
    }
    return second > kClearlyFarther * kClearlyFarther * least ? nearest : -1;
  }

  std::string decide_by_positions(const std::vector<int>& starts, const Candidates& candidates) {
    const std::string several = "perhaps the same mesh: more than one map of the part around ";
    if (!from_.positions) return several + at(starts.front()) + " fits: it is symmetric";
    const Positions carried = told_by(map_.vertices(), from_, to_).apply(*from_.positions);
    for (const int start : starts) {
      const int image = nearest_image(start, candidates(start), carried);
      if (image < 0) {
        return several + at(start) + " fits: it is symmetric, and positions do not tell which";
      }
      map_.grow(start, image);
    }
    return {};
  }

  Side from_, to_;
  FaceGraph graph_, other_;
  GraphMap map_;
};

/// A half-edge of each part: that for which `rarity` is least, of equals the lowest.
template <typename Rarity>
std::vector<int> starts_of(const FaceGraph& graph, Rarity rarity) {
  std::vector<bool> seen(graph.size(), false);
  std::vector<int> starts, part;
  for (int first = 0; first < graph.size(); ++first) {
    if (seen[first]) continue;
    part.assign(1, first);
    seen[first] = true;
    int best = first;
    for (std::size_t done = 0; done < part.size(); ++done) {
      const int h = part[done];
      if (std::pair(rarity(h), h) < std::pair(rarity(best), best)) best = h;
      for (const int to : {graph.next[h], graph.opposite[h]}) {
        if (to < 0 || seen[to]) continue;
        seen[to] = true;
        part.push_back(to);
      }
    }
    starts.push_back(best);
  }
  return starts;
}

/// Corner for corner, as the faces stand.
std::optional<std::vector<VertexIndex>> by_corners(const Side& from, const Side& to) {
  if (from.polygons->offsets != to.polygons->offsets || from.vertices != to.vertices) return {};
  std::vector<VertexIndex> image(from.vertices, -1), preimage(to.vertices, -1);
  for (std::size_t c = 0; c < from.polygons->corners.size(); ++c) {
    const VertexIndex v = from.polygons->corners[c], w = to.polygons->corners[c];
    if (image[v] < 0 && preimage[w] < 0) {
      image[v] = w;
      preimage[w] = v;
    }
    if (image[v] != w || preimage[w] != v) return {};
  }
  return with_loose(std::move(image), preimage, from, to);
}

/// Face for face, from some corner each.
std::optional<std::vector<VertexIndex>> by_faces(const Side& from, const Side& to) {
  if (from.polygons->offsets != to.polygons->offsets) return {};
  Search search(from, to, true);
  const auto corners_of_its_face = [&](int start) {
    const int face = search.graph().face[start];
    std::vector<int> corners(to.polygons->offsets[face + 1] - to.polygons->offsets[face]);
    std::iota(corners.begin(), corners.end(), to.polygons->offsets[face]);
    return corners;
  };
  const auto starts = starts_of(search.graph(), [](int h) { return h; });
  if (!search.run(starts, corners_of_its_face).empty()) return {};
  return search.vertices();
}

std::string counted(const Side& side) {
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

/// By how faces are joined and bounded.
Renumbering by_graph(const Side& from, const Side& to) {
  Search search(from, to, false);
  const Colours colours(search.graph(), search.other());
  std::vector<std::vector<int>> of_colour(colours.count);
  for (int g = 0; g < search.other().size(); ++g) of_colour[colours.of_b[g]].push_back(g);
  const auto candidates = [&](int h) { return of_colour[colours.of_a[h]]; };
  const auto rarity = [&](int h) { return of_colour[colours.of_a[h]].size(); };
  const std::string why = search.run(starts_of(search.graph(), rarity), candidates);
  return why.empty() ? with_map(search.vertices()) : without_map(why);
}

/// Whether a mirror image of `from` comes clearly nearer to the images of its vertices than it does
/// itself, each carried by the similarity that fits best. [Umeyama 1991]
bool is_mirrored(const std::vector<VertexIndex>& image, const Side& from, const Side& to) {
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

/// Each face from its last corner to its first.
Polygons turned_round(Polygons polygons) {
  for (int f = 0; f < polygons.size(); ++f) {
    std::reverse(polygons.corners.begin() + polygons.offsets[f],
                 polygons.corners.begin() + polygons.offsets[f + 1]);
  }
  return polygons;
}

/// The map by the graph, unless faces lead the other way round: a face that is symmetric then has
/// one that exchanges left and right.
Renumbering by_graph_and_sides(const Side& from, const Side& to) {
  Renumbering found = by_graph(from, to);
  if (found.found() && !(from.positions && is_mirrored(found.vertices, from, to))) return found;
  const Polygons turned = turned_round(*to.polygons);
  if (!by_graph(from, {&turned, to.vertices, to.positions}).found()) return found;
  return without_map("the same faces, but they lead the other way round (inside out): turn them");
}

/// Connected part of each vertex: its lowest vertex (N).
std::vector<VertexIndex> parts_of(const Side& side) {
  std::vector<VertexIndex> lower(side.vertices);
  std::iota(lower.begin(), lower.end(), 0);
  const auto lowest = [&lower](VertexIndex v) {
    while (lower[v] != v) v = lower[v] = lower[lower[v]];
    return v;
  };
  for (int f = 0; f < side.polygons->size(); ++f) {
    const int begin = side.polygons->offsets[f], end = side.polygons->offsets[f + 1];
    for (int corner = begin; corner < end; ++corner) {
      const VertexIndex a = lowest(side.polygons->corners[begin]);
      const VertexIndex b = lowest(side.polygons->corners[corner]);
      lower[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<VertexIndex> parts;
  for (VertexIndex v = 0; v < side.vertices; ++v) parts.push_back(lowest(v));
  return parts;
}

/// Whether the image of some part lies farther from it than the part is large: from centre to
/// centre, against the root mean square distance from the centre, after the similarity of all.
bool has_part_elsewhere(const std::vector<VertexIndex>& image, const Side& from, const Side& to) {
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

/// What the order of faces says, unless it exchanges parts that positions tell apart: two eyes of
/// one shape in another order, or triangles that share no vertex.
Renumbering in_order_or_by_places(std::vector<VertexIndex> in_order, const Side& from,
                                  const Side& to) {
  if (from.positions && has_part_elsewhere(in_order, from, to)) {
    Renumbering found = by_graph(from, to);
    if (found.found() && !has_part_elsewhere(found.vertices, from, to)) return found;
  }
  return with_map(std::move(in_order));
}

/// Vertices as they are.
Renumbering by_faces_or_graph(const Side& reference, const Side& other) {
  Side from = reference, to = other;
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
  std::optional<std::vector<VertexIndex>> in_order = by_corners(from, to);
  if (!in_order) in_order = by_faces(from, to);
  Renumbering result = in_order ? in_order_or_by_places(std::move(*in_order), from, to)
                                : by_graph_and_sides(from, to);
  result.splits = joined && result.found();
  return result;
}

/// Vertices at one place as one, numbered in the order of their lowest.
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

  Side side() const { return {&polygons, static_cast<int>(vertices.size()), &positions}; }

  Weld weld;
  std::vector<VertexIndex> number;    ///< of each vertex
  std::vector<VertexIndex> vertices;  ///< the lowest one of each number
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

Side side_of(const Connectivity& connectivity, const Positions* positions = nullptr) {
  return {&connectivity.polygons, connectivity.vertices, positions};
}

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

}  // namespace mimetra
