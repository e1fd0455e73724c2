#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/parameter_files.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

double degrees_of(const RigidTransform& transform) {
  const double cosine = std::clamp((transform.rotation.trace() - 1) / 2, -1.0, 1.0);
  return std::acos(cosine) * 180 / std::numbers::pi;
}

Json json_of(const std::vector<RigidTransform>& motion) {
  Json list = Json::array();
  for (const RigidTransform& transform : motion) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        rotation.push_back(transform.rotation(row, column));
    }
    const Eigen::Vector3d& translation = transform.translation;
    list.push_back({{"rotation", rotation},
                    {"translation", {translation[0], translation[1], translation[2]}}});
  }
  return list;
}

struct AlignCall {
  AlignmentOptions alignment = {};
  /// Manifest of the motion that is given back.
  std::optional<std::string> undo = {};
};

BoundParameters<AlignCall> align_parameters() {
  BoundParameters<AlignmentOptions> alignment;
  alignment.add("on", AlignmentOptions::kVertices,
                "fit on the vertices that move least (stable), or on all of them");
  BoundParameters<AlignCall> list;
  list.add(&AlignCall::alignment, alignment)
      .add(
          {"undo", ParameterKind::file, {}, "manifest of an align run, whose motion is given back"},
          [](const Parameters& values, AlignCall& call) {
            call.undo = values.optional_text("undo");
          });
  return list;
}

Alignment aligned(const Invocation& invocation) {
  const MeshSequence& sequence = invocation.sequence("sequence");
  AlignCall call = align_parameters().read(invocation.parameters);
  if (call.undo) {
    std::vector<RigidTransform> motion = read_motion(*call.undo, sequence.frames());
    return {with_motion(sequence, motion), std::move(motion)};
  }
  call.alignment.progress = invocation.progress;
  return align(sequence, call.alignment);
}

Outcome run_align(const Invocation& invocation) {
  Alignment alignment = aligned(invocation);
  double degrees = 0, shift = 0;
  for (const RigidTransform& transform : alignment.motion) {
    degrees = std::max(degrees, degrees_of(transform));
    shift = std::max(shift, transform.translation.norm());
  }
  Outcome outcome;
  outcome.report = Json{{"frames", alignment.sequence.frames()},
                        {"largest_rotation_degrees", degrees},
                        {"largest_translation", shift},
                        {"motion", json_of(alignment.motion)}}
                       .dump();
  outcome.summary = "largest rotation " + readable(degrees) + " degrees, largest translation " +
                    readable(shift) + '\n';
  outcome.outputs["out"].push_back(
      {"", FieldSequence(std::move(alignment.sequence)), invocation.input("sequence").origin});
  return outcome;
}

}  // namespace

Operation align_operation() {
  Operation operation;
  operation.name = "align";
  operation.summary = "Take the rigid motion out of each frame; the manifest keeps it";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to align"}};
  operation.outputs = {{"out", DataKind::sequence, sequence_outputs()}};
  operation.parameters = align_parameters().declared();
  operation.examples = {"align takes/ -o still/",
                        "align still/ --undo still/mimetra-run.json -o back/"};
  operation.run = run_align;
  operation.memory = [](const Invocation& invocation) {
    const MeshSequence& sequence = invocation.sequence("sequence");
    return static_cast<double>(sequence.positions().size() * sizeof(double));
  };
  return operation;
}

}  // namespace mimetra
