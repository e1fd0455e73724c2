#pragma once

#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Root mean square distance of vertices from their mean (N x 3): expressions change a face's by a
/// few percent, another unit by far more.
double spread(const Eigen::Ref<const Positions>& positions);

/// That of the surface_vertices(), so that stray points are no part of it.
double spread(const Positions& positions, const Triangles& triangles);

/// Spreads of one mesh, and lengths of most of its edges, differ by less than this factor, unless
/// something is wrong with one.
constexpr double kOtherSize = 2;

/// Whether one of two lengths is more than kOtherSize times the other. \pre both are finite
bool is_other_size(double length, double usual);

/// Share of the triangles' edges that are more than kOtherSize times as long in either pose as in
/// the other, each against the spread of its surface: 1 % at most of two expressions or two
/// people's faces, 36 % and more where vertices are numbered otherwise. 0 where either pose has no
/// extent. \pre both have the triangles' vertices
double share_of_other_edges(const Positions& pose, const Positions& other,
                            const Triangles& triangles);

/// How far vertices of poses lie from their neighbours, by triangles of the rest pose.
class StrayVertices {
 public:
  StrayVertices(const Positions& rest, const Triangles& triangles);

  /// By how much each vertex lies farther from the middle of its neighbours than at rest (N); 0 for
  /// one of no triangle.
  Eigen::VectorXd distances(const PositionsView& pose) const;
  /// Share of a mesh's size by which no vertex of a face strays.
  static constexpr double kStray = 0.05;
  /// Whether a vertex that strays so far, in a mesh of this size whose poses are so many times as
  /// large as at rest, is torn off: by more than a twentieth of the size and than its edges are
  /// long at rest. Expressions of three faces stray by up to 3.6 % and 0.6 edges.
  bool is_torn_off(VertexIndex vertex, double distance, double size, double scale = 1) const;

 private:
  Eigen::VectorXd from_neighbors(const PositionsView& pose) const;

  Triangles triangles_;
  Eigen::VectorXd at_rest_, edges_;
};

/// What of a frame tells whether it is a pose of its mesh: of the surface_vertices() and the
/// triangles with_area() of its rest pose.
struct FrameShape {
  double spread = 0;
  /// Mean of the vertices.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// The affine map that takes the rest pose nearest to it turns inside out. Never where either is
  /// flat.
  bool is_mirrored = false;
  /// The longest edge, and its ends; none where there are no triangles.
  double longest_edge = 0;
  std::pair<VertexIndex, VertexIndex> ends{-1, -1};
  /// By how much a vertex lies farther from the middle of its neighbours than at rest: the most,
  /// and that vertex; none where there are no triangles.
  double stray = 0;
  VertexIndex stray_vertex = -1;
  /// Largest distance of a vertex from where it is in frame 0.
  double from_first = 0;
};

/// Of every frame (F). Throws what reading throws, Cancelled.
std::vector<FrameShape> frame_shapes(const FrameSource& sequence, const Context& context = {});

/// Frames that cannot be poses of the sequence's mesh, ascending.
struct OddFrames {
  std::vector<int> of_other_size;  ///< than the median
  std::vector<int> mirrored;
  /// Neighbours lie apart by half the frame's size and by twice as much as in the rest pose.
  std::vector<int> torn;
  /// One frame at a time: a fifth of the size away from the middle of the frames before and after,
  /// which are next to each other.
  std::vector<int> jumping;
  /// Not torn, but a vertex is_torn_off(), by a twentieth of the size and from one frame to the
  /// next, and comes back so, be it many frames later.
  std::vector<int> spiked;
  double usual_spread = 0;  ///< the median

  bool any() const;
};

/// \pre one shape a frame
OddFrames odd_frames(const FrameSource& sequence, const std::vector<FrameShape>& shapes);

/// What is odd, for people: "frame 7 is mirrored against the rest pose, or numbered otherwise".
std::vector<std::string> described(const OddFrames& odd, const std::vector<FrameShape>& shapes);

}  // namespace mimetra
