#include "toolkit/pipeline/source.h"

#include <algorithm>

#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

using Motion = std::variant<HeadMotion, std::vector<RigidTransform>>;
using Shared = std::shared_ptr<const FrameSource>;

/// Keeping the frames of a source that is slow to read, as a part of its progress.
constexpr double kStoringShare = 0.3;

/// A head that turns by more than that, in degrees, is no matter of a moving jaw, which reads as
/// two.
constexpr double kTurning = 10;

/// What is to be taken out, and why.
struct MotionChoice {
  Motion motion;
  std::string_view reason;
  bool is_asked = false;
};

MotionChoice motion_of(const FrameSource& sequence, const SourceOptions& options) {
  if (options.head_motion) return {*options.head_motion, "it was asked for", true};
  if (options.model_driven) return {HeadMotion::none, "a model drives the sequence"};
  if (sequence.frames() == 1) return {HeadMotion::none, "there is one frame"};
  const bool is_given = options.rest && std::holds_alternative<Positions>(*options.rest);
  if (is_given || sequence.rest_is_known()) return {HeadMotion::none, "the neutral is known"};
  return {HeadMotion::stable, "the neutral is not known"};
}

bool takes_out(const Motion& motion) {
  const auto* fitted = std::get_if<HeadMotion>(&motion);
  return !fitted || *fitted != HeadMotion::none;
}

/// The motion to take out; empty for none.
std::vector<RigidTransform> motion_in(const FrameSource& sequence, const Motion& motion,
                                      AlignmentOptions options) {
  if (const auto* given = std::get_if<std::vector<RigidTransform>>(&motion)) return *given;
  switch (std::get<HeadMotion>(motion)) {
    case HeadMotion::stable:
      options.vertices = AlignmentVertices::stable;
      return rigid_motion(sequence, options);
    case HeadMotion::all:
      options.vertices = AlignmentVertices::all;
      return rigid_motion(sequence, options);
    case HeadMotion::none:
      break;
  }
  return {};
}

Shared with_asked_rest(Shared sequence, const SourceOptions& options) {
  if (!options.rest) {
    if (!sequence->rest_is_known()) {
      note(options.notes,
           options.name + ": its neutral is not known, the first frame stands in for it",
           Topic::unknown_neutral);
    }
    return sequence;
  }
  if (const auto* given = std::get_if<Positions>(&*options.rest)) {
    return with_rest(std::move(sequence), *given);
  }
  switch (std::get<SourceRest>(*options.rest)) {
    case SourceRest::neutral:
      if (sequence->rest_is_known()) return sequence;
      throw OptionError(Topic::unknown_neutral, options.name + ": its neutral is not known");
    case SourceRest::first:
      return with_rest(sequence, Positions(FrameBlock(*sequence, 0, 1).frame(0)));
    case SourceRest::mean:
      break;
  }
  return sequence;  // the mean is that of the aligned frames
}

std::string_view name_of(const Motion& motion) {
  const auto* fitted = std::get_if<HeadMotion>(&motion);
  return fitted ? choice_name(*fitted) : "given";
}

/// The largest motion of all frames.
HeadMotionTaken taken(const MotionChoice& choice, const Source& source) {
  HeadMotionTaken taken{name_of(choice.motion), choice.reason};
  const Eigen::Vector3d center = source.sequence->rest().colwise().mean();
  for (const RigidTransform& transform : source.motion) {
    taken.angle = std::max(taken.angle, transform.angle());
    const Eigen::Vector3d there = transform.rotation * center + transform.translation;
    taken.shift = std::max(taken.shift, (there - center).norm());
  }
  return taken;
}

/// Says what nobody asked for: that motion was taken out, or that the head turns and it was not.
void note_motion(const MotionChoice& choice, const Source& source, const SourceOptions& options) {
  if (choice.is_asked || options.model_driven || source.sequence->frames() == 1) return;
  if (takes_out(choice.motion)) {
    const HeadMotionTaken& motion = source.head_motion;
    if (motion.angle == 0 && motion.shift == 0) return;
    note(options.notes, options.name + ": a head motion of up to " + readable(motion.angle, 2) +
                            " degrees and " + readable(motion.shift, 2) + " is taken out, as " +
                            std::string(choice.reason));
    return;
  }
  double angle = 0;
  for (const RigidTransform& transform : rigid_motion(
           *source.sequence, {.vertices = AlignmentVertices::all, .threads = options.threads})) {
    angle = std::max(angle, transform.angle());
  }
  if (angle < kTurning) return;
  note(options.notes,
       options.name + ": the head turns by up to " + readable(angle, 2) +
           " degrees against the rest pose, which counts as deformation, as " +
           std::string(choice.reason),
       Topic::turning_head);
}

Shared kept(Shared sequence, const SourceOptions& options) {
  return stored(std::move(sequence), {.threads = options.threads,
                                      .progress = part_of(options.progress, 0, kStoringShare)});
}

/// True for a shape that was given, and for the sequence's own where none was asked for.
bool knows_neutral(const FrameSource& sequence, const SourceOptions& options) {
  if (!options.rest) return sequence.rest_is_known();
  const auto* word = std::get_if<SourceRest>(&*options.rest);
  return !word || *word == SourceRest::neutral;
}

bool is_mean(const SourceOptions& options) {
  const auto* word = options.rest ? std::get_if<SourceRest>(&*options.rest) : nullptr;
  return word && *word == SourceRest::mean;
}

}  // namespace

bool takes_out_motion(const FrameSource& sequence, const SourceOptions& options) {
  return takes_out(motion_of(sequence, options).motion);
}

Source prepare_source(Shared sequence, const SourceOptions& options) {
  // Whether the head moves is judged by what is known of the sequence itself.
  const MotionChoice choice = motion_of(*sequence, options);
  Source source;
  source.given = kept(std::move(sequence), options);
  source.sequence = with_asked_rest(source.given, options);
  source.rest_is_given = options.rest.has_value();
  source.neutral_is_known = knows_neutral(*source.given, options);
  source.motion = motion_in(
      *source.sequence, choice.motion,
      {.threads = options.threads, .progress = part_of(options.progress, kStoringShare, 1)});
  source.head_motion = taken(choice, source);
  note_motion(choice, source, options);
  if (takes_out(choice.motion)) {
    source.sequence = without_motion(source.sequence, source.motion);
  }
  if (is_mean(options)) source.sequence = with_rest(source.sequence, mean_pose(*source.sequence));
  return source;
}

Source prepare_source(const MeshSequence& sequence, const SourceOptions& options) {
  return prepare_source(std::make_shared<const MeshSequence>(sequence), options);
}

Shared with_head_motion(Shared result, std::vector<RigidTransform> motion) {
  return with_rest(with_motion(std::move(result), std::move(motion)), {});
}

}  // namespace mimetra
