#pragma once

#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"

/// Weights in the format of the app Live Link Face, for programs that support ARKit's faces.
namespace mimetra {

/// Names of ARKit's 52 blendshapes, EyeBlinkLeft to TongueOut, in the order of the app's columns.
const std::vector<std::string>& live_link_names();

/// True if the file would contain weights of one of these expressions: match_weights() finds some
/// of ARKit's names.
bool has_live_link_names(const std::vector<std::string>& expressions);

/// Text of a file, and notes on weights and times that it does not store exactly.
struct LiveLinkText {
  std::string text;
  std::vector<std::string> notes;
};

/// Converts weights to a table: Timecode, BlendShapeCount (61), a column for each of ARKit's names,
/// and nine columns of head and eye rotations. The rotations are 0. If several expressions, such as
/// halves of the face, match one name, the column is their mean.
///
/// Timecodes count thousandths of frames at the weights' rate, or 30 frames a second without times.
/// Notes report expressions that are not ARKit's, means, a start that is not 0, and times that
/// read_weights() would not restore.
///
/// Throws MismatchError if no expression is ARKit's, or two frames have the same timecode.
LiveLinkText live_link_csv(const WeightTrack& track);

}  // namespace mimetra
