#include "toolkit/transfer/seams.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/disjoint_sets.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {

namespace {

/// Vertices of triangles, at places where some triangle has area. The other vertices have no side
/// to tear from, or stay at rest anyway. Each pass over the frames splits off one parting vertex,
/// and a surface folded into one point could part into hundreds.
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

/// Lowest vertex with a carrier at the place of each vertex without one. Other vertices, and those
/// at places without a carrier, map to themselves.
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

/// Greatest distance between the carriers of one place. The unit is the longest edge at the
/// target's vertices plus the longest edge at the source's carriers. Partners of neighbours need
/// not be neighbours.
constexpr double kNearEdges = 2;

/// Distance, as a share of the diameter, from which coinciding vertices of a source with other
/// faces are lips and not one point. It is above the rounding of single precision.
constexpr double kRoundingShare = 1e-6;

/// Groups target vertices at one place by their carriers. Coinciding vertices of the source that
/// part later, as lips do, are not neighbours.
class PlacesOverPairs {
 public:
  PlacesOverPairs(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const std::vector<VertexIndex>& moves_as, const Context& context)
      : at_source_(staying_together(source, Weld::exact(source.rest()),
                                    kRoundingShare * source.diameter(), context)),
        source_rest_(source.rest()),
        target_rest_(target_rest),
        source_(source.triangles(), at_source_),
        target_(static_cast<int>(target_rest.rows()), target_triangles),
        pairing_(pairing),
        moves_as_(moves_as) {}

  /// Lowest vertex that each of some vertices at one place is welded to.
  std::vector<VertexIndex> lowest_of(const std::vector<VertexIndex>& place) const {
    std::vector<std::vector<VertexIndex>> carriers;
    double reach = 0;
    for (const VertexIndex v : place) {
      std::vector<VertexIndex>& of_vertex = carriers.emplace_back();
      reach = std::max(reach, longest_edge(target_, target_rest_, v));
      for (const auto& carrier : pairing_.carriers(moves_as_[v])) {
        of_vertex.push_back(at_source_.representative[carrier.vertex]);
      }
    }
    double longest = 0;
    for (const VertexIndex carrier : carriers.front()) {
      longest = std::max(longest, longest_edge(source_, source_rest_, carrier));
    }
    reach = kNearEdges * (reach + longest);
    std::vector<VertexIndex> lowest = place;
    for (std::size_t i = 0; i + 1 < place.size(); ++i) {
      const auto near = within_reach(source_, source_rest_, reach, carriers[i]);
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
  const Positions &source_rest_, &target_rest_;
  Surface source_, target_;
  const Pairing& pairing_;
  const std::vector<VertexIndex>& moves_as_;
};

/// Lowest near vertex of each of some vertices at one place.
template <typename Near>
std::vector<VertexIndex> lowest_near(const std::vector<VertexIndex>& place, const Near& near) {
  std::vector<VertexIndex> lowest, firsts;
  for (const VertexIndex v : place) {
    auto first = std::ranges::find_if(firsts, [&](VertexIndex f) { return near(f, v); });
    if (first == firsts.end()) first = firsts.insert(first, v);
    lowest.push_back(*first);
  }
  return lowest;
}

/// Sets of vertices that grow by joining.
class Joined {
 public:
  explicit Joined(std::vector<bool> on) : on_(std::move(on)), sets_(static_cast<int>(on_.size())) {}

  /// Joins the vertices of each place, each with its lowest vertex by `lowest_of`. `place_of` (N)
  /// is -1 for vertices without a place.
  template <typename LowestOf>
  void add(const std::vector<VertexIndex>& place_of, const LowestOf& lowest_of) {
    std::map<VertexIndex, std::vector<VertexIndex>> places;
    for (VertexIndex v = 0; v < std::ssize(place_of); ++v) {
      if (on_[v] && place_of[v] >= 0) places[place_of[v]].push_back(v);
    }
    for (const auto& [name, place] : places) {
      if (place.size() == 1) continue;
      const std::vector<VertexIndex> lowest = lowest_of(place);
      for (std::size_t i = 0; i < place.size(); ++i) sets_.join(lowest[i], place[i]);
    }
  }

  Weld weld() {
    Weld weld = Weld::none(static_cast<int>(on_.size()));
    for (VertexIndex v = 0; v < std::ssize(on_); ++v) {
      weld.representative[v] = sets_.lowest(v);
      if (weld.representative[v] != v) ++weld.count;
    }
    return weld;
  }

 private:
  std::vector<bool> on_;
  DisjointSets sets_;
};

/// Welds vertices at one place of the target that are near in the source, or the other way round.
/// `place_at_source` (N x 3) is the rest place of each vertex's carrier, NaN without one.
Weld near_in_both(const Positions& place_at_source, double near_at_source,
                  const Positions& target_rest, double near_at_target, const Weld& at_target,
                  std::vector<bool> on) {
  const auto are_near = [](const Positions& places, double near) {
    return [&places, near](VertexIndex a, VertexIndex b) {
      const bool unknown = places.row(a).hasNaN() && places.row(b).hasNaN();
      return unknown || (places.row(a) - places.row(b)).norm() <= near;
    };
  };
  std::vector<VertexIndex> known;
  for (VertexIndex v = 0; v < place_at_source.rows(); ++v) {
    if (!place_at_source.row(v).hasNaN()) known.push_back(v);
  }
  const Weld of_known = Weld::exact(place_at_source(known, Eigen::all));
  std::vector<VertexIndex> at_source(on.size(), -1);
  for (std::size_t i = 0; i < known.size(); ++i) {
    at_source[known[i]] = known[of_known.representative[i]];
  }
  const auto by_source = are_near(place_at_source, near_at_source);
  const auto by_target = are_near(target_rest, near_at_target);
  Joined joined(std::move(on));
  joined.add(at_target.representative,
             [&](const auto& place) { return lowest_near(place, by_source); });
  joined.add(at_source, [&](const auto& place) { return lowest_near(place, by_target); });
  return joined.weld();
}

/// Frames of a target whose rest pose moves with its carriers.
class CarriedFrames : public FrameSource {
 public:
  /// `moves_as` (N): vertex whose carriers each vertex uses.
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

Weld closed_seams(const FrameSource& source, const Positions& target_rest, const Context& context) {
  if (target_rest.rows() != source.vertices()) {
    throw MismatchError("the source has " + std::to_string(source.vertices()) +
                        " vertices, the target " + std::to_string(target_rest.rows()));
  }
  const Weld at_target = Weld::exact(target_rest);
  const std::vector<bool> on = on_surface(target_rest, source.triangles(), at_target);
  const double parted = kPartedShare * source.diameter();
  const Weld near =
      near_in_both(source.rest(), parted, target_rest,
                   kPartedShare * diameter(target_rest, source.triangles()), at_target, on);
  return staying_together(source, near, parted, context);
}

Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const Context& context) {
  check_sizes(source.rest(), target_rest, &pairing);
  const Weld at_target = Weld::exact(target_rest);
  const std::vector<bool> on = on_surface(target_rest, target_triangles, at_target);
  const std::vector<VertexIndex> moves_as = carried_at_place(at_target, pairing);
  if (pairing.is_one_to_one()) {
    const double parted = kPartedShare * source.diameter();
    Positions place_at_source(pairing.target_vertices(), 3);
    place_at_source.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
      const auto carriers = pairing.carriers(moves_as[v]);
      if (!carriers.empty()) place_at_source.row(v) = source.rest().row(carriers.front().vertex);
    }
    const Weld near =
        near_in_both(place_at_source, parted, target_rest,
                     kPartedShare * diameter(target_rest, target_triangles), at_target, on);
    return staying_together(CarriedFrames(source, target_rest, pairing, moves_as), near, parted,
                            context);
  }
  std::optional<PlacesOverPairs> over_pairs;
  Joined joined(on);
  joined.add(at_target.representative, [&](const auto& place) {
    if (!over_pairs) {
      over_pairs.emplace(source, target_rest, target_triangles, pairing, moves_as, context);
    }
    return over_pairs->lowest_of(place);
  });
  return joined.weld();
}

}  // namespace mimetra
