#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/image_files.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/operations/image.h"

namespace mimetra {

/// What was fitted to an image, in its pixels.
struct FittedView {
  /// The mesh's vertices as the camera sees them (N x 2): project().
  ImagePoints vertices;
  /// Landmarks that were found (n x 2); NaN for those not seen.
  ImagePoints landmarks;
  /// The mesh's vertex of each (n), or none: then the model's own are not drawn.
  std::vector<int> landmark_vertices;
};

/// Draws over the image the edges of triangles whose front is seen (cyan, a third of each pixel),
/// the landmarks that were found (yellow squares) and the model's own (magenta crosses), with a red
/// line between the two. What is outside the image is left out. `triangles` are counter-clockwise
/// where their front is seen. Throws std::invalid_argument where sizes disagree or a vertex is out
/// of range.
Image draw_fit(const Image& image, const Triangles& triangles, const FittedView& view);

/// The same for the part of the image around the mesh, its box and a tenth more on each side, at
/// another height (>= 1): lines stay thin in a larger picture, and a strip shows faces of one size.
/// Throws std::invalid_argument also where none of the mesh is inside the image.
Image draw_close_up(const Image& image, const Triangles& triangles, const FittedView& view,
                    int height);

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
