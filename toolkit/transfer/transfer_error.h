#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// Error of a transferred sequence against the source's deformation. If the faces differ, only
/// triangles of the target that have a partner count.
struct TransferError {
  /// DE over all triangles and over L: mean over frames and triangles of ||Q_i V_i - V~_i||^2
  /// (eq. 12). Summed over edges (EdgeSum), unit of length squared.
  double de_all = 0;
  double de_region = 0;
  /// DE over the triangles of L whose corners all have weight 1. Empty if there are none, and equal
  /// to de_region if vertices have no weights.
  std::optional<double> de_inside;
  /// Errors against the share of the deformation that the vertices should take: of the result
  /// (de_share), and of a result that stays at rest (de_still). They are sums over the triangles
  /// with weight 1 at all corners, divided by the number of all triangles. If there are none, or
  /// vertices have no weights, the sums are over all triangles.
  double de_share = 0;
  double de_still = 0;
  Eigen::VectorXd per_frame;     ///< mean over all triangles (F)
  Eigen::VectorXd per_triangle;  ///< mean over frames (M), 0 for triangles that do not count
  int triangles = 0;             ///< number of triangles that count
  /// Largest displacement from the target's rest over all frames, for vertices in no triangle of L.
  /// With weights, for vertices of weight 0. If faces differ, only vertices with carriers count.
  /// Unit of length.
  double leak = 0;
  /// Excess bend of the surface at the regions' border over the bend that the source asks for, in
  /// degrees (BorderCrease). `crease` is the RMS over the border, `largest_crease` the largest.
  /// Both are from their worst frame, and 0 without a border.
  double crease = 0;
  double largest_crease = 0;
  /// Number of triangles, over all frames, that turned by more than 90 degrees from the orientation
  /// that the source's gradient asks for. With weights, the gradient's share counts. Slivers of the
  /// target (below kSliverQuality) do not count.
  int flipped = 0;
};

struct TransferErrorOptions {
  EdgeSum edges = EdgeSum::all;
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};
  /// Vertices inside the regions (N), whose border may crease. Empty for no border.
  std::vector<bool> inside = {};
  /// Share of the wanted motion of each vertex (N) if the border is soft. Replaces `inside`.
  Eigen::VectorXd weights = {};
  /// Vertices that are one point of the target's surface (N), so that a border on a seam is seen.
  /// Empty for none.
  Weld weld = {};

  static constexpr Option kEdges{"edges", &TransferErrorOptions::edges};
  static constexpr auto declared() { return std::tuple(kEdges); }
};

/// Measures a transferred sequence. `result` is the sequence before head motion is restored, and
/// its rest pose is the target's neutral. `source` has the same F frames, with its neutral as rest
/// pose. `selected` = L, rows of the target's triangles. For a degenerate source triangle, the
/// transfer's substitute gradient counts.
///
/// Throws MismatchError if sizes differ. Throws std::invalid_argument if a row or an option is out
/// of range, or weights are not in [0, 1]. Throws what reading throws, and Cancelled.
TransferError transfer_error(const FrameSource& source, const FrameSource& result,
                             const std::vector<int>& selected,
                             const TransferErrorOptions& options = {}, const Context& context = {});

/// Share of flipped triangles among all that count, over all frames.
double flipped_share(const TransferError& error);

/// Share of the demanded deformation that the result lacks, by de_share. 0 is exact, and 1 is no
/// better than no motion. 0 if no deformation is demanded.
double missed_share(const TransferError& error);

/// Mean percentage error 100 (full - k) / full, signed: negative is worse than full (eq. 13). 0 if
/// both are equal, even if both are 0.
double mean_percentage_error(double full, double k);

/// Excess bend of a surface at the border of regions.
///
/// The border consists of edges between triangles whose weights phi differ. Edge ij bends by b, the
/// signed angle between its triangles' normals minus the angle at rest. The source asks for the
/// bend w of the normals that its gradients produce, det(Q) Q^-T n. The excess is |b| minus the
/// part of w in the same direction, at least 0. Edges are weighted by their length at rest times
/// |phi_i - phi_j|, so that hard and soft borders weigh the same.
class BorderCrease {
 public:
  /// `rest` is N x 3, and `weights` has one entry a triangle (M). `triangles` (M x 3) are on welded
  /// vertices. Triangles outside `counts` (M) or degenerate at rest are ignored. An edge counts if
  /// exactly two of the remaining triangles share it.
  BorderCrease(const Positions& rest, const Triangles& triangles, const Eigen::VectorXd& weights,
               const std::vector<bool>& counts);

  /// Excess of one frame, in degrees.
  struct Excess {
    double rms = 0;
    double largest = 0;
  };

  /// `wanted` are the edges that the source's gradients make of the edges at rest (M). `pose` is
  /// N x 3. Edges next to a triangle without area do not count. 0 without a border.
  Excess operator()(const std::vector<Edges>& wanted, const PositionsView& pose) const;

  bool empty() const { return hinges_.empty(); }

 private:
  struct Hinge {
    int first, second;  // triangles
    /// The edge in terms of each triangle's edges.
    Eigen::Vector2d in_first, in_second;
    double weight;
    double at_rest;  // radians
  };

  Triangles triangles_;
  std::vector<Hinge> hinges_;
};

}  // namespace mimetra
