#pragma once

#include <vector>

#include <mimetra/fitting/affine_camera.h>
#include <mimetra/fitting/image.h>
#include <mimetra/model/morphable_model.h>

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

/// Draws over the image the edges of triangles whose front is seen (cyan, half transparent), the
/// landmarks that were found (yellow squares) and the model's own (magenta crosses), with a red
/// line between the two. What is outside the image is left out. `triangles` are counter-clockwise
/// where their front is seen. Throws std::invalid_argument where sizes disagree or a vertex is out
/// of range.
Image draw_fit(const Image& image, const Triangles& triangles, const FittedView& view);

/// The part of an image around what was drawn: the box of the vertices, a tenth larger on each
/// side. Throws std::invalid_argument where none of it is inside the image.
Image cropped_to(const Image& image, const ImagePoints& vertices);

}  // namespace mimetra
