#pragma once

#include <string_view>
#include <vector>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// An eye or a mouth: an upper and a lower edge of the skin, which may touch.
struct FaceOpening {
  std::string_view name;  ///< "right eye", "left eye" or "mouth"
  /// Vertices of the skin along each edge, around its middle.
  std::vector<VertexIndex> upper, lower;
  double width =
      0;  ///< distance between the opening's corners at rest, in the unit of the positions
};

/// Finds the openings of a face from its iBUG landmarks (0 to 67) and their vertices. An edge
/// consists of vertices that are nearer to its landmarks than to the other edge's, along the
/// surface. Only the middle half of the opening counts. An opening is left out if landmarks are
/// missing, or if its edges are connected by uncut skin.
///
/// Throws std::invalid_argument if a landmark's vertex does not exist.
std::vector<FaceOpening> face_openings(const TriMesh& rest, const LandmarkVertices& landmarks);

/// Shortest distance between the edges' vertices, as a share of the opening's width (F x openings).
/// Throws what reading throws, and Cancelled.
Eigen::MatrixXd openness(const FrameSource& sequence, const std::vector<FaceOpening>& openings,
                         const Context& context = {});

}  // namespace mimetra
