#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

class FollowingParts;

enum class TriangleWeight {
  unit,  ///< every triangle counts the same [Sumner, Popovic 2004]
  area   ///< by the area of the target's triangle
};

/// As people choose it.
constexpr std::string_view choice_name(TriangleWeight value) {
  switch (value) {
    case TriangleWeight::unit:
      return "unit";
    case TriangleWeight::area:
      return "area";
  }
  return {};
}

/// What happens to the triangles and vertices outside L.
enum class Outside {
  fixed,    ///< vertices outside the regions stay exactly where they are
  identity  ///< triangles outside L want to keep their shape, weakly
};

/// As people choose it.
constexpr std::string_view choice_name(Outside value) {
  switch (value) {
    case Outside::fixed:
      return "fixed";
    case Outside::identity:
      return "identity";
  }
  return {};
}

/// What holds a connected piece that nothing else holds in place.
enum class Anchor {
  source_motion,  ///< its centroid moves as the same vertices of the source do, not scaled; where
                  ///< faces differ, that of its vertices with carriers as their carriers
  centroid,       ///< its centroid stays
  vertex          ///< one vertex stays
};

constexpr std::string_view choice_name(Anchor value) {
  switch (value) {
    case Anchor::source_motion:
      return "source";
    case Anchor::centroid:
      return "centroid";
    case Anchor::vertex:
      return "vertex";
  }
  return {};
}

struct VertexTransferOptions {
  TriangleWeight triangle_weight = TriangleWeight::unit;
  Outside outside = Outside::fixed;
  /// Vertices that Outside::fixed lets move (N): those inside the regions. By default the vertices
  /// all of whose triangles are in L.
  std::vector<bool> inside = {};
  /// Share of the wanted motion that each vertex takes (N), in [0, 1], where the border of the
  /// regions is soft; empty where it is hard. Vertices of weight 0 are those that are not inside.
  Eigen::VectorXd weights = {};
  /// Vertices that are one point of the surface and move as one (N), such as closed_seams(); by
  /// default none are. Where one of them is fixed, all are.
  Weld weld = {};
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};
  /// Parts of the target without a partner; by default found from the pairing.
  std::shared_ptr<const FollowingParts> following = {};
  /// Weight of triangles outside L for Outside::identity, and of those without partner, relative
  /// to the others.
  double outside_weight = 0.1;
  /// Weight of squared differences of displacement gradients across edges of triangles outside L.
  double outside_smoothness = 0;
  /// By default the source's motion. One that is given is refused where fixed vertices hold the
  /// mesh.
  std::optional<Anchor> anchor = {};
  /// Vertex of Anchor::vertex, -1 for none. The lowest vertex of a piece holds it if the piece does
  /// not contain this one.
  VertexIndex anchor_vertex = -1;

  static constexpr Option kTriangleWeight{"triangle_weight",
                                          &VertexTransferOptions::triangle_weight};
  static constexpr Option kOutside{"outside", &VertexTransferOptions::outside};
  static constexpr Option kOutsideWeight{
      "outside_weight", &VertexTransferOptions::outside_weight, {.minimum = 1e-12}};
  static constexpr Option kOutsideSmoothness{
      "outside_smoothness", &VertexTransferOptions::outside_smoothness, {.minimum = 0}};
  static constexpr Option kAnchor{"anchor", &VertexTransferOptions::anchor};
  static constexpr Option kAnchorVertex{
      "anchor_vertex", &VertexTransferOptions::anchor_vertex, {.minimum = -1}};
  static constexpr auto declared() {
    return std::tuple(kTriangleWeight, kOutside, kOutsideWeight, kOutsideSmoothness, kAnchor,
                      kAnchorVertex);
  }
};

/// Positions of a target that follow a source's deformation gradients on triangles L; the target
/// has the source's connectivity, or is paired with it, and needs no expressions.
///
/// The fourth-vertex unknowns drop out exactly: what is left is one N x N system of gradient
/// products, shared by x, y, z and all frames, factored once in the constructor. Translation is
/// explicit: one pin per connected piece of the weighted triangles that holds no fixed vertex (two
/// triangles that share one vertex are one piece), and a translation afterwards.
///
/// Vertices that are one (VertexTransferOptions::weld) are one unknown of the system: the result is
/// that of the mesh without duplicates, though each triangle has its own corners' gradient. Those
/// that rounding or noise holds apart at rest stay as far apart.
///
/// A triangle without partner wants to keep its shape, with the weight of those outside L, so that
/// a mouth's inside does not hold the lips. Connected parts without any partner take no part in the
/// solve: they follow the surface around them or stay (FollowingParts), whether they are in L or
/// not.
///
/// Where vertices take a share of the motion (VertexTransferOptions::weights), the deformation
/// fades as SoftBorder describes: weights of 1 everywhere give what none give, bit by bit, and
/// vertices of weight 0 stay exactly, but those that follow. Each piece moves, on average over its
/// vertices, by that share of the source's motion, within what is SoftBorder::bearable().
///
/// [Sumner, Popovic. Deformation Transfer for Triangle Meshes. ACM TOG 23(3), 2004]
class VertexTransfer {
 public:
  /// `source_rest`, `target_rest` N x 3; `selected` are rows of the target's `triangles` (M x 3),
  /// with weights those that have a corner of weight above 0.
  /// Throws MismatchError if vertex counts differ, std::invalid_argument for options out of
  /// range, an explicit anchor where vertices are fixed, an index out of range, vertices that are
  /// one but lie apart in a rest pose (by more than 2 kPartedShare of its box), or weights together
  /// with Outside::identity; Cancelled.
  VertexTransfer(const Positions& source_rest, const Positions& target_rest,
                 const Triangles& triangles, const std::vector<int>& selected,
                 const VertexTransferOptions& options = {}, const Context& context = {});
  ~VertexTransfer();
  VertexTransfer(VertexTransfer&&) noexcept;
  VertexTransfer& operator=(VertexTransfer&&) noexcept;

  /// Target poses for every frame, F x 3N. Throws MismatchError, Cancelled, std::runtime_error
  /// where the system cannot be factored, and what reading throws.
  Frames frames(const FrameSource& performance, const Context& context = {}) const;
  /// The same into a sink, up to sixteen frames at a time; to commit is left to the caller. Throws
  /// what writing throws, too.
  void write_frames(const FrameSource& performance, FrameSink& sink,
                    const Context& context = {}) const;

  /// Triangles of which two corners are one vertex: they take no part, and are none of the
  /// degenerate ones.
  int collapsed_triangles() const;
  int degenerate_source_triangles() const;
  int degenerate_target_triangles() const;
  /// Vertices that stay exactly at the target's rest pose (N), or follow.
  const std::vector<bool>& fixed() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
