#pragma once

#include <vtkPolyData.h>

#include "plugins/paraview/mimetra/filters/merged_pieces.h"
#include "plugins/paraview/mimetra/filters/parcel.h"

/// True where `output` was made on the points and cells of `mesh`.
bool lies_on(vtkPolyData& output, vtkPolyData& mesh);

/// Puts in what a piece needs to become its part of `output`, which lies on the merged mesh: what
/// is another array than the mesh's, and what is gone.
void put_answer(Parcel& parcel, vtkPolyData& output, const MergedPieces& merged, std::size_t piece);

/// Makes `output` the piece with what was put in for it.
void take_answer(Parcel& parcel, vtkPolyData& piece, vtkPolyData& output);

/// The same for a mesh that is whole on the first process: elsewhere it has its arrays, but nothing
/// in them.
void put_nothing(Parcel& parcel, vtkPolyData& output);
void take_nothing(Parcel& parcel, vtkPolyData& output);
