#pragma once

#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/piece_points.h"

/// A mesh merged from pieces.
struct MergedPieces {
  vtkSmartPointer<vtkPolyData> mesh;
  /// Places of the pieces' points. `named` is false if the order of points follows the pieces.
  PiecePoints points = {};
  std::vector<Places> cells = {};               ///< places of each piece's cells
  std::vector<PieceElement> cell_holders = {};  ///< source of each cell; empty for unchanged pieces
  Pieces pieces = {};
};

/// Merges pieces, one for each process. If only one piece has points, and it is not a part of a
/// mesh, the mesh is that piece, unchanged.
///
/// Otherwise each point and cell occurs once, without ghosts, and joined_points() finds the points.
/// Cells are in the order of their global ids, else in an order of their points if these have ids,
/// else in the order of the pieces. merge_data() merges the data.
///
/// `before` is the result for the same mesh at another time, or null. If the order follows the
/// pieces, the pieces must be the same as before. Throws MismatchError for pieces that do not fit,
/// and what joined_points() and merge_data() throw.
MergedPieces merged(Pieces pieces, const MergedPieces* before);
