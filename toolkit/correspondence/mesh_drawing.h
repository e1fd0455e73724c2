#pragma once

#include <vector>

#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// From where and in which light a mesh is looked at, without perspective.
struct MeshView {
  /// Rows: the drawing's right, its up, and towards the viewer; a rotation, in the mesh's axes.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// The point in the drawing's middle.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  /// Of the square that is drawn, in the mesh's unit.
  double side = 1;
  /// The same in pixels.
  int pixels = 1;
  /// Of a pixel, along a row and along a column; odd, so that one is in its middle.
  int samples = 3;
  /// Towards the light, in the drawing's right, up and towards the viewer.
  Eigen::Vector3d light = Eigen::Vector3d::UnitZ();
};

/// What is seen at the middle of a pixel.
struct SeenPlace {
  int triangle = -1;  ///< -1 for nothing
  /// Of the triangle's corners; they add up to 1.
  Eigen::Vector3d shares = Eigen::Vector3d::Zero();
};

struct MeshDrawing {
  GreyImage image;
  std::vector<SeenPlace> places;  ///< of each pixel, as in the image
};

/// Draws a mesh by depth: smooth normals, one light, edges softened; what is inside of it is dark.
/// Queries are const and may run from several threads.
///
/// Which side is outside comes from where most normals lead, so that a mesh whose triangles all
/// face inwards looks the same. The order of triangles changes no pixel of the image.
class MeshPainter {
 public:
  /// Vertices at one place are one. Throws std::invalid_argument for a vertex that is not finite.
  explicit MeshPainter(const TriMesh& mesh);

  /// Throws std::invalid_argument for a view without size, more than 4096 pixels, or an even number
  /// of samples.
  MeshDrawing draw(const MeshView& view) const;

  /// The point of the mesh at a place that is seen.
  Eigen::Vector3d position(const SeenPlace& place) const;
  /// Whether it is a triangle's outside that is seen.
  bool shows_outside(int triangle, const MeshView& view) const;

 private:
  Positions positions_;
  Triangles triangles_;
  Positions normals_;  ///< of vertices, outwards
  bool inside_out_ = false;
};

}  // namespace mimetra
