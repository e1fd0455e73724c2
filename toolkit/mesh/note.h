#pragma once

#include <functional>
#include <string>

#include "toolkit/mesh/errors.h"

namespace mimetra {

/// What a note or an error is about. Who shows it may add how to help it in words of their own: the
/// command names its options.
enum class Topic {
  other,
  parting_vertices,    ///< vertices that are welded at rest do not stay together
  unknown_neutral,     ///< of the source
  turning_head,        ///< the source's head turns, and that was not taken out
  uncertain_motion,    ///< no vertex of the source is still enough to tell its head motion
  joint_motion,        ///< its head motion was found together with a target's expressions
  no_joint_motion,     ///< that was asked for, and there are no expressions
  other_rest,          ///< the rest pose is likely not that of the source's face
  unneutral_rest,      ///< the source's rest pose is likely not its neutral
  poor_condition,      ///< the regions hardly tell the target's expressions apart
  completed_regions,   ///< discs were added to the regions for a target's expressions
  completion_limit,    ///< as many as may be, and it was not enough
  undetermined_axes,   ///< the rest poses leave open how source and target are turned
  component_count,     ///< more than the mesh can have
  no_vertex_inside,    ///< where regions may lie
  triangle_bound,      ///< no region fits into the share of the triangles that was asked for
  discs_beyond_bound,  ///< what would complete regions does not fit into that share
  few_discs,           ///< all discs together hold less than that share
  no_selection,        ///< a target is solved for vertices, for which no region can be chosen
  small_parts,         ///< regions lie on small connected parts of the surface
  large_regions,       ///< a region holds more than half of the mesh
  support_range,       ///< d_min is not below d_max
  no_expressions,      ///< of the target, where weights are asked for
  no_pairs,            ///< of left and right among the target's expressions
  no_exclusives,       ///< among the target's expressions, of those that names tell
  anchor_vertex,       ///< one that the mesh does not have
  held_anchor,         ///< an anchor where fixed vertices hold the mesh
  anchor_and_weights,  ///< the same where they are those of weight 0
  soft_outside,        ///< Outside::identity where the regions' border is soft
  visible_crease,      ///< the surface bends at the regions' border as the source does not
  other_faces,         ///< a target has not the source's faces, and nothing pairs them
  shifted_markers,     ///< markers fit much better as vertices one lower or higher
  no_full_weight,      ///< no vertex takes all of the motion, from which a border could fade out
  poor_match           ///< source and target are hardly paired
};

/// What the user of a computation should know of it.
struct Note {
  Topic topic;
  std::string text;
};

/// Called with each note, from the thread that computes.
using Notes = std::function<void(const Note&)>;

/// An option that does not fit the data or another option.
class OptionError : public MismatchError {
 public:
  OptionError(Topic topic, const std::string& text);

  Topic topic() const { return topic_; }

 private:
  Topic topic_;
};

}  // namespace mimetra
