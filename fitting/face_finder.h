#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fitting/affine_camera.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// Face found in an image.
struct Face {
  /// Bounding box in pixels.
  double left = 0, top = 0, width = 0, height = 0;
  /// Confidence in [0, 1): s / (1 + s) for the detector's score s above its threshold.
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
  /// Lowest confidence, in [0, 1]; faces below it are ignored.
  double min_confidence = 0.1;

  static constexpr Option kModel{"model", &FaceOptions::model};
  static constexpr Option kMinConfidence{
      "min_confidence", &FaceOptions::min_confidence, {.minimum = 0, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kMinConfidence); }
};

/// Finds faces with dlib's frontal face detector and their landmarks with a 68-point shape
/// predictor. The constructor reads the model. Queries are const.
///
/// [Kazemi, Sullivan. One Millisecond Face Alignment with an Ensemble of Regression Trees. CVPR
/// 2014]
class FaceFinder {
 public:
  /// Throws IoError if the model is missing, is not a shape predictor, or if mimetra was built
  /// without dlib. The message names the package to install.
  explicit FaceFinder(const std::filesystem::path& model = kDebianFaceModel);
  ~FaceFinder();
  FaceFinder(FaceFinder&&) noexcept;
  FaceFinder& operator=(FaceFinder&&) noexcept;

  /// Finds faces that look towards the camera and are at least 80 pixels wide, most confident
  /// first.
  std::vector<Face> faces(const Image& image) const;

  /// Finds faces near `last`, the faces of the previous image, in a tenth of the time of faces(). A
  /// face may move by half its width and grow or shrink by one pyramid step (6/5).
  std::vector<Face> faces_near(const Image& image, const std::vector<Face>& last) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns false if mimetra was built without dlib.
bool faces_can_be_found();

/// Throws IoError that begins with `name` and names the missing packages, if mimetra was built
/// without dlib.
void require_dlib(const std::string& name);

/// Faces of one frame.
struct FacesInImage {
  std::string image;  ///< name of the image
  std::vector<Face> faces;
};

}  // namespace mimetra
