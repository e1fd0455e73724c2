#pragma once

#include <string>
#include <vector>

#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

/// Pieces of one mesh, one for each process.
using Pieces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// Indices in the mesh of the points, or cells, of each piece.
using Places = std::vector<vtkNew<vtkIdList>>;

struct JoinedPieces {
  vtkSmartPointer<vtkPolyData> mesh;
  Pieces pieces;
  Places points;
  Places cells;
};

/// Joins pieces of the mesh `name`. A mesh that is all in one piece, without global ids and ghosts,
/// is that piece, unchanged.
///
/// Otherwise points with one global id are one point, and points and cells are in the order of
/// their ids. Ghosts take the place of their owners. The mesh has the point and cell data that all
/// pieces have, and the field data of the first piece with points.
///
/// Throws MismatchError if points or cells have no global ids, if ids or ghosts contradict each
/// other, or if the rest pose is field data.
JoinedPieces joined(Pieces pieces, const std::string& name);

/// Returns whether `output` was made on the points and cells of `mesh`.
bool lies_on(vtkPolyData& output, vtkPolyData& mesh);

/// Part of `output` on the points and cells of a piece.
///
/// \pre `output` lies on the joined mesh.
vtkSmartPointer<vtkPolyData> part_of(vtkPolyData& output, const JoinedPieces& joined,
                                     std::size_t piece);
