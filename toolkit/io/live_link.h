#pragma once

#include <string>
#include <vector>

#include "toolkit/io/weight_track.h"

/// Weights as the app Live Link Face writes them: what programs read that know ARKit's faces.
namespace mimetra {

/// The names of ARKit's 52 blendshapes, EyeBlinkLeft to TongueOut, in the order of its columns.
const std::vector<std::string>& live_link_names();

/// True where the file would hold weights of one of these expressions: some are ARKit's, as
/// match_weights() finds them.
bool has_live_link_names(const std::vector<std::string>& expressions);

/// A file's text, and what it does not hold of the weights.
struct LiveLinkText {
  std::string text;
  std::vector<std::string> notes;
};

/// Timecode, BlendShapeCount (61), a column for each of ARKit's names, and nine of the rotations of
/// head and eyes, which are 0. Two expressions of one name, halves of the face, give their mean.
/// Timecodes count frames of the weights' rate in thousandths; without times there are 30 a second.
/// Notes expressions that are not ARKit's, means, a start that is not 0, and times that
/// read_weights() would not find again.
///
/// Throws MismatchError where no expression is ARKit's, or timecodes cannot tell frames apart.
LiveLinkText live_link_csv(const WeightTrack& track);

}  // namespace mimetra
