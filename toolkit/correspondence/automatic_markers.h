#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/correspondence/markers.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Markers that no hand has placed, and how far they can be relied on.
struct AutomaticMarkers {
  std::vector<Marker> markers;
  std::vector<int> landmarks;  ///< of iBUG's (0 to 67), one for each marker
  FaceLandmarks source, target;
  /// What an affine map leaves of the markers, as affine_residual(): of two people's faces about
  /// 0.1, of landmarks at wrong places more.
  double affine_residual = 0;
  /// Those that are not where the others say (doubtful_markers()), in words.
  std::vector<std::string> doubtful = {};

  /// For people: how many there are, and for each head how many landmarks were found and how well
  /// the views agree.
  std::vector<std::string> summary(const std::string& source_name,
                                   const std::string& target_name) const;
  /// What makes them doubtful.
  std::vector<std::string> warnings() const;
};

/// "right eye (landmark 37)", for 36.
std::string landmark_name(int landmark);

/// Looks for markers between one head and others; its own face is looked for once.
class MarkerSearch {
 public:
  /// Keeps the finder; an empty one finds nothing.
  MarkerSearch(Head source, LandmarkFinder finder, const FaceSearchOptions& options = {});

  /// Pairs the landmarks that find_landmarks() gives for both heads. Landmarks that are known of
  /// one head only do not count: a finder errs alike on both, and other hands put brows elsewhere.
  /// A vertex of the target lies beside its landmark as the source's does beside its own.
  ///
  /// Throws what find_landmarks() throws, and MismatchError where the landmarks of both are too few
  /// for markers, or lie in one plane.
  AutomaticMarkers operator()(const Head& target, const Context& context = {});

 private:
  Head source_;
  LandmarkFinder finder_;
  FaceSearchOptions options_;
  std::optional<FaceLandmarks> found_;  // of the source
};

/// A search for one target.
AutomaticMarkers automatic_markers(const Head& source, const Head& target,
                                   const LandmarkFinder& finder,
                                   const FaceSearchOptions& options = {},
                                   const Context& context = {});

}  // namespace mimetra
