#pragma once

#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Root mean square distance of the positions (N x 3) from their mean. Expressions change it by a
/// few percent on a face, another unit by far more.
double spread(const Eigen::Ref<const Positions>& positions);

/// Spread of the surface_vertices() only, so that stray points do not count.
double spread(const Positions& positions, const Triangles& triangles);

/// Largest plausible ratio between two spreads of one mesh, or between most of its edge lengths.
constexpr double kOtherSize = 2;

/// Whether one of two lengths is more than kOtherSize times the other. \pre both are finite
bool is_other_size(double length, double usual);

/// Share of the triangles' edges that are more than kOtherSize times as long in one pose as in the
/// other. Lengths are relative to the spread of each surface. 0 if either pose has no extent.
///
/// At most 1 % between two expressions or the faces of two people, and at least 36 % if vertices
/// are numbered differently.
/// \pre both poses have the triangles' vertices
double share_of_other_edges(const Positions& pose, const Positions& other,
                            const Triangles& triangles);

/// Distances of vertices from their neighbours, along the triangles of the rest pose.
class StrayVertices {
 public:
  StrayVertices(const Positions& rest, const Triangles& triangles);

  /// Distance from the middle of the neighbours minus the same distance at rest, per vertex (N); 0
  /// for vertices without a triangle.
  Eigen::VectorXd distances(const PositionsView& pose) const;
  /// Stray distance, as a share of the mesh's size, that no vertex of a face reaches.
  static constexpr double kStray = 0.05;
  /// Whether a vertex at this distance is torn off. It then strays by more than kStray times `size`
  /// and by more than its longest edge at rest. `scale` is the size of the poses relative to the
  /// rest pose. Expressions of three faces stray by up to 3.6 % of the size and 0.6 edge lengths.
  bool is_torn_off(VertexIndex vertex, double distance, double size, double scale = 1) const;

 private:
  Eigen::VectorXd from_neighbors(const PositionsView& pose) const;

  Triangles triangles_;
  Eigen::VectorXd at_rest_, edges_;
};

/// Measures of a frame that show whether it is a pose of its mesh. They cover the
/// surface_vertices() and the triangles with_area() of the rest pose.
struct FrameShape {
  double spread = 0;
  /// Mean of the vertices.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// Whether the best affine map from the rest pose to the frame mirrors; false if either is flat.
  bool is_mirrored = false;
  /// Longest edge and its two ends; 0 and -1 without triangles.
  double longest_edge = 0;
  std::pair<VertexIndex, VertexIndex> ends{-1, -1};
  /// Largest of StrayVertices::distances(), and its vertex; 0 and -1 without triangles.
  double stray = 0;
  VertexIndex stray_vertex = -1;
  /// Largest distance of a vertex from its place in frame 0.
  double from_first = 0;
};

/// Shape of every frame (F). Throws whatever reading throws, and Cancelled.
std::vector<FrameShape> frame_shapes(const FrameSource& sequence, const Context& context = {});

/// Frames that cannot be poses of the sequence's mesh, ascending.
struct OddFrames {
  std::vector<int> of_other_size;  ///< the spread differs from the median by more than kOtherSize
  std::vector<int> mirrored;
  /// Frames with an edge longer than half the frame's size and twice the longest edge at rest.
  std::vector<int> torn;
  /// Single frames that are a fifth of the size away from the middle of the frames before and
  /// after, which are close to each other.
  std::vector<int> jumping;
  /// Frames that are not torn, but in which a vertex is_torn_off(). It leaves by a twentieth of the
  /// size from one frame to the next, and comes back likewise, possibly many frames later.
  std::vector<int> spiked;
  double usual_spread = 0;  ///< median over the frames

  bool any() const;
};

/// Finds the odd frames of a sequence. \pre one shape per frame
OddFrames odd_frames(const FrameSource& sequence, const std::vector<FrameShape>& shapes);

/// Descriptions for users: "frame 7 is mirrored against the rest pose, or numbered otherwise".
std::vector<std::string> described(const OddFrames& odd, const std::vector<FrameShape>& shapes);

}  // namespace mimetra
