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

/// Undeformed shape from which a source's deformation is measured.
enum class SourceRest { neutral, first, mean };

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

/// How the head's motion is found; `none` looks for no motion.
enum class HeadMotion {
  stable,  ///< on the vertices that move least
  all,     ///< on all vertices
  joint,   ///< together with a target's expressions
  none
};

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

/// Errors of two head motions, with the expressions that they leave, on vertices held out of the
/// fit. Root mean square over vertices and frames, as a share of the diameter.
struct HeldOutErrors {
  double stable = 0;
  double joint = 0;
};

/// Head motion (F) that was found together with a target's expressions.
struct JointMotion {
  std::vector<RigidTransform> motion;
  /// Empty if no part of the mesh can be held out.
  std::optional<HeldOutErrors> held_out = {};
};

struct Source;

/// Finds the joint motion of a source with head motion in its frames. The source's `motion` is the
/// result of HeadMotion::stable.
using JointSearch = std::function<JointMotion(const Source&, const Context&)>;

struct SourceOptions {
  /// Name in notes and errors.
  std::string name = "the source";
  /// Rest pose to use, or the shape itself (N x 3). Default: the neutral if it is known, otherwise
  /// the first frame, with a note.
  std::optional<std::variant<SourceRest, Positions>> rest = {};
  /// How the head motion is found, or the motion itself (F): head_motion[f] carries frame f without
  /// head motion to frame f. Default: none for one frame, for a sequence that a model drives, and
  /// if the neutral is known from the sequence or given as `rest`. Otherwise stable.
  std::optional<std::variant<HeadMotion, std::vector<RigidTransform>>> head_motion = {};
  /// A model drives the sequence, which then has no head motion of its own.
  bool model_driven = false;

  static constexpr Option kRest{"rest", &SourceOptions::rest};
  static constexpr Option kHeadMotion{"head_motion", &SourceOptions::head_motion};
};

/// How a source's head motion was found and how large it is.
struct HeadMotionTaken {
  /// "stable", "all", "joint", "none", or "given".
  std::string_view how = choice_name(HeadMotion::none);
  /// Reason, such as "the neutral is known".
  std::string_view why = {};
  /// Largest rotation in degrees, and largest shift of the rest pose's centre, over all frames.
  double angle = 0;
  double shift = 0;
  /// Set if the stable motion was looked for. `stillest` is the largest move of the stillest
  /// twentieth of the vertices, as a share of the diameter. `disagreement` is the angle in degrees
  /// between the motions of halves of these vertices (StableMotion).
  std::optional<double> stillest = {};
  std::optional<double> disagreement = {};
  /// Set if the joint motion was looked for.
  std::optional<HeldOutErrors> held_out = {};

  /// True if no vertex is still enough to determine the motion.
  bool is_uncertain() const { return disagreement && *disagreement > kUncertainDisagreement; }
};

/// A sequence and its head motion, ready for analysis and transfer.
struct Source {
  /// The original sequence, stored() if reading it again is slow.
  std::shared_ptr<const FrameSource> given;
  /// The frames without head motion, with the requested rest pose.
  std::shared_ptr<const FrameSource> sequence;
  /// Head motion (F); empty if none was looked for.
  std::vector<RigidTransform> motion;
  /// moving_vertices() of `sequence`, or of `given` if head motion was taken out. A still body
  /// moves against a head that is held.
  std::vector<VertexIndex> moving = {};
  HeadMotionTaken head_motion = {};
  /// True if the options set the rest pose.
  bool rest_is_given = false;
  /// True if the rest pose is known to be the neutral.
  bool neutral_is_known = false;
};

/// Returns the requested rest pose, without aligning frames: the sequence's own rest pose replaces
/// the mean.
Positions asked_rest(const FrameSource& sequence, const SourceOptions& options);

/// Returns the sequence without head motion and with the requested rest pose. The mean is the mean
/// of the aligned frames.
///
/// Notes:
/// - a first frame that replaces an unknown neutral (Topic::unknown_neutral)
/// - head motion that is taken out by default
/// - a head that turns although no motion is taken out (Topic::turning_head)
/// - a head without a vertex that is still enough to determine its motion (Topic::uncertain_motion)
/// - frames that cannot be poses of the mesh
/// - a joint motion that is used by default (Topic::joint_motion)
/// - a neutral that probably belongs to another face (Topic::other_rest)
///
/// `joint` finds the motion for HeadMotion::joint. It is also called if the options set no head
/// motion and no vertex is still enough. The joint motion is then used if its error on held-out
/// vertices is less than half the stable motion's.
///
/// Throws OptionError (Topic::unknown_neutral) if the neutral is requested and not known, and
/// (Topic::no_joint_motion) for HeadMotion::joint if `joint` is empty. Throws std::invalid_argument
/// for a rest pose of another number of vertices. Throws MismatchError for a rest pose in another
/// unit than the frames, and for a given motion of another number of frames. Throws OutputError if
/// frames cannot be stored(), what reading throws, and Cancelled.
Source prepare_source(std::shared_ptr<const FrameSource> sequence,
                      const SourceOptions& options = {}, const JointSearch& joint = {},
                      const Context& context = {});
Source prepare_source(const MeshSequence& sequence, const SourceOptions& options = {},
                      const JointSearch& joint = {}, const Context& context = {});

/// Gives the head motion (F) back to a result's frames. The rest pose is then unknown, because the
/// neutral has no head motion; the first frame replaces it. Throws MismatchError for another number
/// of frames.
std::shared_ptr<const FrameSource> with_head_motion(std::shared_ptr<const FrameSource> result,
                                                    std::vector<RigidTransform> motion);

/// Vertices that move farther than kLeastMotion of the diameter from the rest pose in some frame,
/// ascending. Only vertices of triangles with area count. Reads every frame. Throws what reading
/// throws.
std::vector<VertexIndex> moving_vertices(const FrameSource& sequence);

/// The connected parts of a surface that contain moving vertices. Relative lengths on a sequence,
/// such as the radius of regions, are shares of their size. A still body or clothes beside a face
/// do not count.
struct MovingParts {
  /// True for vertices of these parts (N). Empty for all, also if the other parts do not extend the
  /// diameter.
  std::vector<bool> vertices = {};
  /// Largest distance between two of the vertices.
  double diameter = 0;
  /// True if the moving vertices span less than a third of these parts, as on a head and body in
  /// one piece. The diameter is then 1.5 times the moving vertices' diameter.
  bool is_section = false;
};

/// Returns the parts with vertices `moving`, on `rest` (N x 3) and `triangles`; all parts if
/// nothing moves.
MovingParts moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                         const Triangles& triangles);

/// Reads at most `most` frames into memory, evenly spread over the sequence, with its rest pose.
MeshSequence spread_frames(const std::shared_ptr<const FrameSource>& sequence, int most,
                           const Context& context = {});

}  // namespace mimetra
