#pragma once

#include <span>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// What eq. 10 asks of a target's triangles: the b of eq. 11, changes (Q_i - I) V_i of the edges of
/// the selected triangles, six rows each as in edge_rows(), one column a frame (6 T x F, unit of
/// the target). `gradients` are those of the target's triangles at the performance's rest pose.
/// Throws what reading throws, and Cancelled.
Eigen::MatrixXd wanted_change(const DeformationGradients& gradients, const BlendshapeModel& target,
                              const FrameSource& performance, EdgeSum sum,
                              const Context& context = {});

/// What weights of the target's expressions (F x D) leave of the wanted change of some triangles:
/// the residual r = b - A beta (6 T x F). Throws Cancelled.
Eigen::MatrixXd unmet_change(Eigen::MatrixXd wanted, std::span<const int> triangles,
                             const BlendshapeModel& target, const Eigen::MatrixXd& weights,
                             EdgeSum sum, const Context& context = {});

}  // namespace mimetra
