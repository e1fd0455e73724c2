#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/landmark_mapping.h"
#include "fitting/overlay.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/operations/image_sequence.h"

/// What the operation `fit` draws. Internal to fit_operation.h.
namespace mimetra {

/// The images of a clip with what was fitted to them; copies share their data.
class FitPictures {
 public:
  /// \pre one image and one camera for each frame of `sequence` and `mapped`
  FitPictures(std::shared_ptr<const ImageSequence> images, MeshSequence sequence,
              const FittedCoefficients& fit, MappedLandmarks mapped);

  /// A frame's whole image. Throws as ImageSequence::image.
  Image overlay(int frame) const;
  /// The faces of up to five of `frames`, evenly spread, side by side. Throws as
  /// ImageSequence::image; MismatchError for a face outside its image.
  Image strip(const std::vector<int>& frames) const;

 private:
  struct Clip {
    std::shared_ptr<const ImageSequence> images;
    MeshSequence sequence;
    std::vector<AffineCamera> cameras;
    Eigen::Matrix<double, Eigen::Dynamic, 4> depths;
    MappedLandmarks mapped;
    Triangles triangles;
  };

  Image image(int frame) const;
  FittedView view(int frame) const;

  std::shared_ptr<const Clip> clip_;
};

}  // namespace mimetra
