#include "toolkit/pipeline/retarget.h"

#include <utility>

#include "toolkit/transfer/linear_transfer.h"

namespace mimetra {
namespace {

/// The model where the target stands.
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
                        const TransferredTarget& transferred, const RetargetOptions& options) {
  BlendshapeTransferOptions of_map = options.solving.blendshape;
  of_map.edges = options.solving.edges;
  of_map.pairing = transferred.pairing;
  of_map.threads = options.threads;
  const BlendshapeModel there = carried_model(source.model(), transferred.similarity);
  if (transferred.pairing) {
    return linear_transfer(there, target.model, all_triangles(target.model.get().triangles()),
                           of_map);
  }
  // Polygons may be cut along other diagonals than the source's.
  const MatchedTarget matched(source, target);
  const BlendshapeModel& model = (*matched).model;
  return linear_transfer(there, model, all_triangles(model.triangles()), of_map);
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
                        const RetargetOptions& options) {
  check_rigs(source, target, options.source_name);
  TransferOptions of_transfer;
  of_transfer.full = true;
  of_transfer.source.name = options.source_name;
  of_transfer.source.model_driven = true;
  of_transfer.solving = options.solving;
  of_transfer.solving.space = Space::blendshape;
  of_transfer.threads = options.threads;
  of_transfer.progress = options.progress;
  of_transfer.notes = options.notes;
  TransferResult result = transfer(source, {target}, of_transfer);
  RetargetResult made{std::move(result.targets.front())};
  if (options.keep_map) made.map = map_between(source, target, made.transferred, options);
  return made;
}

}  // namespace mimetra
