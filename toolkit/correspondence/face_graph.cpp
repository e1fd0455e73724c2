#include "toolkit/correspondence/face_graph.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

namespace mimetra {
namespace {

/// Numbers 0 .. n - 1 in classes, which are split.
class Partition {
 public:
  /// \pre classes are numbered from 0 on, each with a member
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

  /// The marked members of each class become one of their own where there are others; calls
  /// `on_split` with both classes. Nothing is marked then.
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
    int first, end;  ///< of elements_
    int marked;      ///< the first ones
  };

  std::vector<int> class_of_, elements_, place_;
  std::vector<Range> ranges_;
  std::vector<int> touched_;
};

/// Classes of kinds, without those that no half-edge is of.
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

/// The half-edges of two graphs in one row: which each one follows, and which lies across; -1.
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

FaceGraph::FaceGraph(const Polygons& polygons)
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
  const auto ends = [this](int h) {
    const VertexIndex from = vertex[h], to = vertex[next[h]];
    return std::pair(std::min(from, to), std::max(from, to));
  };
  std::vector<int> by_edge(vertex.size());
  std::iota(by_edge.begin(), by_edge.end(), 0);
  std::ranges::stable_sort(by_edge, [&ends](int a, int b) { return ends(a) < ends(b); });
  for (auto first = by_edge.begin(); first != by_edge.end();) {
    const auto last =
        std::find_if(first, by_edge.end(), [&](int h) { return ends(h) != ends(*first); });
    const auto count = std::distance(first, last);
    if (count == 2 && vertex[*first] != vertex[*(first + 1)]) {
      opposite[*first] = *(first + 1);
      opposite[*(first + 1)] = *first;
      kind[*first] = kind[*(first + 1)] = EdgeKind::inner;
    } else if (count > 1) {
      for (auto h = first; h != last; ++h) kind[*h] = EdgeKind::tangled;
    }
    first = last;
  }
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
  // Of a class whose members all lead where they did, the smaller part tells what the whole would.
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

}  // namespace mimetra
