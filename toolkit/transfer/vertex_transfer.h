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
  unit,  ///< all triangles count the same [Sumner, Popovic 2004]
  area   ///< by the area of the target's triangle
};

constexpr std::string_view choice_name(TriangleWeight value) {
  switch (value) {
    case TriangleWeight::unit:
      return "unit";
    case TriangleWeight::area:
      return "area";
  }
  return {};
}

/// Treatment of triangles and vertices outside L.
enum class Outside {
  fixed,    ///< vertices outside the regions stay exactly where they are
  identity  ///< triangles outside L tend weakly to keep their shape
};

constexpr std::string_view choice_name(Outside value) {
  switch (value) {
    case Outside::fixed:
      return "fixed";
    case Outside::identity:
      return "identity";
  }
  return {};
}

/// Anchor of a connected piece that has no fixed vertex.
enum class Anchor {
  source_motion,  ///< the centroid moves as the source's vertices do, unscaled; if faces differ,
                  ///< the centroid of the carried vertices moves as their carriers
  centroid,       ///< the piece's centroid stays
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
  /// Vertices inside the regions (N), which Outside::fixed lets move. By default, vertices whose
  /// triangles are all in L.
  std::vector<bool> inside = {};
  /// Share of the wanted motion that each vertex takes (N), in [0, 1], for regions with a soft
  /// border. Empty for a hard border. Vertices of weight 0 count as outside, and `inside` is
  /// ignored.
  Eigen::VectorXd weights = {};
  /// Vertices that are one point of the surface and move as one (N), such as closed_seams(). Empty
  /// for none. If one of them is fixed, all are.
  Weld weld = {};
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};
  /// Parts of the target that are not solved for. By default they are found from the pairing.
  std::shared_ptr<const FollowingParts> following = {};
  /// Weight of triangles without a partner and, with Outside::identity, of triangles outside L.
  /// Triangles in L with a partner have weight 1.
  double outside_weight = 0.1;
  /// Weight of squared differences of displacement gradients, across edges of triangles outside L.
  double outside_smoothness = 0;
  /// Anchor of pieces without a fixed vertex, by default Anchor::source_motion. The constructor
  /// throws if an anchor is given but fixed vertices hold the mesh.
  std::optional<Anchor> anchor = {};
  /// Vertex of Anchor::vertex, or -1 for none. A piece that does not contain it is held by its own
  /// lowest vertex.
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

/// Transfers a source's deformation gradients on triangles L to the positions of a target. The
/// target has the source's connectivity or is paired with the source. It needs no expressions.
///
/// The unknown fourth vertices drop out exactly. The remaining system of gradient products is at
/// most N x N. It serves x, y, z and all frames, and the constructor factors it once. Translation
/// is explicit: each connected piece of weighted triangles without a fixed vertex has one pinned
/// vertex, and is translated afterwards. Two triangles that share a vertex belong to one piece.
///
/// Welded vertices (VertexTransferOptions::weld) share one unknown. The result equals the result on
/// a mesh without duplicates, though each triangle keeps its own corners' gradient. Vertices that
/// rounding or noise holds apart at rest stay as far apart.
///
/// A triangle without a partner tends to keep its shape, with outside_weight, so that a mouth's
/// inside does not hold the lips. Connected parts without any partner are not solved for, in L or
/// not. They follow the surface around them or stay (FollowingParts).
///
/// If vertices take a share of the motion (VertexTransferOptions::weights), the deformation fades
/// as SoftBorder describes. Weights of 1 everywhere give the same result as no weights, bit by bit.
/// Vertices of weight 0 stay exactly, except in parts that follow. Each piece moves on average by
/// its vertices' shares of the source's motion, as far as SoftBorder::bearable() allows.
///
/// [Sumner, Popovic. Deformation Transfer for Triangle Meshes. ACM TOG 23(3), 2004]
class VertexTransfer {
 public:
  /// `source_rest` and `target_rest` are N x 3. `selected` are rows of the target's `triangles`
  /// (M x 3). With weights, these are the triangles with a corner of weight above 0.
  ///
  /// Throws MismatchError if vertex counts differ. Throws std::invalid_argument if an option or
  /// index is out of range, or if an anchor is given although vertices are fixed. Also throws
  /// std::invalid_argument for weights together with Outside::identity. The same holds if welded
  /// vertices lie apart in a rest pose, by more than 2 kPartedShare of its box. Throws
  /// std::runtime_error if the triangles do not determine the vertices, and Cancelled.
  VertexTransfer(const Positions& source_rest, const Positions& target_rest,
                 const Triangles& triangles, const std::vector<int>& selected,
                 const VertexTransferOptions& options = {}, const Context& context = {});
  ~VertexTransfer();
  VertexTransfer(VertexTransfer&&) noexcept;
  VertexTransfer& operator=(VertexTransfer&&) noexcept;

  /// Target poses for all frames, F x 3N. Throws MismatchError if the vertex counts differ, what
  /// reading throws, and Cancelled.
  Frames frames(const FrameSource& performance, const Context& context = {}) const;
  /// Writes the target poses to a sink, up to sixteen frames at a time. The caller commits. Throws
  /// as frames() does, and what writing throws.
  void write_frames(const FrameSource& performance, FrameSink& sink,
                    const Context& context = {}) const;

  /// Number of triangles with two welded corners. They take no part, and do not count as
  /// degenerate.
  int collapsed_triangles() const;
  int degenerate_source_triangles() const;
  int degenerate_target_triangles() const;
  /// Vertices (N) that stay exactly at the target's rest pose, or belong to a part that follows.
  const std::vector<bool>& fixed() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
