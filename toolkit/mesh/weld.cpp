#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Lexicographic order of points, which puts equal ones side by side. 0 and -0 compare equal.
std::tuple<double, double, double> place(const Positions& positions, VertexIndex vertex) {
  return {positions(vertex, 0), positions(vertex, 1), positions(vertex, 2)};
}

void check_finite(const Positions& positions) {
  for (int vertex = 0; vertex < positions.rows(); ++vertex) {
    // Not-a-number has no place in an order.
    if (!positions.row(vertex).allFinite()) {
      throw std::invalid_argument("vertex " + std::to_string(vertex) + " is not finite");
    }
  }
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

Triangles Weld::welded(const Triangles& triangles) const {
  return triangles.unaryExpr([this](VertexIndex vertex) { return representative.at(vertex); });
}

std::vector<VertexIndex> parting_vertices(const MeshSequence& sequence, const Weld& weld,
                                          double tolerance) {
  if (static_cast<int>(weld.representative.size()) != sequence.vertices()) {
    throw std::invalid_argument("a weld of " + std::to_string(weld.representative.size()) +
                                " vertices for a sequence of " +
                                std::to_string(sequence.vertices()));
  }
  std::vector<VertexIndex> parting;
  for (VertexIndex vertex = 0; vertex < sequence.vertices(); ++vertex) {
    const VertexIndex first = weld.representative[vertex];
    if (first == vertex) continue;
    for (int f = 0; f < sequence.frames(); ++f) {
      const auto frame = sequence.frame(f);
      if ((frame.row(vertex) - frame.row(first)).norm() <= tolerance) continue;
      parting.push_back(vertex);
      break;
    }
  }
  return parting;
}

}  // namespace mimetra
