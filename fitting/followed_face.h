#pragma once

#include <vector>

#include <Eigen/Core>

#include "fitting/affine_camera.h"

namespace mimetra {

/// Box around a face in an image.
struct FaceBox {
  Eigen::Array2d middle;  ///< x, y
  Eigen::Array2d size;    ///< width, height
};

/// Box around points (n x 2), ignoring points with NaN. \pre at least one point is finite
FaceBox box_around(const ImagePoints& points);

/// Place of each face in each frame, numbered from 0. A face belongs to a known place if its middle
/// is within one face size of the last face there, however long ago. Places of the previous frame
/// win over others, then the nearest wins; a frame uses each place once. A face on top of another
/// one shares its place. All other faces get new places.
std::vector<std::vector<int>> face_places(const std::vector<std::vector<FaceBox>>& frames);

/// Index of the followed person's face in each frame of a clip.
struct FollowedFace {
  std::vector<int> chosen;  ///< in each frame (F); -1 if the person is not seen
  /// Frames in which a face at another place is chosen as the person's, as after a cut.
  std::vector<int> jumps;
};

/// Follows one person. If no frame has several faces, every face is the person's. Otherwise the
/// person is the largest face (the first of equals) in the first frame with a face, and every face
/// at its place (face_places()). If that face is missing in a frame, the nearest other face is
/// chosen, as after a cut. It must be at a place that never occurs in one frame with the person,
/// since two faces in one frame are two people.
FollowedFace followed_face(const std::vector<std::vector<FaceBox>>& frames);

}  // namespace mimetra
