#pragma once

#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/merged_pieces.h"
#include "plugins/paraview/mimetra/filters/parcel.h"

/// Returns whether `output` was made on the points and cells of `mesh`.
bool lies_on(vtkPolyData& output, vtkPolyData& mesh);

/// Adds the changes that make a piece its part of `output`: arrays that differ from the merged
/// mesh's, and the names of removed arrays.
///
/// \pre `output` lies on the merged mesh.
void put_answer(Parcel& parcel, vtkPolyData& output, const MergedPieces& merged, std::size_t piece);

/// Makes `output` from the piece and what put_answer() added.
void take_answer(Parcel& parcel, vtkPolyData& piece, vtkPolyData& output);

/// Adds the arrays of `output` without rows, for a mesh that is whole on the first process.
void put_nothing(Parcel& parcel, vtkPolyData& output);
void take_nothing(Parcel& parcel, vtkPolyData& output);
