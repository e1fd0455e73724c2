#include <algorithm>
#include <atomic>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Key for a lexicographic order of points, which makes equal ones adjacent; 0 equals -0.
std::tuple<double, double, double> place(const Positions& positions, VertexIndex vertex) {
  return {positions(vertex, 0), positions(vertex, 1), positions(vertex, 2)};
}

void check_finite(const Positions& positions) {
  for (int vertex = 0; vertex < positions.rows(); ++vertex) {
    // NaN has no place in an order.
    if (!positions.row(vertex).allFinite()) {
      throw std::invalid_argument("vertex " + std::to_string(vertex) + " is not finite");
    }
  }
}

std::vector<VertexIndex> welded_vertices(const Weld& weld) {
  std::vector<VertexIndex> welded;
  for (VertexIndex vertex = 0; vertex < static_cast<int>(weld.representative.size()); ++vertex) {
    if (weld.representative[vertex] != vertex) welded.push_back(vertex);
  }
  return welded;
}

}  // namespace

Weld Weld::none(int vertices) {
  Weld weld;
  weld.representative.resize(vertices);
  std::iota(weld.representative.begin(), weld.representative.end(), 0);
  return weld;
}

Weld Weld::exact(const Positions& positions) {
  check_finite(positions);
  Weld weld = none(static_cast<int>(positions.rows()));
  std::vector<VertexIndex> order = weld.representative;
  std::sort(order.begin(), order.end(), [&](VertexIndex a, VertexIndex b) {
    return std::tuple_cat(place(positions, a), std::tuple(a)) <
           std::tuple_cat(place(positions, b), std::tuple(b));
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (place(positions, order[i]) != place(positions, order[i - 1])) continue;
    weld.representative[order[i]] = weld.representative[order[i - 1]];
    ++weld.count;
  }
  return weld;
}

void Weld::check(const Positions& positions, double tolerance) const {
  const auto vertices = static_cast<VertexIndex>(representative.size());
  if (vertices != positions.rows()) {
    throw std::invalid_argument("a weld of " + std::to_string(vertices) + " vertices for " +
                                std::to_string(positions.rows()));
  }
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    const VertexIndex first = representative[vertex];
    if (first == vertex) continue;
    const std::string what =
        "vertex " + std::to_string(vertex) + " is welded to " + std::to_string(first);
    if (first < 0 || first > vertex || representative[first] != first) {
      throw std::invalid_argument(what + ", expected the lowest one that it is welded to");
    }
    if ((positions.row(vertex) - positions.row(first)).norm() > tolerance) {
      throw std::invalid_argument(what + ", which is at another place");
    }
  }
}

Triangles Weld::welded(const Triangles& triangles) const {
  const auto vertices = static_cast<VertexIndex>(representative.size());
  return triangles.unaryExpr([&](VertexIndex vertex) {
    return vertex >= 0 && vertex < vertices ? representative[vertex] : vertex;
  });
}

std::vector<VertexIndex> parting_vertices(const FrameSource& sequence, const Weld& weld,
                                          double tolerance, const Context& context) {
  if (static_cast<int>(weld.representative.size()) != sequence.vertices()) {
    throw std::invalid_argument("a weld of " + std::to_string(weld.representative.size()) +
                                " vertices for a sequence of " +
                                std::to_string(sequence.vertices()));
  }
  const std::vector<VertexIndex> welded = welded_vertices(weld);
  if (welded.empty()) return {};
  std::vector<std::atomic<bool>> parts(weld.representative.size());
  for_each_run(
      sequence,
      [&](int first, int count) {
        const FrameBlock block(sequence, first, count);
        for (int row = 0; row < count; ++row) {
          const PositionsView frame = block.frame(row);
          for (const VertexIndex vertex : welded) {
            const VertexIndex lowest = weld.representative[vertex];
            // Written so that NaN also parts.
            if ((frame.row(vertex) - frame.row(lowest)).norm() <= tolerance) continue;
            parts[vertex].store(true, std::memory_order_relaxed);
          }
        }
      },
      context);
  std::vector<VertexIndex> parting;
  std::ranges::copy_if(welded, std::back_inserter(parting),
                       [&parts](VertexIndex vertex) { return parts[vertex].load(); });
  return parting;
}

Weld staying_together(const FrameSource& sequence, const Weld& weld, double tolerance,
                      const Context& context) {
  Weld staying = weld, tested = weld;
  double done = 0;
  do {
    // The number of rounds is unknown, so each takes half of the remaining progress.
    const double next = (1 + done) / 2;
    const auto parting = parting_vertices(sequence, tested, tolerance, context.part(done, next));
    done = next;
    Weld left = Weld::none(sequence.vertices());
    std::vector<VertexIndex> lowest_left(weld.representative.size(), -1);
    for (const VertexIndex vertex : parting) {
      VertexIndex& lowest = lowest_left[tested.representative[vertex]];
      if (lowest < 0) {
        lowest = vertex;
        --staying.count;
      } else {
        ++left.count;
      }
      staying.representative[vertex] = left.representative[vertex] = lowest;
    }
    tested = std::move(left);
  } while (tested.count > 0);
  return staying;
}

}  // namespace mimetra
