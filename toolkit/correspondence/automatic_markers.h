#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/correspondence/markers.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Markers that were found automatically, with figures on their reliability.
struct AutomaticMarkers {
  std::vector<Marker> markers;
  std::vector<int> landmarks;  ///< iBUG number (0 to 67) of each marker
  FaceLandmarks source, target;
  /// affine_residual() of the markers. It is about 0.1 between the faces of two people, and larger
  /// if landmarks are misplaced.
  double affine_residual = 0;
  /// Descriptions of doubtful_markers().
  std::vector<std::string> doubtful = {};

  /// Lines for users: the number of markers and, for each head, the number of landmarks and the
  /// agreement of the views.
  std::vector<std::string> summary(const std::string& source_name,
                                   const std::string& target_name) const;
  /// Reasons to doubt the markers; empty if there are none.
  std::vector<std::string> warnings() const;
};

/// Name such as "right eye (landmark 37)", for 36.
std::string landmark_name(int landmark);

/// Searches for markers between one head and others. The first head's own face is searched for
/// once.
class MarkerSearch {
 public:
  /// An empty finder suffices if the landmarks of both heads are known.
  MarkerSearch(Head source, LandmarkFinder finder, const FaceSearchOptions& options = {});

  /// Pairs the landmarks that find_landmarks() gives for both heads. Known landmarks count only if
  /// both heads have some. Otherwise both heads are searched, because a finder errs alike on both,
  /// while people place brows elsewhere. The target's vertex of a searched landmark is offset from
  /// it as the source's vertex is from the source's landmark.
  ///
  /// Throws what find_landmarks() throws. Throws MismatchError if too few landmarks are common to
  /// both heads, or if they are coplanar.
  AutomaticMarkers operator()(const Head& target, const Context& context = {});

 private:
  Head source_;
  LandmarkFinder finder_;
  FaceSearchOptions options_;
  std::optional<FaceLandmarks> found_;  // landmarks of the source
};

/// Searches for the markers of one target.
AutomaticMarkers automatic_markers(const Head& source, const Head& target,
                                   const LandmarkFinder& finder,
                                   const FaceSearchOptions& options = {},
                                   const Context& context = {});

}  // namespace mimetra
