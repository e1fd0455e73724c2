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
  /// The skin of either edge, around its middle.
  std::vector<VertexIndex> upper, lower;
  double width = 0;  ///< between the opening's corners at rest, in the unit of the positions
};

/// The openings of a face whose iBUG landmarks (0 to 67) and their vertices are known. An edge is
/// what is nearer to its landmarks than to the other edge's, along the surface, in the middle half
/// of the opening. Left out is one whose landmarks are not all there, and one whose edges hang
/// together: skin without a cut.
///
/// Throws std::invalid_argument for a landmark that is no vertex of the mesh.
std::vector<FaceOpening> face_openings(const TriMesh& rest, const LandmarkVertices& landmarks);

/// The shortest distance between the edges' vertices, in shares of the opening's width (F x
/// openings). Throws what reading throws, Cancelled.
Eigen::MatrixXd openness(const FrameSource& sequence, const std::vector<FaceOpening>& openings,
                         const Context& context = {});

}  // namespace mimetra
