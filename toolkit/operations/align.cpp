#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/whole_motion.h"
#include "toolkit/operations/parameter_files.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

Json json_of(const RigidTransform& transform) {
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation.push_back(transform.rotation(row, column));
  }
  const Eigen::Vector3d& translation = transform.translation;
  return {{"rotation", rotation},
          {"translation", {translation[0], translation[1], translation[2]}}};
}

struct AlignCall {
  AlignmentOptions alignment = {};
  /// Manifest of the motion to give back.
  std::optional<std::filesystem::path> undo = {};

  static constexpr Option kUndo{"undo", &AlignCall::undo};
};

BoundParameters<AlignCall> align_parameters() {
  BoundParameters<AlignmentOptions> alignment;
  alignment.add("on", AlignmentOptions::kVertices,
                "fit on the vertices that move least (stable), or on all of them");
  BoundParameters<AlignCall> list;
  return list.add(&AlignCall::alignment, alignment)
      .add("undo", AlignCall::kUndo, "manifest of an align run, whose motion is given back");
}

/// Progress at which the fit starts, after the frames are stored, and ends, before they are moved.
constexpr double kFittingFrom = 0.2;
constexpr double kFittingTo = 0.9;

/// A moved sequence and the motion between it and the given one.
struct Moved {
  std::shared_ptr<const FrameSource> frames;
  std::vector<RigidTransform> motion;
  /// Disagreement of the stillest vertices in degrees, if they determined the motion.
  std::optional<double> disagreement = {};
};

/// Warns if frames still move as a whole before a motion is given back to them.
void warn_of_motion_before(const FrameSource& given, const Invocation& invocation) {
  const WholeMotion whole = whole_motion(given, invocation.context.part(0, 0));
  if (!whole.moves()) return;
  invocation.warn(invocation.input("sequence").name + ": turns by up to " +
                  readable(whole.angle, 3) + " degrees and moves by up to " +
                  readable(whole.shift, 3) +
                  " against the rest pose before --undo gives a motion back: it is for frames that "
                  "the motion was taken out of");
}

/// Extent of the rest pose along each axis.
Eigen::Vector3d extent_of(const FrameSource& sequence) {
  const Positions& rest = sequence.rest();
  return (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).transpose();
}

Positions places_on(const FrameSource& sequence) {
  return sequence.rest()(spread_vertices(sequence.vertices()), Eigen::all);
}

/// Whether a sequence is turned against the sequence that the motion was taken out of. Compares
/// places of the same vertices or, for earlier manifests and other meshes, the extents along the
/// axes.
bool is_turned(const KeptMotion& kept, const FrameSource& sequence) {
  constexpr double kOfSize = 0.1;
  const Eigen::Vector3d was = *kept.extent, now = extent_of(sequence);
  if (kept.places && kept.vertices == sequence.vertices()) {
    constexpr double kTurned = 45;  // degrees; faces of other characters are turned by less
    const Positions places = places_on(sequence);
    const RigidTransform turn = rigid_fit(*kept.places, places);
    const double off = (turn.apply(*kept.places) - places).rowwise().norm().maxCoeff();
    // Vertices with another numbering do not fit.
    if (off < kOfSize * was.norm()) return turn.angle() > kTurned;
  }
  const Eigen::Vector3d turned(was.x(), was.z(), was.y());
  const double apart = (now - was).norm();
  return apart > kOfSize * was.norm() && (now - turned).norm() < apart / 2;
}

/// Warns if a motion belongs to a mesh in another unit or with another axis up. Its translations
/// and axes are relative to that mesh.
void warn_of_other_space(const KeptMotion& kept, const Invocation& invocation) {
  if (!kept.extent) return;
  const NamedData& input = invocation.input("sequence");
  const Eigen::Vector3d was = *kept.extent;
  const Eigen::Vector3d now = extent_of(*std::get<FieldSequence>(input.data).frames);
  constexpr const char* kAdvice =
      "; give the motion back first, then convert (--scale, --up) what is made";
  if (is_other_size(now.norm(), was.norm())) {
    const bool larger = now.norm() > was.norm();
    const double ratio = larger ? now.norm() / was.norm() : was.norm() / now.norm();
    invocation.warn(
        input.name + " is " + readable(ratio) + " times as " + (larger ? "large" : "small") +
        " as the sequence that the motion was taken out of, in whose unit it is" + kAdvice);
    return;
  }
  if (is_turned(kept, *std::get<FieldSequence>(input.data).frames)) {
    invocation.warn(input.name +
                    " has another axis up than the sequence that the motion was taken out of" +
                    kAdvice);
  }
}

Moved moved(const Invocation& invocation) {
  std::shared_ptr<const FrameSource> given = invocation.get<FieldSequence>("sequence").frames;
  const AlignCall call = align_parameters().read(invocation.parameters);
  if (call.undo) {
    KeptMotion kept = read_motion(call.undo->string(), given->frames());
    warn_of_other_space(kept, invocation);
    warn_of_motion_before(*given, invocation);
    return {with_motion(given, kept.transforms), std::move(kept.transforms)};
  }
  given = stored(given, invocation.context.part(0, kFittingFrom));
  const Context fitting = invocation.context.part(kFittingFrom, kFittingTo);
  if (call.alignment.vertices == AlignmentVertices::all) {
    std::vector<RigidTransform> motion = rigid_motion(*given, call.alignment, fitting);
    return {without_motion(given, motion), std::move(motion)};
  }
  StableMotion stable = stable_motion(*given, fitting);
  return {without_motion(given, stable.motion), std::move(stable.motion), stable.disagreement};
}

Outcome run_align(const Invocation& invocation) {
  const NamedData& input = invocation.input("sequence");
  const Moved result = moved(invocation);
  double degrees = 0, shift = 0;
  for (const RigidTransform& transform : result.motion) {
    degrees = std::max(degrees, transform.angle());
    shift = std::max(shift, transform.translation.norm());
  }
  const Eigen::Vector3d extent = extent_of(*result.frames);
  Json places = Json::array();
  const Positions kept = places_on(*result.frames);
  for (const auto& place : kept.rowwise()) {
    places.push_back({place[0], place[1], place[2]});
  }
  Json report = {
      {"frames", result.frames->frames()},     {"extent", {extent.x(), extent.y(), extent.z()}},
      {"vertices", result.frames->vertices()}, {"places", std::move(places)},
      {"largest_rotation_degrees", degrees},   {"largest_translation", shift}};
  if (result.disagreement) {
    report["disagreement_degrees"] = *result.disagreement;
    report["uncertain"] = *result.disagreement > kUncertainDisagreement;
    if (*result.disagreement > kUncertainDisagreement) {
      invocation.warn(input.name +
                      ": no vertex is still enough to tell the head's motion: the stillest "
                      "disagree by " +
                      readable(*result.disagreement, 2) +
                      " degrees; transfer --align joint finds it together with a target's "
                      "expressions");
    }
  }
  Outcome outcome;
  outcome.report = report_with(report, "motion", result.motion.size(), [&result](std::size_t f) {
    return json_text(json_of(result.motion[f]));
  });
  outcome.summary = "largest rotation " + readable(degrees) + " degrees, largest translation " +
                    readable(shift) + '\n';
  const auto& given = std::get<FieldSequence>(input.data);
  warn_of_lost_expressions(invocation, *given.frames, KeptInScenes::no);
  FieldSequence made =
      held_like(given, result.frames, invocation.context.part(kFittingTo, 1).without_ranks());
  made.fields = given.fields;
  outcome.outputs["out"].push_back({"", std::move(made), input.origin});
  return outcome;
}

}  // namespace

Operation align_operation() {
  Operation operation;
  operation.name = "align";
  operation.summary = "Take the rigid motion out of each frame; the manifest keeps it";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to align"}};
  operation.inputs.front().fields = true;
  operation.inputs.front().streamed = true;
  operation.outputs = {{"out", DataKind::sequence, "the new sequence"}};
  operation.parameters = align_parameters().declared();
  operation.examples = {"align takes/ -o still/",
                        "align still/ --undo still/mimetra-run.json -o back/"};
  operation.run = run_align;
  operation.shared = true;
  operation.memory = [](const Invocation& invocation) {
    const FieldSequence& sequence = invocation.get<FieldSequence>("sequence");
    const double of_frames =
        sequence.is_in_memory() ? frame_bytes(*sequence.frames) : stored_bytes(*sequence.frames);
    // Poses in memory at the same time: read, moved, compared and written.
    constexpr double kPoses = 4;
    return of_frames + kPoses * frame_bytes(*sequence.frames) / sequence.frames->frames();
  };
  return operation;
}

}  // namespace mimetra
