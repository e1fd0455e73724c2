#pragma once

#include <set>
#include <string>

#include "toolkit/operations/data.h"

class vtkPolyData;
class vtkTable;

/// Makes `output` what `input` is, in another shape: what the input says about its own shape
/// (normals, displacement, rest pose) is left out.
void show_shape(vtkPolyData& output, vtkPolyData& input, const mimetra::Positions& shape);

/// Makes `output` what `input` is, in the shape of a frame, with its rest pose where it is known.
void show_frame(vtkPolyData& output, vtkPolyData& input, const mimetra::MeshSequence& sequence,
                int frame);

/// Makes `mesh` what all frames of a sequence share: faces, fields, and the rest pose where it is
/// known.
void make_mesh(vtkPolyData& mesh, const mimetra::MeshSequence& sequence,
               const std::vector<mimetra::Field>& fields);

/// Shows a frame of a sequence on its mesh, which make_mesh() made.
void show_mesh(vtkPolyData& output, vtkPolyData& mesh, const mimetra::MeshSequence& sequence,
               int frame);

/// Makes `holder` hold fields of `mesh`, as arrays that all time steps share.
void make_fields(vtkPolyData& holder, vtkPolyData& mesh, const std::vector<mimetra::Field>& fields,
                 const mimetra::Connectivity& connectivity);
void share_fields(vtkPolyData& holder, vtkPolyData& output);

/// Names of the input's point and cell data that an output on its points and cells has not, or has
/// with other values; save normals, which a new shape loses, and rest poses.
std::set<std::string> lost_arrays(vtkPolyData& input, vtkPolyData& output);

/// One column of numbers for each of the table's, "time" as "Time"; an empty cell is NaN.
void fill(vtkTable& output, const mimetra::Table& table);

/// The members of a JSON object as rows of two columns of text, "name" and "value".
void fill(vtkTable& output, const std::string& report);
