#pragma once

#include <Eigen/Core>

namespace mimetra {

/// Vertex positions, N x 3, in the unit of the user's files.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Vertex indices of triangles, M x 3, 0-based, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Row of a vertex in `Positions`; -1 where there is none.
using VertexIndex = int;

/// A view of positions that somebody else owns: a frame of a sequence, a host's buffer.
using PositionsView = Eigen::Map<const Positions>;

}  // namespace mimetra
