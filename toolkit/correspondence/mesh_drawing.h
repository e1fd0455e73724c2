#pragma once

#include <vector>

#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Direction and light of an orthographic view of a mesh.
struct MeshView {
  /// Rotation in the mesh's axes. Rows: right and up in the drawing, and the direction towards the
  /// viewer.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Point in the drawing's middle.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  /// Side of the drawn square, in the mesh's unit.
  double side = 1;
  /// Side of the drawn square, in pixels.
  int pixels = 1;
  /// Samples per row and per column of a pixel. The number is odd, so that one sample is in the
  /// middle.
  int samples = 3;
  /// Direction towards the light, in the drawing's right, up and towards the viewer.
  Eigen::Vector3d light = Eigen::Vector3d::UnitZ();
};

/// Point of the mesh at the middle of a pixel.
struct SeenPlace {
  int triangle = -1;  ///< -1 if the pixel shows the background
  /// Barycentric coordinates in the triangle.
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();
};

struct MeshDrawing {
  GreyImage image;
  std::vector<SeenPlace> places;  ///< of each pixel, in the order of the image
};

/// Draws a mesh with a depth buffer, smooth normals, one light and softened edges. The inside of
/// the mesh is dark. Queries are const and may run from several threads.
///
/// Most normals define the outside, so that a mesh whose triangles all face inwards looks the same.
/// The order of triangles does not change the image.
class MeshPainter {
 public:
  /// Coinciding vertices are welded. Throws std::invalid_argument if a vertex is not finite.
  explicit MeshPainter(const TriMesh& mesh);

  /// Throws std::invalid_argument if the view has no size, not 1 to 4096 pixels, or an even number
  /// of samples.
  MeshDrawing draw(const MeshView& view) const;

  /// Point of the mesh at a place with a triangle.
  Eigen::Vector3d position(const SeenPlace& place) const;
  /// Returns true if the view shows the triangle's outside.
  bool shows_outside(int triangle, const MeshView& view) const;

 private:
  Positions positions_;
  Triangles triangles_;
  Positions normals_;  ///< of vertices, outwards
  bool inside_out_ = false;
};

}  // namespace mimetra
