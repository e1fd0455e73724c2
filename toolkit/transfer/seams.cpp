#include "toolkit/transfer/seams.h"

#include <map>
#include <string>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {

namespace {

/// Vertices of a triangle, at places where one has area. The others have no side to be torn from,
/// or stay at rest anyway; each pass over the frames splits off one of those that part, and
/// whatever is folded away at one point could part into hundreds.
std::vector<bool> on_surface(const Positions& rest, const Triangles& triangles,
                             const Weld& at_rest) {
  std::vector<bool> has_area(rest.rows(), false), on(rest.rows(), false);
  for (int t = 0; t < triangles.rows(); ++t) {
    if (quality_of(rest, triangles, t) < kDegenerateQuality) continue;
    for (const VertexIndex vertex : triangles.row(t)) {
      has_area[at_rest.representative[vertex]] = true;
    }
  }
  for (const VertexIndex vertex : triangles.reshaped()) {
    on[vertex] = has_area[at_rest.representative[vertex]];
  }
  return on;
}

}  // namespace

Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const BlockOptions& options) {
  if (target_rest.rows() != source.vertices()) {
    throw MismatchError("the source has " + std::to_string(source.vertices()) +
                        " vertices, the target " + std::to_string(target_rest.rows()));
  }
  const Weld at_source = Weld::exact(source.rest()), at_target = Weld::exact(target_rest);
  const std::vector<bool> on = on_surface(target_rest, source.triangles(), at_target);
  Weld together = Weld::none(source.vertices());
  std::map<std::pair<VertexIndex, VertexIndex>, VertexIndex> lowest;
  for (VertexIndex v = 0; v < source.vertices(); ++v) {
    if (!on[v]) continue;
    const std::pair places(at_source.representative[v], at_target.representative[v]);
    together.representative[v] = lowest.try_emplace(places, v).first->second;
    if (together.representative[v] != v) ++together.count;
  }
  return staying_together(source, together, kPartedShare * source.diameter(), options);
}

}  // namespace mimetra
