#include "toolkit/transfer/seams.h"

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/pairs.h"

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

/// Of vertices that have a carrier, the lowest at each vertex's place; itself where none has.
std::vector<VertexIndex> carried_at_place(const Weld& at_target, const Pairing& pairing) {
  std::map<VertexIndex, VertexIndex> first;
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    if (!pairing.carriers(v).empty()) first.try_emplace(at_target.representative[v], v);
  }
  std::vector<VertexIndex> carried(pairing.target_vertices());
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    const auto found = first.find(at_target.representative[v]);
    carried[v] = pairing.carriers(v).empty() && found != first.end() ? found->second : v;
  }
  return carried;
}

/// A target's rest pose whose vertices are moved as what carries them.
class CarriedFrames : public FrameSource {
 public:
  /// `moves_as` (N): another vertex whose carriers count.
  CarriedFrames(const FrameSource& source, const Positions& target_rest, const Pairing& pairing,
                const std::vector<VertexIndex>& moves_as)
      : FrameSource(header_of(source, target_rest)),
        source_(source),
        pairing_(pairing),
        moves_as_(moves_as) {}

  bool is_quick() const override { return source_.is_quick(); }

 private:
  static SequenceHeader header_of(const FrameSource& source, const Positions& rest) {
    SequenceHeader header = source.header();
    auto points = std::make_shared<Connectivity>();
    points->vertices = static_cast<int>(rest.rows());
    header.connectivity = std::move(points);
    header.rest = rest;
    return header;
  }

  void read_frames(int first, FramesView poses) const override {
    const FrameBlock block(source_, first, static_cast<int>(poses.rows()));
    for (int row = 0; row < block.frames(); ++row) {
      const Positions moved = pairing_.carried(block.frame(row) - source_.rest(), moves_as_);
      Eigen::Map<Positions>(poses.row(row).data(), moved.rows(), 3) = rest() + moved;
    }
  }

  const FrameSource& source_;
  const Pairing& pairing_;
  const std::vector<VertexIndex>& moves_as_;
};

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

Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const BlockOptions& options) {
  check_sizes(source.rest(), target_rest, &pairing);
  const Weld at_source = Weld::exact(source.rest()), at_target = Weld::exact(target_rest);
  const std::vector<bool> on = on_surface(target_rest, target_triangles, at_target);
  const std::vector<VertexIndex> moves_as = carried_at_place(at_target, pairing);
  const bool only_numbers = pairing.is_one_to_one();
  Weld together = Weld::none(pairing.target_vertices());
  std::map<std::pair<VertexIndex, VertexIndex>, VertexIndex> lowest;
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    if (!on[v]) continue;
    const auto carriers = pairing.carriers(moves_as[v]);
    const bool at_one = only_numbers && !carriers.empty();
    const std::pair places(at_one ? at_source.representative[carriers.front().vertex] : -1,
                           at_target.representative[v]);
    together.representative[v] = lowest.try_emplace(places, v).first->second;
    if (together.representative[v] != v) ++together.count;
  }
  const double share = only_numbers ? kPartedShare : kPartedOverPairs;
  return staying_together(CarriedFrames(source, target_rest, pairing, moves_as), together,
                          share * source.diameter(), options);
}

}  // namespace mimetra
