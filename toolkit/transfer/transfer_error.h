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

/// How far a transferred sequence is from the source's deformation. Where the faces differ, only
/// the target's triangles with a partner are asked for anything, and count.
struct TransferError {
  /// DE over all triangles and over L: mean over frames and triangles of ||Q_i V_i - V~_i||^2 (eq.
  /// 12), a sum over edges (EdgeSum), unit of length squared.
  double de_all = 0;
  double de_region = 0;
  /// DE over the triangles of L of which all corners take all of the deformation, none where no
  /// triangle does; de_region where vertices have no weights.
  std::optional<double> de_inside;
  /// DE against the share of the deformation that vertices are to take, and what that is of a
  /// result that stays at rest: what is asked for. Summed over the triangles that take all of it,
  /// or, where none does or vertices have no weights, over all; divided by the number of all.
  double de_share = 0;
  double de_still = 0;
  Eigen::VectorXd per_frame;     ///< mean over all triangles (F)
  Eigen::VectorXd per_triangle;  ///< mean over frames (M), 0 for those that do not count
  int triangles = 0;             ///< those that count
  /// Largest displacement from the target's rest of a vertex in no triangle of L, over all frames;
  /// where vertices have weights, of one of weight 0; length.
  double leak = 0;
  /// How much more the surface bends at the regions' border than the source asks for, in degrees
  /// (BorderCrease): RMS over the border, and the largest; each in the frame where it is largest. 0
  /// without a border.
  double crease = 0;
  double largest_crease = 0;
  /// Triangles, over all frames, that turned by more than 90 degrees against where the source's
  /// gradient, or the share of it that is asked for, wants them; slivers of the target (below
  /// kSliverQuality) do not count.
  int flipped = 0;
};

struct TransferErrorOptions {
  EdgeSum edges = EdgeSum::all;
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};
  /// Vertices inside the regions (N), whose border may be a crease; empty for no border.
  std::vector<bool> inside = {};
  /// Share of the wanted motion of each vertex (N) where the border is soft; instead of `inside`.
  Eigen::VectorXd weights = {};
  /// Vertices that are one point of the target's surface (N), so that a border on a seam is seen;
  /// by default none are.
  Weld weld = {};

  static constexpr Option kEdges{"edges", &TransferErrorOptions::edges};
  static constexpr auto declared() { return std::tuple(kEdges); }
};

/// `result` is the transferred sequence before head motion is given back; its rest pose is the
/// target's neutral. `source` F frames with its neutral as rest. `selected` = L, rows of the
/// target's triangles. A degenerate source triangle is measured against what stands in for it in
/// the transfer. Throws MismatchError if sizes differ, std::invalid_argument for a row or an option
/// out of range or weights that are not in [0, 1], what reading throws, and Cancelled.
TransferError transfer_error(const FrameSource& source, const FrameSource& result,
                             const std::vector<int>& selected,
                             const TransferErrorOptions& options = {}, const Context& context = {});

/// Flipped triangles of all in all frames.
double flipped_share(const TransferError& error);

/// The share of the deformation that is asked for, by de_share, that the result lacks: 0 is exact,
/// 1 is no better than none. 0 where none is asked for.
double missed_share(const TransferError& error);

/// Mean percentage error 100 (full - k) / full, signed: negative is worse than full (eq. 13). 0
/// where both are equal, also where both are 0.
double mean_percentage_error(double full, double k);

/// How much more a surface bends at the border of regions than its source asks for.
///
/// The border are edges between triangles of which the weights phi differ. Edge ij bends by b, the
/// signed angle between the normals of its triangles less that at rest. The source asks for the
/// bend w, that of the normals which its gradients make of the rest's, det(Q) Q^-T n. The excess is
/// |b| less what of w goes the same way, at least 0. Edges count by their length at rest times
/// |phi_i - phi_j|, so that a border counts the same whether it is hard or fades.
class BorderCrease {
 public:
  /// `rest` N x 3, `triangles` M x 3 with vertices that are one written as one; `weights` M. Edges
  /// of triangles that do not count (M), or are degenerate at rest, and of more than two do not.
  BorderCrease(const Positions& rest, const Triangles& triangles, const Eigen::VectorXd& weights,
               const std::vector<bool>& counts);

  /// Of one frame, in degrees.
  struct Excess {
    double rms = 0;
    double largest = 0;
  };

  /// `wanted` are the edges that the source makes of those at rest (M), `pose` N x 3. Triangles
  /// that have no area there do not count. 0 without a border.
  Excess operator()(const std::vector<Edges>& wanted, const PositionsView& pose) const;

  bool empty() const { return hinges_.empty(); }

 private:
  struct Hinge {
    int first, second;  // triangles
    /// Of the edge, in the edges of each triangle.
    Eigen::Vector2d in_first, in_second;
    double weight;
    double at_rest;  // angle, radians
  };

  Triangles triangles_;
  std::vector<Hinge> hinges_;
};

}  // namespace mimetra
