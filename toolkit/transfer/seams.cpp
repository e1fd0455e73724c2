#include "toolkit/transfer/seams.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/edge_graph.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/triangle_quality.h"
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

/// Of a source's triangles that are partners of a vertex' triangles, and of these themselves, the
/// longest edges together are how far the carriers of one place may be apart; partners of
/// neighbours need not be neighbours.
constexpr double kNearEdges = 2;

/// Target vertices at one place by what carries them. Vertices of the source at one place that part
/// later, as lips do, are not neighbours.
class PlacesOverPairs {
 public:
  PlacesOverPairs(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const std::vector<VertexIndex>& moves_as, const BlockOptions& options)
      : at_source_(staying_together(source, Weld::exact(source.rest()),
                                    kPartedShare * source.diameter(), options)),
        source_(source.rest(), at_source_.welded(source.triangles())),
        target_(target_rest, target_triangles),
        pairing_(pairing),
        moves_as_(moves_as) {}

  /// Of vertices at one place the lowest that each is one with.
  std::vector<VertexIndex> lowest_of(const std::vector<VertexIndex>& place) const {
    std::vector<std::vector<VertexIndex>> carriers;
    double reach = 0;
    for (const VertexIndex v : place) {
      std::vector<VertexIndex>& of_vertex = carriers.emplace_back();
      reach = std::max(reach, target_.longest_edge(v));
      for (const auto& carrier : pairing_.carriers(moves_as_[v])) {
        of_vertex.push_back(at_source_.representative[carrier.vertex]);
      }
    }
    double longest = 0;
    for (const VertexIndex carrier : carriers.front()) {
      longest = std::max(longest, source_.longest_edge(carrier));
    }
    reach = kNearEdges * (reach + longest);
    std::vector<VertexIndex> lowest = place;
    for (std::size_t i = 0; i + 1 < place.size(); ++i) {
      const auto near = source_.within(reach, carriers[i]);
      for (std::size_t j = i + 1; j < place.size(); ++j) {
        const bool is_one =
            carriers[i].empty()
                ? carriers[j].empty()
                : std::ranges::any_of(carriers[j], [&](VertexIndex v) { return near.contains(v); });
        if (is_one) join(lowest, lowest[i], lowest[j]);
      }
    }
    return lowest;
  }

 private:
  static void join(std::vector<VertexIndex>& lowest, VertexIndex a, VertexIndex b) {
    std::ranges::replace(lowest, std::max(a, b), std::min(a, b));
  }

  Weld at_source_;
  EdgeGraph source_, target_;
  const Pairing& pairing_;
  const std::vector<VertexIndex>& moves_as_;
};

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
  std::map<std::pair<VertexIndex, VertexIndex>, std::vector<VertexIndex>> places;
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    if (!on[v]) continue;
    const auto carriers = pairing.carriers(moves_as[v]);
    const bool at_one = only_numbers && !carriers.empty();
    places[{at_one ? at_source.representative[carriers.front().vertex] : -1,
            at_target.representative[v]}]
        .push_back(v);
  }
  std::optional<PlacesOverPairs> over_pairs;
  for (const auto& [key, place] : places) {
    if (place.size() == 1) continue;
    std::vector<VertexIndex> lowest(place.size(), place.front());
    if (!only_numbers) {
      if (!over_pairs) {
        over_pairs.emplace(source, target_rest, target_triangles, pairing, moves_as, options);
      }
      lowest = over_pairs->lowest_of(place);
    }
    for (std::size_t i = 0; i < place.size(); ++i) {
      together.representative[place[i]] = lowest[i];
      if (lowest[i] != place[i]) ++together.count;
    }
  }
  if (!only_numbers) return together;
  return staying_together(CarriedFrames(source, target_rest, pairing, moves_as), together,
                          kPartedShare * source.diameter(), options);
}

}  // namespace mimetra
