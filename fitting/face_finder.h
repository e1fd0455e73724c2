#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fitting/affine_camera.h"
#include "toolkit/mesh/option.h"
#include "toolkit/operations/image.h"

namespace mimetra {

/// A face that was found in an image.
struct Face {
  /// Its box in pixels.
  double left = 0, top = 0, width = 0, height = 0;
  /// In [0, 1): s / (1 + s) for the detector's score s, how far the face is above its threshold.
  double confidence = 0;
  /// iBUG's 68 landmarks (68 x 2), in whole pixels.
  ImagePoints landmarks;
};

/// The 68-point shape predictor of Debian's libdlib-data.
inline constexpr const char* kDebianFaceModel =
    "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";

struct FaceOptions {
  /// 68-point shape predictor; kDebianFaceModel by default.
  std::optional<std::filesystem::path> model = {};
  /// Faces of less confidence are taken for none.
  double min_confidence = 0.1;

  static constexpr Option kModel{"model", &FaceOptions::model};
  static constexpr Option kMinConfidence{
      "min_confidence", &FaceOptions::min_confidence, {.minimum = 0, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kMinConfidence); }
};

/// Finds faces and their landmarks by dlib's frontal face detector and a 68-point shape predictor.
///
/// The constructor reads the model; queries are const.
///
/// [Kazemi, Sullivan. One Millisecond Face Alignment with an Ensemble of Regression Trees. CVPR
/// 2014]
class FaceFinder {
 public:
  /// Throws IoError that says what is missing and which package has it: the model, or dlib where
  /// mimetra was built without it; and for a file that is no such model.
  explicit FaceFinder(const std::filesystem::path& model = kDebianFaceModel);
  ~FaceFinder();
  FaceFinder(FaceFinder&&) noexcept;
  FaceFinder& operator=(FaceFinder&&) noexcept;

  /// All faces that look towards the camera and are at least 80 pixels wide, best confidence first.
  std::vector<Face> faces(const Image& image) const;

  /// Those of them that are near faces found in the image before, in a tenth of the time: within
  /// half a face's width of one, and at most a sixth larger or smaller.
  std::vector<Face> faces_near(const Image& image, const std::vector<Face>& last) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// False where mimetra was built without dlib.
bool faces_can_be_found();

/// The faces of one frame.
struct FacesInImage {
  std::string image;  ///< its name
  std::vector<Face> faces;
};

}  // namespace mimetra
