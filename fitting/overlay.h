#pragma once

#include <memory>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/image_files.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Fit of one image, in its pixels.
struct FittedView {
  /// Vertices of the mesh as seen by the camera (N x 2); see project().
  ImagePoints vertices;
  /// Landmarks that were found (n x 2); NaN if not seen.
  ImagePoints landmarks;
  /// Vertex of the mesh for each landmark (n). Empty to omit the model's landmarks.
  std::vector<int> landmark_vertices;
};

/// Draws a fit over the image and clips it to the image. Edges of front-facing triangles are cyan
/// (a third of each pixel). Found landmarks are yellow squares, the model's landmarks are magenta
/// crosses, and red lines connect the two. Front-facing triangles are counter-clockwise. Throws
/// std::invalid_argument if sizes disagree or a vertex is out of range.
Image draw_fit(const Image& image, const Triangles& triangles, const FittedView& view);

/// Draws the fit over the part of the image around the mesh: its box and a tenth more on each side,
/// scaled to `height` (>= 1). Lines stay thin, and all faces of a strip have one size. Throws as
/// draw_fit(), and std::invalid_argument if a vertex is not finite or the part shows fewer than 4 x
/// 4 pixels of the image.
Image draw_close_up(const Image& image, const Triangles& triangles, const FittedView& view,
                    int height);

/// Images of a clip with the fit drawn over them. Copies share their data.
class FitPictures {
 public:
  /// \pre There is one image and one camera for each frame of `sequence` and `mapped`.
  FitPictures(std::shared_ptr<const ImageSequence> images, MeshSequence sequence,
              const FittedCoefficients& fit, MappedLandmarks mapped);

  /// Whole image of a frame. Throws as ImageSequence::image.
  Image overlay(int frame) const;
  /// Close-ups of up to five of `frames`, evenly spread, side by side. Throws as
  /// ImageSequence::image, and MismatchError if a face is outside its image.
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
