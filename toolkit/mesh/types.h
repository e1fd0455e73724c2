#pragma once

#include <Eigen/Core>

namespace mimetra {

/// Vertex positions, N x 3, in the unit of the user's files.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Vertex indices of triangles, M x 3, 0-based, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Row of a vertex in `Positions`; -1 for no vertex.
using VertexIndex = int;

/// View of positions with another owner, such as a frame of a sequence or a host's buffer.
using PositionsView = Eigen::Map<const Positions>;

}  // namespace mimetra
