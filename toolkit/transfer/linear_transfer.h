#pragma once

#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/retargeting.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// How the frame [e1 e2 n] of a triangle (triangle_frame()) with `edges` e1, e2 changes while these
/// change by `change`: the derivative of eq. 8. The third column is 0 where there is no area.
Eigen::Matrix3d triangle_frame_change(const Edges& edges, const Edges& change);

/// The transfer of eq. 10 between two models, linear in the source's weights w: G of
/// BlendshapeTransfer and H = dh / dw of its right-hand side h at the source's neutral. e1 and e2
/// are linear in w as they are; the normal is replaced by its derivative. Where w is small the
/// error of H w falls with its square. Bounds are 0 and 1, and 0 twice for expressions that the
/// triangles do not show.
///
/// `source` stands where the target is and has its connectivity, or is that of the pairing;
/// `triangles` are rows of target.triangles(). Of the options, ridge, sparsity and smoothness are
/// those of retargeted(). Throws MismatchError where one of the models has no expression, or the
/// vertex counts differ; std::invalid_argument for a triangle or an option out of range; Cancelled.
Retargeting linear_transfer(const BlendshapeModel& source, const BlendshapeModel& target,
                            std::vector<int> triangles,
                            const BlendshapeTransferOptions& options = {},
                            const Context& context = {});

/// Throws what retargeted() throws of a map and options: std::invalid_argument for a map that is
/// none and for options out of range, MismatchError for sparsity of an expression that may be
/// negative.
void check_map(const Retargeting& map, const BlendshapeTransferOptions& options);

/// beta for every frame (F x D_t), within the map's bounds, of the source's weights (F x D_s).
/// Edges and pairing of the options are the map's already; `times` (F, seconds) matter to the
/// smoothness only. Throws as check_map(), std::invalid_argument for sizes that disagree, and
/// Cancelled.
Eigen::MatrixXd retargeted(const Retargeting& map, const Eigen::MatrixXd& weights,
                           const Eigen::VectorXd& times,
                           const BlendshapeTransferOptions& options = {},
                           const Context& context = {});

}  // namespace mimetra
