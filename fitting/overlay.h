#pragma once

#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/image_files.h"
#include "toolkit/model/morphable_model.h"

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

}  // namespace mimetra
