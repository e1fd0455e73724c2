#include "toolkit/pipeline/source.h"

#include "toolkit/mesh/frame_store.h"

namespace mimetra {

namespace {

using Motion = std::variant<HeadMotion, std::vector<RigidTransform>>;
using Shared = std::shared_ptr<const FrameSource>;

/// Keeping the frames of a source that is slow to read, as a part of its progress.
constexpr double kStoringShare = 0.3;

Motion motion_of(const FrameSource& sequence, const SourceOptions& options) {
  if (options.head_motion) return *options.head_motion;
  const bool still = options.model_driven || sequence.rest_is_known() || sequence.frames() == 1;
  return still ? HeadMotion::none : HeadMotion::stable;
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
  return with_rest(sequence, mean_pose(*sequence));
}

/// `sequence` are the frames of `given` with the rest pose that counts.
Source made_of(Shared given, Shared sequence, const Motion& motion, const SourceOptions& options) {
  Source source{std::move(given), std::move(sequence), {}};
  source.motion = motion_in(
      *source.sequence, motion,
      {.threads = options.threads, .progress = part_of(options.progress, kStoringShare, 1)});
  if (takes_out(motion)) source.sequence = without_motion(source.sequence, source.motion);
  return source;
}

Shared kept(Shared sequence, const SourceOptions& options) {
  return stored(std::move(sequence), {.threads = options.threads,
                                      .progress = part_of(options.progress, 0, kStoringShare)});
}

}  // namespace

bool takes_out_motion(const FrameSource& sequence, const SourceOptions& options) {
  return takes_out(motion_of(sequence, options));
}

Source without_head_motion(Shared sequence, const SourceOptions& options) {
  const Motion motion = motion_of(*sequence, options);
  const Shared given = kept(std::move(sequence), options);
  return made_of(given, given, motion, options);
}

Source without_head_motion(const MeshSequence& sequence, const SourceOptions& options) {
  return without_head_motion(std::make_shared<const MeshSequence>(sequence), options);
}

Source prepare_source(Shared sequence, const SourceOptions& options) {
  // Whether the head moves is judged by what is known of the sequence itself.
  const Motion motion = motion_of(*sequence, options);
  const Shared given = kept(std::move(sequence), options);
  return made_of(given, with_asked_rest(given, options), motion, options);
}

Source prepare_source(const MeshSequence& sequence, const SourceOptions& options) {
  return prepare_source(std::make_shared<const MeshSequence>(sequence), options);
}

Shared with_head_motion(Shared result, std::vector<RigidTransform> motion) {
  return with_rest(with_motion(std::move(result), std::move(motion)), {});
}

}  // namespace mimetra
