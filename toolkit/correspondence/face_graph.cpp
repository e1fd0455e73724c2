#include "toolkit/correspondence/face_graph.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

namespace mimetra {
namespace {

/// splitmix64's last step: every bit of the result depends on every bit of the number.
std::uint64_t mixed(std::uint64_t number) {
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9U;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebU;
  return number ^ (number >> 31);
}

std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return mixed(a + 0x9e3779b97f4a7c15U * mixed(b + 0x9e3779b97f4a7c15U * mixed(c + 1)));
}

std::vector<std::uint64_t> first_colours(const FaceGraph& graph) {
  std::vector<std::uint64_t> colours;
  for (const EdgeKind kind : graph.kind) colours.push_back(mixed(static_cast<std::uint64_t>(kind)));
  return colours;
}

/// A half-edge is known by itself, by the next one of its face, and by the one across.
std::vector<std::uint64_t> next_colours(const FaceGraph& graph,
                                        const std::vector<std::uint64_t>& colours) {
  std::vector<std::uint64_t> result(colours.size());
  for (std::size_t h = 0; h < result.size(); ++h) {
    const int across = graph.opposite[h];
    result[h] = mixed(colours[h], colours[graph.next[h]], across < 0 ? 0 : colours[across]);
  }
  return result;
}

std::size_t number_of_colours(const std::vector<std::uint64_t>& a,
                              const std::vector<std::uint64_t>& b) {
  std::vector<std::uint64_t> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all.size();
}

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

Colours::Colours(const FaceGraph& a, const FaceGraph& b)
    : of_a(first_colours(a)), of_b(first_colours(b)) {
  // Colours spread by one edge a round. Where twice as many rounds tell no more apart, none do.
  std::size_t known = 0;
  for (int rounds = 1;; rounds *= 2) {
    for (int round = 0; round < rounds; ++round) {
      of_a = next_colours(a, of_a);
      of_b = next_colours(b, of_b);
    }
    const std::size_t now = number_of_colours(of_a, of_b);
    if (now == known) return;
    known = now;
  }
}

}  // namespace mimetra
