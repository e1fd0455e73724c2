#include "toolkit/pipeline/retarget.h"

#include <utility>

#include "toolkit/transfer/linear_transfer.h"

namespace mimetra {
namespace {

/// Carries a model to the target's place.
BlendshapeModel carried_model(const BlendshapeModel& model, const Similarity& similarity) {
  if (similarity.is_identity()) return model;
  ShapeBasis shapes = model.expressions();
  const Eigen::Matrix3d turn = (similarity.scale * similarity.rotation).transpose();
  for (int j = 0; j < shapes.size(); ++j) {
    Eigen::Map<Positions> field(shapes.displacements.col(j).data(), model.vertices(), 3);
    const Positions turned = field * turn;
    field = turned;
  }
  return {model.shared_connectivity(), similarity.apply(model.neutral()), std::move(shapes)};
}

Retargeting map_between(const Animation& source, const Target& target,
                        const TransferredTarget& transferred, const RetargetOptions& options,
                        const Context& context) {
  const BlendshapeTransferOptions of_map{.ridge = options.ridge,
                                         .sparsity = options.sparsity,
                                         .symmetry = options.symmetry,
                                         .exclusive = options.exclusive,
                                         .pairing = transferred.pairing};
  const BlendshapeModel there = carried_model(source.model(), transferred.similarity);
  if (transferred.pairing) {
    return linear_transfer(there, target.model, all_triangles(target.model.get().triangles()),
                           of_map, context);
  }
  // The matched target's polygons are cut along the source's diagonals.
  const MatchedTarget matched(source, target);
  const BlendshapeModel& model = (*matched).model;
  return linear_transfer(there, model, all_triangles(model.triangles()), of_map, context);
}

}  // namespace

void check_rigs(const Animation& source, const Target& target, const std::string& source_name) {
  if (source.model().expressions().size() == 0) {
    throw MismatchError(source_name + ": has no expressions, so there are no weights");
  }
  if (target.model.get().expressions().size() == 0) {
    throw MismatchError(target.name + ": has no expressions that could have weights");
  }
}

RetargetResult retarget(const Animation& source, const Target& target,
                        const RetargetOptions& options, const Context& context) {
  check_options(options);
  check_rigs(source, target, options.source_name);
  const TransferOptions of_transfer{.full = true,
                                    .source = {.name = options.source_name, .model_driven = true},
                                    .solve = {.space = Space::blendshape,
                                              .axes = options.axes,
                                              .smoothness = options.smoothness,
                                              .ridge = options.ridge,
                                              .sparsity = options.sparsity,
                                              .symmetry = options.symmetry,
                                              .exclusive = options.exclusive}};
  TransferResult result = transfer(source, {target}, of_transfer, context);
  RetargetResult made{std::move(result.targets.front())};
  if (options.keep_map) {
    made.map = map_between(source, target, made.transferred, options, context.part(1, 1));
  }
  return made;
}

}  // namespace mimetra
