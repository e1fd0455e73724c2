#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// The undeformed shape that a source's deformation is measured from.
enum class SourceRest { neutral, first, mean };

/// As people choose it.
constexpr std::string_view choice_name(SourceRest value) {
  switch (value) {
    case SourceRest::neutral:
      return "neutral";
    case SourceRest::first:
      return "first";
    case SourceRest::mean:
      return "mean";
  }
  return {};
}

/// What the head's motion is found on; `none` looks for none.
enum class HeadMotion {
  stable,  ///< the vertices that move least
  all,     ///< all vertices
  joint,   ///< found together with a target's expressions
  none
};

/// As people choose it.
constexpr std::string_view choice_name(HeadMotion value) {
  switch (value) {
    case HeadMotion::stable:
      return "stable";
    case HeadMotion::all:
      return "all";
    case HeadMotion::joint:
      return "joint";
    case HeadMotion::none:
      return "none";
  }
  return {};
}

/// How far a motion, with the expressions that it leaves, is from vertices that were held out of
/// its fit: root mean square over vertices and frames, as a share of the diameter.
struct HeldOutErrors {
  double stable = 0;
  double joint = 0;
};

/// A head motion that was found together with a target's expressions (F).
struct JointMotion {
  std::vector<RigidTransform> motion;
  /// None where no part of the mesh can be held out.
  std::optional<HeldOutErrors> held_out = {};
};

struct Source;

/// Finds the joint motion of a source whose frames still have their head motion. The source's
/// `motion` is the one that HeadMotion::stable found.
using JointSearch = std::function<JointMotion(const Source&, const Context&)>;

struct SourceOptions {
  /// In notes and errors.
  std::string name = "the source";
  /// Or the shape itself (N x 3). By default the neutral where it is known, otherwise the first
  /// frame, with a note.
  std::optional<std::variant<SourceRest, Positions>> rest = {};
  /// Or the motion itself: head_motion[f] carries frame f without it to frame f (F). By default
  /// none for one frame, and where the neutral is known, as the sequence's own or as `rest`, or a
  /// model drives the source; otherwise stable.
  std::optional<std::variant<HeadMotion, std::vector<RigidTransform>>> head_motion = {};
  /// A model drives the sequence, which then has no head motion of its own.
  bool model_driven = false;

  static constexpr Option kRest{"rest", &SourceOptions::rest};
  static constexpr Option kHeadMotion{"head_motion", &SourceOptions::head_motion};
};

/// What was done about a source's head motion.
struct HeadMotionTaken {
  /// "stable", "all", "joint", "none", or "given".
  std::string_view how = choice_name(HeadMotion::none);
  /// "the neutral is known", say.
  std::string_view why = {};
  /// The largest of all frames; degrees, and how far the rest pose's centre goes.
  double angle = 0;
  double shift = 0;
  /// Where stable was looked for: how far one vertex in twenty moves at most, as a share of the
  /// diameter, and by how many degrees halves of the stillest vertices disagree (StableMotion).
  std::optional<double> stillest = {};
  std::optional<double> disagreement = {};
  /// Where the joint motion was looked for.
  std::optional<HeldOutErrors> held_out = {};

  /// No vertex is still enough to tell the motion.
  bool is_uncertain() const { return disagreement && *disagreement > kUncertainDisagreement; }
};

/// A sequence whose deformation is looked at.
struct Source {
  /// As it came; stored() where reading it again is slow.
  std::shared_ptr<const FrameSource> given;
  /// Without its head motion; the rest pose is the one that was asked for.
  std::shared_ptr<const FrameSource> sequence;
  /// Of the head (F); empty where none was looked for.
  std::vector<RigidTransform> motion;
  /// moving_vertices() of the sequence, or, where head motion was taken out, as it came: a body
  /// that keeps still moves against a head that is held.
  std::vector<VertexIndex> moving = {};
  HeadMotionTaken head_motion = {};
  /// The rest pose was asked for.
  bool rest_is_given = false;
  /// The rest pose is the neutral, as whoever gave or kept it knows.
  bool neutral_is_known = false;
};

/// The rest pose that these options ask for, as far as frames do not have to be aligned for it: the
/// sequence's own stands in for the mean.
Positions asked_rest(const FrameSource& sequence, const SourceOptions& options);

/// The sequence with the rest pose that was asked for, to which its frames are aligned; the mean is
/// that of the aligned frames. Notes a first frame that stands in for the neutral
/// (Topic::unknown_neutral), a motion that nobody asked to take out, a head that turns although
/// none was (Topic::turning_head), one whose motion no vertex is still enough to tell
/// (Topic::uncertain_motion), frames that can be no poses of the mesh, a joint motion that nobody
/// asked for (Topic::joint_motion), and a neutral that is likely another face's
/// (Topic::other_rest).
///
/// `joint` finds the motion for HeadMotion::joint. It is also used if the options name no head
/// motion and no vertex is still enough: the joint motion is then taken if it predicts vertices
/// that were held out twice as well as the stable one.
///
/// Throws OptionError (Topic::unknown_neutral) where the neutral is asked for and not known, and
/// (Topic::no_joint_motion) where HeadMotion::joint is and `joint` is empty,
/// std::invalid_argument for a rest pose of another number of vertices, MismatchError where a given
/// motion has another number of frames, what reading throws, OutputError where frames cannot be
/// stored(), Cancelled.
Source prepare_source(std::shared_ptr<const FrameSource> sequence,
                      const SourceOptions& options = {}, const JointSearch& joint = {},
                      const Context& context = {});
Source prepare_source(const MeshSequence& sequence, const SourceOptions& options = {},
                      const JointSearch& joint = {}, const Context& context = {});

/// A result with the head motion (F) given back to its frames. Its neutral, which has none, is not
/// its rest pose any more. Throws MismatchError.
std::shared_ptr<const FrameSource> with_head_motion(std::shared_ptr<const FrameSource> result,
                                                    std::vector<RigidTransform> motion);

/// Vertices of triangles with area that are farther than kLeastMotion of the diameter from the rest
/// pose in some frame, ascending. Reads every frame. Throws what reading throws.
std::vector<VertexIndex> moving_vertices(const FrameSource& sequence);

/// The connected parts of a surface in which something moves. Lengths on a sequence, such as the
/// radius of regions, are shares of their size: a body or clothes that keep still beside a face do
/// not count.
struct MovingParts {
  /// True for vertices of these parts (N); empty for all, also where the other parts lie within
  /// these.
  std::vector<bool> vertices = {};
  /// Largest distance between two of them.
  double diameter = 0;
  /// True where what moves spans less than a third of these parts, as on a head and body in one
  /// piece. The diameter is then 1.5 times that of the vertices that move.
  bool is_section = false;
};

/// Of the vertices `moving`, on `rest` (N x 3) and `triangles`; all parts where none moves.
MovingParts moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                         const Triangles& triangles);

/// At most `most` frames in memory, evenly spread over the sequence, with its rest pose.
MeshSequence spread_frames(const std::shared_ptr<const FrameSource>& sequence, int most,
                           const Context& context = {});

}  // namespace mimetra
