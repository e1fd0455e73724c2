#pragma once

#include <functional>
#include <string>

#include "toolkit/mesh/errors.h"

namespace mimetra {

/// Subject of a note or an error. A front end may append advice in its own terms, as the command
/// does with its options.
enum class Topic {
  other,
  parting_vertices,    ///< vertices that are welded at rest do not stay together
  unknown_neutral,     ///< the source's neutral pose is unknown
  turning_head,        ///< the source's head turns, and the motion was not removed
  uncertain_motion,    ///< no vertex of the source is still enough to give its head motion
  joint_motion,        ///< the head motion was estimated together with a target's expressions
  no_joint_motion,     ///< a joint estimate was requested, but there are no expressions
  other_rest,          ///< the rest pose is probably another face's
  unneutral_rest,      ///< the source's rest pose is probably not its neutral
  poor_condition,      ///< the regions hardly distinguish the target's expressions
  completed_regions,   ///< discs were added to the regions for a target's expressions
  completion_limit,    ///< added discs reached their limit, and expressions are still hardly seen
  undetermined_axes,   ///< the rest poses do not determine a rotation between source and target
  component_count,     ///< more components than the mesh has vertices
  no_vertex_inside,    ///< no vertex is left where regions are allowed
  triangle_bound,      ///< no region fits into the requested share of the triangles
  discs_beyond_bound,  ///< the discs that would complete the regions exceed that share
  few_discs,           ///< all discs together hold less than that share
  no_selection,        ///< regions cannot be chosen for a target that is solved for vertices
  small_parts,         ///< regions are on small connected parts of the surface
  large_regions,       ///< a region holds more than half of the mesh
  support_range,       ///< d_min is not below d_max
  no_expressions,      ///< weights are requested, but the target has no expressions
  no_pairs,            ///< no expressions of the target are named as left and right
  no_exclusives,       ///< no expressions of the target have names known to exclude each other
  anchor_vertex,       ///< the mesh does not have the anchor vertex
  held_anchor,         ///< an anchor is given, but fixed vertices hold the mesh already
  anchor_and_weights,  ///< an anchor is given, but vertices of weight 0 are fixed already
  soft_outside,        ///< Outside::identity is combined with a soft border of the regions
  visible_crease,      ///< the surface bends at the regions' border, unlike the source
  other_faces,         ///< a target has other faces than the source, and no correspondence
  shifted_markers,     ///< markers fit much better if their vertex numbers are shifted by one
  no_full_weight,      ///< no vertex takes the full motion, so a border has no start to fade from
  poor_match           ///< the correspondence of source and target is poor
};

/// Information about a computation for its user.
struct Note {
  Topic topic;
  std::string text;
};

/// Receives each note, on the computing thread.
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
