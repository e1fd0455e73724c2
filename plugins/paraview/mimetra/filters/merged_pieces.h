#pragma once

#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/piece_points.h"

/// One mesh put together from pieces.
struct MergedPieces {
  vtkSmartPointer<vtkPolyData> mesh;
  /// Where the points of the pieces are; `named` is false where their order follows the pieces.
  PiecePoints points = {};
  std::vector<Places> cells = {};               ///< where the cells of each piece are
  std::vector<PieceElement> cell_holders = {};  ///< of each cell, save of a piece as it is
  Pieces pieces = {};
};

/// Merges pieces, one for each process: where one alone has points, and is no part of a mesh, it is
/// the mesh as it is. Else each point and cell comes once, without ghosts: points as
/// joined_points() finds them, cells in the order of their global ids; without those, in an order
/// of their points' where these have ids, else in the order of the pieces. Data come along as by
/// merge_data(). `before` is what came of the same mesh at another time, or null; where the order
/// follows the pieces, they must be the same ones. Throws MismatchError for pieces that do not fit,
/// and what joined_points() and merge_data() throw.
MergedPieces merged(Pieces pieces, const MergedPieces* before);
