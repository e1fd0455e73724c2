#include "toolkit/correspondence/vertex_map.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/surface.h"

namespace mimetra {
namespace {

/// Partition of the numbers 0 .. n - 1 into classes that can be split.
class Partition {
 public:
  /// \pre classes are numbered from 0 without gaps
  explicit Partition(std::vector<int> class_of)
      : class_of_(std::move(class_of)), elements_(class_of_.size()), place_(class_of_.size()) {
    std::iota(elements_.begin(), elements_.end(), 0);
    std::ranges::stable_sort(elements_, {}, [this](int element) { return class_of_[element]; });
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      place_[elements_[i]] = static_cast<int>(i);
      if (class_of_[elements_[i]] == classes()) ranges_.push_back({static_cast<int>(i), 0, 0});
      ranges_.back().end = static_cast<int>(i) + 1;
    }
  }

  int classes() const { return static_cast<int>(ranges_.size()); }
  int size(int each) const { return ranges_[each].end - ranges_[each].first; }
  const std::vector<int>& class_of() const { return class_of_; }
  std::vector<int> members(int each) const {
    return {elements_.begin() + ranges_[each].first, elements_.begin() + ranges_[each].end};
  }

  void mark(int element) {
    Range& range = ranges_[class_of_[element]];
    if (range.marked++ == 0) touched_.push_back(class_of_[element]);
    const int to = range.first + range.marked - 1, from = place_[element];
    std::swap(elements_[to], elements_[from]);
    place_[elements_[to]] = to;
    place_[elements_[from]] = from;
  }

  /// Splits the marked members from each class that also has others. Calls `on_split` with both
  /// classes. No number is marked afterwards.
  template <typename OnSplit>
  void split_marked(OnSplit on_split) {
    for (const int each : std::exchange(touched_, {})) {
      const int marked = std::exchange(ranges_[each].marked, 0);
      if (marked == size(each)) continue;
      const int added = classes(), first = ranges_[each].first;
      ranges_.push_back({first, first + marked, 0});
      ranges_[each].first += marked;
      for (const int element : members(added)) class_of_[element] = added;
      on_split(each, added);
    }
  }

 private:
  struct Range {
    int first, end;  ///< range in elements_
    int marked;      ///< number of marked elements, which come first
  };

  std::vector<int> class_of_, elements_, place_;
  std::vector<Range> ranges_;
  std::vector<int> touched_;
};

/// Classes by kind, numbered without gaps.
std::vector<int> classes_of_kinds(const FaceGraph& a, const FaceGraph& b) {
  std::vector<int> kinds;
  for (const FaceGraph* graph : {&a, &b}) {
    for (const EdgeKind kind : graph->kind) kinds.push_back(static_cast<int>(kind));
  }
  std::vector<int> present = kinds;
  std::ranges::sort(present);
  present.erase(std::unique(present.begin(), present.end()), present.end());
  for (int& kind : kinds) {
    kind = static_cast<int>(std::ranges::lower_bound(present, kind) - present.begin());
  }
  return kinds;
}

/// Half-edges of two graphs in one list, with the previous half-edge of each and the opposite one,
/// or -1.
struct Arrivals {
  Arrivals(const FaceGraph& a, const FaceGraph& b) : before(a.size() + b.size()) {
    for (const FaceGraph* graph : {&a, &b}) {
      const int first = graph == &a ? 0 : a.size();
      for (int h = 0; h < graph->size(); ++h) {
        before[first + graph->next[h]] = first + h;
        across.push_back(graph->opposite[h] < 0 ? -1 : first + graph->opposite[h]);
      }
    }
  }

  std::vector<int> before, across;
};

}  // namespace

FaceGraph::FaceGraph(int vertices, const Polygons& polygons)
    : vertex(polygons.corners),
      face(vertex.size()),
      next(vertex.size()),
      opposite(vertex.size(), -1),
      kind(vertex.size(), EdgeKind::border) {
  for (int f = 0; f < polygons.size(); ++f) {
    for (int h = polygons.offsets[f]; h < polygons.offsets[f + 1]; ++h) {
      face[h] = f;
      next[h] = h + 1 < polygons.offsets[f + 1] ? h + 1 : polygons.offsets[f];
    }
  }
  const EdgeSides edges(vertices, polygons, Collapsed::kept);
  edges.for_each_edge([this](std::span<const int> sides) {
    if (sides.size() == 2 && vertex[sides[0]] != vertex[sides[1]]) {
      opposite[sides[0]] = sides[1];
      opposite[sides[1]] = sides[0];
      kind[sides[0]] = kind[sides[1]] = EdgeKind::inner;
    } else if (sides.size() > 1) {
      for (const int h : sides) kind[h] = EdgeKind::tangled;
    }
  });
}

Colours::Colours(const FaceGraph& a, const FaceGraph& b) {
  const Arrivals arrivals(a, b);
  Partition partition(classes_of_kinds(a, b));
  std::vector<int> waiting(partition.classes());
  std::iota(waiting.begin(), waiting.end(), 0);
  std::vector<bool> waits(waiting.size(), true);
  const auto wait = [&](int each) {
    waits[each] = true;
    waiting.push_back(each);
  };
  // The other classes are already split by a class that does not wait, so that its smaller half
  // suffices.
  const auto on_split = [&](int split, int added) {
    waits.push_back(false);
    const bool is_smaller = !waits[split] && partition.size(split) < partition.size(added);
    wait(is_smaller ? split : added);
  };
  while (!waiting.empty()) {
    const int each = waiting.back();
    waiting.pop_back();
    waits[each] = false;
    const std::vector<int> members = partition.members(each);
    for (const int h : members) partition.mark(arrivals.before[h]);
    partition.split_marked(on_split);
    for (const int h : members) {
      if (arrivals.across[h] >= 0) partition.mark(arrivals.across[h]);
    }
    partition.split_marked(on_split);
  }
  count = partition.classes();
  of_a.assign(partition.class_of().begin(), partition.class_of().begin() + a.size());
  of_b.assign(partition.class_of().begin() + a.size(), partition.class_of().end());
}

namespace {

/// Number of half-edges to follow for one part, after which it counts as too symmetric.
constexpr double kMostWork = 1e8;

/// A map of half-edges and vertices that grows by whole connected parts.
class GraphMap {
 public:
  /// With `keeps_faces`, each face maps only to the face of the same number.
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

  /// Maps the part of `half_edge` so that `half_edge` maps to `image`. Returns false and changes
  /// nothing if that does not fit.
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

  /// Removes the last part.
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

/// Completes the map by the vertices without a face, in ascending order. If positions may decide,
/// each gets the nearest one left. \pre both meshes have as many
std::vector<VertexIndex> with_loose(std::vector<VertexIndex> image,
                                    const std::vector<VertexIndex>& preimage, const MapSide& from,
                                    const MapSide& to) {
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
  /// Half-edges of the other mesh that may be the image of a half-edge.
  using Candidates = std::function<std::vector<int>(int)>;

  Search(MapSide from, MapSide to, bool keeps_faces)
      : from_(from),
        to_(to),
        graph_(from.vertices, *from.polygons),
        other_(to.vertices, *to.polygons),
        map_(graph_, from.vertices, other_, to.vertices, keeps_faces) {}

  const FaceGraph& graph() const { return graph_; }
  const FaceGraph& other() const { return other_; }

  /// Returns why there is no map, or an empty text if vertices() has the map.
  std::string run(const std::vector<int>& starts, const Candidates& candidates) {
    std::vector<int> left = starts;
    while (!left.empty()) {
      // A part that touches a mapped part may have only one map left. The loop repeats until
      // nothing changes.
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

  /// First images of `start` that fit, at most two.
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

  /// Sum of squared distances between the last part's vertices and their images.
  double distance(const Positions& carried) const {
    double sum = 0;
    for (const VertexIndex v : map_.added_vertices()) {
      sum += (carried.row(v) - to_.positions->row(map_.vertices()[v])).squaredNorm();
    }
    return sum;
  }

  /// Image of `start` that is clearly nearer than all others; -1 if there is none.
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

  MapSide from_, to_;
  FaceGraph graph_, other_;
  GraphMap map_;
};

/// One half-edge of each part: the half-edge with the least `rarity`, and the lowest of equal ones.
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

}  // namespace

Similarity told_by(const std::vector<VertexIndex>& image, const MapSide& from, const MapSide& to) {
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
    // Collinear points determine no similarity.
  }
  return {};
}

std::optional<std::vector<VertexIndex>> map_by_corners(const MapSide& from, const MapSide& to) {
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

std::optional<std::vector<VertexIndex>> map_by_faces(const MapSide& from, const MapSide& to) {
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

FoundMap map_by_graph(const MapSide& from, const MapSide& to) {
  Search search(from, to, false);
  const Colours colours(search.graph(), search.other());
  std::vector<std::vector<int>> of_colour(colours.count);
  for (int g = 0; g < search.other().size(); ++g) of_colour[colours.of_b[g]].push_back(g);
  const auto candidates = [&](int h) { return of_colour[colours.of_a[h]]; };
  const auto rarity = [&](int h) { return of_colour[colours.of_a[h]].size(); };
  const std::string why = search.run(starts_of(search.graph(), rarity), candidates);
  if (!why.empty()) return {{}, why};
  return {search.vertices()};
}

}  // namespace mimetra
