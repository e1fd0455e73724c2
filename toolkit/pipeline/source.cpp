#include "toolkit/pipeline/source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/rest_beyond_frames.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/whole_motion.h"
#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

namespace {

using Motion = std::variant<HeadMotion, std::vector<RigidTransform>>;
using Shared = std::shared_ptr<const FrameSource>;

/// Share of the progress for storing the frames of a source that is slow to read.
constexpr double kStoringShare = 0.3;

/// A head turns if it turns by more than this, in degrees. A moving jaw looks like 2 degrees.
constexpr double kTurning = 10;

/// The motion to take out, and the reason.
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

/// A joint motion that was not asked for must predict held-out vertices this many times as well as
/// the stable one. On faces that move everywhere it is 4 to 9 times as good, on heads with still
/// vertices 0.9 to 1.1 times.
constexpr double kJointGain = 2;

bool predicts_better(const JointMotion& joint) {
  return joint.held_out && kJointGain * joint.held_out->joint < joint.held_out->stable;
}

/// Finds the motion of the stillest vertices, and the joint motion if it is asked for or may be
/// better.
void find_stable_or_joint(Source& source, const MotionChoice& choice, bool is_joint,
                          const JointSearch& joint_search, const Context& context) {
  StableMotion stable = stable_motion(*source.sequence, context);
  HeadMotionTaken& taken = source.head_motion;
  taken.stillest = stable.stillest / source.sequence->diameter();
  taken.disagreement = stable.disagreement;
  source.motion = std::move(stable.motion);
  const bool is_open = !choice.is_asked && taken.is_uncertain() && joint_search;
  if (!is_joint && !is_open) return;
  JointMotion joint = joint_search(source, context.part(1, 1));
  taken.held_out = joint.held_out;
  if (!is_joint && !predicts_better(joint)) return;
  source.motion = std::move(joint.motion);
  taken.how = choice_name(HeadMotion::joint);
  if (!is_joint) taken.why = "no vertex is still enough to tell it";
}

/// Sets the motion to take out; empty for none.
void find_motion(Source& source, const MotionChoice& choice, const JointSearch& joint,
                 const Context& context) {
  if (const auto* given = std::get_if<std::vector<RigidTransform>>(&choice.motion)) {
    source.motion = *given;
    return;
  }
  const HeadMotion asked = std::get<HeadMotion>(choice.motion);
  switch (asked) {
    case HeadMotion::stable:
    case HeadMotion::joint:
      find_stable_or_joint(source, choice, asked == HeadMotion::joint, joint, context);
      return;
    case HeadMotion::all:
      source.motion = rigid_motion(*source.sequence, {.vertices = AlignmentVertices::all}, context);
      return;
    case HeadMotion::none:
      return;
  }
}

Shared with_asked_rest(Shared sequence, const SourceOptions& options, const Context& context) {
  if (!options.rest) {
    if (!sequence->rest_is_known()) {
      context.note(options.name + ": its neutral is not known, the first frame stands in for it",
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
  return sequence;  // prepare_source() sets the mean, after alignment
}

/// Throws MismatchError for a rest pose in another unit than the frames, which would hide all
/// deformation.
void check_size_of_rest(const FrameSource& sequence, const std::string& name) {
  const std::vector<VertexIndex> surface = surface_vertices(sequence.rest(), sequence.triangles());
  const double of_rest = spread(sequence.rest()(surface, Eigen::all));
  const double of_frame = spread(FrameBlock(sequence, 0, 1).frame(0)(surface, Eigen::all));
  if (!is_other_size(of_rest, of_frame)) return;
  const bool larger = of_rest > of_frame;
  const double ratio = larger ? of_rest / of_frame : of_frame / of_rest;
  throw MismatchError(name + ": the rest pose is " +
                      (std::isfinite(ratio) ? readable(ratio) + " times as " : "infinitely ") +
                      (larger ? "large" : "small") +
                      " as frame 0; bring both into one unit (`mimetra convert --scale X`)");
}

std::string_view name_of(const Motion& motion) {
  const auto* fitted = std::get_if<HeadMotion>(&motion);
  return fitted ? choice_name(*fitted) : "given";
}

/// Records the largest rotation and translation of all frames.
void measure_motion(Source& source) {
  HeadMotionTaken& taken = source.head_motion;
  const Eigen::Vector3d center = source.sequence->rest().colwise().mean();
  for (const RigidTransform& transform : source.motion) {
    taken.angle = std::max(taken.angle, transform.angle());
    const Eigen::Vector3d there = transform.rotation * center + transform.translation;
    taken.shift = std::max(taken.shift, (there - center).norm());
  }
}

std::string in_percent(double share) {
  return readable(100 * share, 2) + " %";
}

/// Describes both errors on held-out vertices, for a note.
std::string comparison(const HeldOutErrors& errors) {
  return "vertices that were held out of the fit are predicted to " + in_percent(errors.joint) +
         " of the size together with the target's expressions, to " + in_percent(errors.stable) +
         " by the stillest vertices";
}

/// Notes that no vertex is still enough to determine the motion, and which motion is used.
void note_uncertainty(const MotionChoice& choice, const Source& source,
                      const SourceOptions& options, const Context& context) {
  const HeadMotionTaken& motion = source.head_motion;
  if (!motion.is_uncertain()) return;
  const bool is_joint = motion.how == choice_name(HeadMotion::joint);
  if (is_joint && choice.is_asked) return;
  std::string text = options.name +
                     ": no vertex is still enough to tell the head's motion: the stillest, which "
                     "move by " +
                     in_percent(*motion.stillest) + " of the size, disagree by " +
                     readable(*motion.disagreement, 3) + " degrees";
  if (is_joint) text += ", so it is found together with the target's expressions";
  if (motion.held_out) text += "; " + comparison(*motion.held_out);
  context.note(text, is_joint ? Topic::joint_motion : Topic::uncertain_motion);
}

/// Notes frames that differ from the rest pose in size, or by a motion of the whole head that was
/// not taken out. Returns whether they do.
bool note_whole_motion(const MotionChoice& choice, const Source& source,
                       const SourceOptions& options, const Context& context) {
  const WholeMotion whole = whole_motion(*source.sequence, context);
  const std::string reason = ", as " + std::string(choice.reason);
  if (whole.is_scaled()) {
    context.note(options.name + ": frames are " + readable(whole.scale, 3) +
                 " times as large as the rest pose, which is " +
                 in_percent(1 - whole.left_by_similarity) +
                 " of how they differ from it and counts as deformation; bring both into one unit "
                 "(`mimetra convert --scale X`)");
    return true;
  }
  if (whole.angle < kTurning && !whole.moves()) return false;
  context.note(options.name + ": the head turns by up to " + readable(whole.angle, 3) +
                   " degrees and moves by up to " + readable(whole.shift, 3) +
                   " against the rest pose, " + in_percent(1 - whole.left_by_motion) +
                   " of all motion, which counts as deformation" + reason,
               Topic::turning_head);
  return true;
}

/// Notes frames that still move as a whole without the given motion. Returns whether they do.
bool note_given_motion(const Source& source, const SourceOptions& options, const Context& context) {
  const WholeMotion whole = whole_motion(*without_motion(source.sequence, source.motion), context);
  if (!whole.moves()) return false;
  context.note(
      options.name + ": without the motion that is given the head turns by up to " +
      readable(whole.angle, 3) + " degrees and moves by up to " + readable(whole.shift, 3) +
      " against the rest pose, " + in_percent(1 - whole.left_by_motion) +
      " of all motion, which counts as deformation; was it taken out already, or is it that "
      "of other frames?");
  return true;
}

/// Notes a motion that was taken out, or left in, without being asked for. Returns whether the
/// frames still differ from the rest pose as a whole.
bool note_motion(const MotionChoice& choice, const Source& source, const SourceOptions& options,
                 const Context& context) {
  if (std::holds_alternative<std::vector<RigidTransform>>(choice.motion)) {
    return note_given_motion(source, options, context);
  }
  if (choice.is_asked || options.model_driven) return false;
  if (!takes_out(choice.motion)) return note_whole_motion(choice, source, options, context);
  const HeadMotionTaken& motion = source.head_motion;
  if (motion.angle == 0 && motion.shift == 0) return false;
  context.note(options.name + ": a head motion of up to " + readable(motion.angle, 3) +
               " degrees and " + readable(motion.shift, 3) + " is taken out, as " +
               std::string(motion.why));
  return false;
}

/// Notes a neutral that probably belongs to another face. The difference between the faces would
/// count as deformation.
void note_other_face(const Source& source, const SourceOptions& options, const Context& context) {
  const RestBeyondFrames rest = rest_beyond_frames(source.sequence, context);
  if (rest.is_of_other_face()) {
    context.note(options.name + ": " + described(rest), Topic::other_rest);
  }
}

/// Notes frames that cannot be poses of the mesh. Regions would form around them, and targets would
/// follow.
void note_odd_frames(const FrameSource& sequence, const SourceOptions& options,
                     const Context& context) {
  const std::vector<FrameShape> shapes = frame_shapes(sequence, context);
  for (const std::string& text : described(odd_frames(sequence, shapes), shapes)) {
    context.note(options.name + ": " + text +
                 "; leave such frames out (option 'frames') or mend them");
  }
}

Shared kept(Shared sequence, const Context& context) {
  return stored(std::move(sequence), context.part(0, kStoringShare));
}

/// True for a given shape, and for the sequence's own neutral if no rest pose is asked for.
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

Positions asked_rest(const FrameSource& sequence, const SourceOptions& options) {
  if (!options.rest) return sequence.rest();
  if (const auto* given = std::get_if<Positions>(&*options.rest)) return *given;
  const bool is_first = std::get<SourceRest>(*options.rest) == SourceRest::first;
  return is_first ? Positions(FrameBlock(sequence, 0, 1).frame(0)) : sequence.rest();
}

Source prepare_source(Shared sequence, const SourceOptions& options, const JointSearch& joint,
                      const Context& context) {
  // The given sequence, not the one with the requested rest pose, decides whether the head moves.
  const MotionChoice choice = motion_of(*sequence, options);
  const auto* asked = std::get_if<HeadMotion>(&choice.motion);
  if (asked && *asked == HeadMotion::joint && !joint) {
    throw OptionError(Topic::no_joint_motion,
                      options.name + ": no target has expressions to find its head motion with");
  }
  Source source;
  source.given = kept(std::move(sequence), context);
  source.sequence = with_asked_rest(source.given, options, context);
  check_size_of_rest(*source.sequence, options.name);
  source.rest_is_given = options.rest.has_value();
  source.neutral_is_known = knows_neutral(*source.given, options);
  source.head_motion = {name_of(choice.motion), choice.reason};
  find_motion(source, choice, joint, context.part(kStoringShare, 1));
  measure_motion(source);
  const Context done = context.part(1, 1);
  if (!options.model_driven) note_odd_frames(*source.sequence, options, done);
  const bool is_elsewhere = note_motion(choice, source, options, done);
  note_uncertainty(choice, source, options, done);
  if (takes_out(choice.motion)) {
    source.sequence = without_motion(source.sequence, source.motion);
  }
  if (source.neutral_is_known && !options.model_driven && !is_elsewhere) {
    note_other_face(source, options, done);
  }
  source.moving = moving_vertices(source.motion.empty() ? *source.sequence : *source.given);
  if (is_mean(options)) source.sequence = with_rest(source.sequence, mean_pose(*source.sequence));
  return source;
}

Source prepare_source(const MeshSequence& sequence, const SourceOptions& options,
                      const JointSearch& joint, const Context& context) {
  return prepare_source(std::make_shared<const MeshSequence>(sequence), options, joint, context);
}

Shared with_head_motion(Shared result, std::vector<RigidTransform> motion) {
  return with_rest(with_motion(std::move(result), std::move(motion)), {});
}

std::vector<VertexIndex> moving_vertices(const FrameSource& sequence) {
  const std::vector<VertexIndex> surface = surface_vertices(sequence.rest(), sequence.triangles());
  const double least = kLeastMotion * sequence.diameter();
  std::vector<bool> moves(surface.size(), false);
  for (int f = 0; f < sequence.frames(); ++f) {
    const FrameBlock block(sequence, f, 1);
    const PositionsView pose = block.frame(0);
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const VertexIndex v = surface[i];
      if ((pose.row(v) - sequence.rest().row(v)).squaredNorm() > least * least) moves[i] = true;
    }
  }
  std::vector<VertexIndex> moving;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (moves[i]) moving.push_back(surface[i]);
  }
  return moving;
}

MovingParts moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                         const Triangles& triangles) {
  const double size = diameter_of_parts(rest, triangles, moving);
  MovingParts found{{}, size};
  if (moving.empty()) return found;
  const SurfaceParts parts = surface_parts(rest, triangles);
  if (size < diameter(rest, triangles)) {
    found.vertices.assign(static_cast<std::size_t>(rest.rows()), false);
    for (const VertexIndex v : vertices_of_parts(parts, moving)) found.vertices[v] = true;
  }
  const Subject subject = subject_around(rest, parts, moving);
  if (subject.is_section) {
    found.is_section = true;
    found.diameter = subject.growth() * diameter(rest(moving, Eigen::all));
  }
  return found;
}

MeshSequence spread_frames(const std::shared_ptr<const FrameSource>& sequence, int most,
                           const Context& context) {
  const int frames = sequence->frames();
  const int count = std::min(frames, most);
  std::vector<int> chosen(count);
  for (int i = 0; i < count; ++i) {
    chosen[i] = static_cast<int>(std::int64_t{i} * frames / count);
  }
  return MeshSequence(*with_rest(selected(sequence, std::move(chosen)), sequence->rest()),
                      context.without_ranks());
}

}  // namespace mimetra
