#pragma once

#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/retargeting.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// Derivative of eq. 8: the change of a triangle's frame [e1 e2 n] (triangle_frame()) if its
/// `edges` e1, e2 change by `change`. The third column is 0 if the triangle has no area.
Eigen::Matrix3d triangle_frame_change(const Edges& edges, const Edges& change);

/// Transfer of eq. 10 between two models, linear in the source's weights w.
///
/// The map consists of the Gram matrix G of BlendshapeTransfer and of H = dh / dw, with its
/// right-hand side h at the source's neutral. The edges e1 and e2 are already linear in w. The
/// normal is replaced by its derivative, so the error of H w is of second order in w. Bounds are 0
/// and 1, or 0 and 0 for expressions that the triangles do not show.
///
/// `source` must lie over the target. It has the target's connectivity, or is the pairing's source.
/// `triangles` are rows of target.triangles(). Only the options edges and pairing take effect; pass
/// ridge, sparsity and smoothness to retargeted().
///
/// Throws MismatchError if a model has no expressions or the vertex counts differ. Throws
/// std::invalid_argument if a triangle or an option is out of range. Throws Cancelled.
Retargeting linear_transfer(const BlendshapeModel& source, const BlendshapeModel& target,
                            std::vector<int> triangles,
                            const BlendshapeTransferOptions& options = {},
                            const Context& context = {});

/// Throws std::invalid_argument if the map is invalid (Retargeting::check()) or an option is out of
/// range. Throws MismatchError if sparsity is used with an expression that may be negative.
void check_map(const Retargeting& map, const BlendshapeTransferOptions& options);

/// beta for every frame (F x D_t) within the map's bounds, from the source's weights (F x D_s). The
/// options' edges and pairing are ignored, since the map already contains them. `times` (F,
/// seconds) affect only the smoothness. Throws as check_map() does, std::invalid_argument if sizes
/// disagree, and Cancelled.
Eigen::MatrixXd retargeted(const Retargeting& map, const Eigen::MatrixXd& weights,
                           const Eigen::VectorXd& times,
                           const BlendshapeTransferOptions& options = {},
                           const Context& context = {});

}  // namespace mimetra
