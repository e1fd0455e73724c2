#pragma once

#include <vector>

#include <Eigen/Core>

#include "fitting/affine_camera.h"

namespace mimetra {

/// The box around a face in an image.
struct FaceBox {
  Eigen::Array2d middle;  ///< x, y
  Eigen::Array2d size;    ///< width, height
};

/// Around points (n x 2); those that are NaN do not count. \pre some are not
FaceBox box_around(const ImagePoints& points);

/// The place of each face in each frame of a clip, by numbers from 0 on. A face whose middle is
/// within the width and height of where one was last seen, however long ago, is at its place: those
/// of the frame before come first, then the nearest, each once in a frame. A face that lies on
/// another one is at its place, too; others are at new ones.
std::vector<std::vector<int>> face_places(const std::vector<std::vector<FaceBox>>& frames);

/// Which of the faces in each frame of a clip is the person that is followed.
struct FollowedFace {
  std::vector<int> chosen;  ///< in each frame (F); -1 where the person is not seen
  /// Frames in which another face is taken for the person, which lay elsewhere, as after a cut.
  std::vector<int> jumps;
};

/// Follows one person. Where no frame has several faces, each one is the person's. Else the person
/// is the largest face of the first frame that has any, of equal ones the first, and what is at its
/// place (face_places()). Two faces in one frame are two people: where the person's face is
/// missing, the nearest one whose place is in no frame beside the person's is taken for it, as when
/// the picture is cut or the camera moves, and no other.
FollowedFace followed_face(const std::vector<std::vector<FaceBox>>& frames);

}  // namespace mimetra
