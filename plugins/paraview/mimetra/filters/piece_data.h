#pragma once

#include <vector>

#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/piece_points.h"

class vtkDataArray;

/// Gives `mesh` the data of the pieces that hold its points and cells. Merges positions, and the
/// point and cell data that all pieces with points have as numbers of one type. Takes the field
/// data of the first piece with points. Throws MismatchError if a rest pose is field data, whose
/// rows may be any points. Throws it also if only some pieces have a rest pose or displacements.
void merge_data(vtkPolyData& mesh, const Pieces& pieces, const std::vector<PieceElement>& points,
                const std::vector<PieceElement>& cells);

/// Rows of an array at `places`, with its name, type and components.
vtkSmartPointer<vtkDataArray> rows_at(vtkDataArray& array, const Places& places);
