#include "toolkit/pipeline/source.h"

namespace mimetra {

namespace {

using Motion = std::variant<HeadMotion, std::vector<RigidTransform>>;

Motion motion_of(const MeshSequence& sequence, const SourceOptions& options) {
  if (options.head_motion) return *options.head_motion;
  const bool still = options.model_driven || sequence.rest_is_known() || sequence.frames() == 1;
  return still ? HeadMotion::none : HeadMotion::stable;
}

Alignment aligned(const MeshSequence& sequence, const Motion& motion) {
  if (const auto* given = std::get_if<std::vector<RigidTransform>>(&motion)) {
    return align(sequence, *given);
  }
  switch (std::get<HeadMotion>(motion)) {
    case HeadMotion::stable:
      return align(sequence, {.vertices = AlignmentVertices::stable});
    case HeadMotion::all:
      return align(sequence, {.vertices = AlignmentVertices::all});
    case HeadMotion::none:
      break;
  }
  return {sequence, {}};
}

MeshSequence with_asked_rest(const MeshSequence& sequence, const SourceOptions& options) {
  if (!options.rest) {
    if (!sequence.rest_is_known()) {
      note(options.notes,
           options.name + ": its neutral is not known, the first frame stands in for it",
           Topic::unknown_neutral);
    }
    return sequence;
  }
  if (const auto* given = std::get_if<Positions>(&*options.rest)) return sequence.with_rest(*given);
  switch (std::get<SourceRest>(*options.rest)) {
    case SourceRest::neutral:
      if (sequence.rest_is_known()) return sequence;
      throw OptionError(Topic::unknown_neutral, options.name + ": its neutral is not known");
    case SourceRest::first:
      return sequence.with_rest(sequence.frame(0));
    case SourceRest::mean:
      break;
  }
  return sequence.with_rest(mean_pose(sequence));
}

Source made_of(const MeshSequence& given, Alignment alignment) {
  return {given, std::move(alignment.sequence), std::move(alignment.motion)};
}

}  // namespace

bool takes_out_motion(const MeshSequence& sequence, const SourceOptions& options) {
  const Motion motion = motion_of(sequence, options);
  const auto* fitted = std::get_if<HeadMotion>(&motion);
  return !fitted || *fitted != HeadMotion::none;
}

Source without_head_motion(const MeshSequence& sequence, const SourceOptions& options) {
  return made_of(sequence, aligned(sequence, motion_of(sequence, options)));
}

Source prepare_source(const MeshSequence& sequence, const SourceOptions& options) {
  // Whether the head moves is judged by what is known of the sequence itself.
  const Motion motion = motion_of(sequence, options);
  return made_of(sequence, aligned(with_asked_rest(sequence, options), motion));
}

MeshSequence with_head_motion(const MeshSequence& result,
                              const std::vector<RigidTransform>& motion) {
  const MeshSequence moved = with_motion(result, motion);
  return {moved.shared_connectivity(), moved.positions(), moved.times()};
}

}  // namespace mimetra
