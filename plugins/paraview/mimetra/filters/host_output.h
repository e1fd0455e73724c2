#pragma once

#include <set>
#include <string>

#include "toolkit/io/data.h"

class vtkPolyData;
class vtkTable;

/// Copies `input` to `output` in another shape. Leaves out data about the input's own shape:
/// normals, displacement and rest pose.
void show_shape(vtkPolyData& output, vtkPolyData& input, const mimetra::Positions& shape);

/// Copies `input` to `output` in the shape of a frame, with rest pose and displacement if the rest
/// pose is known.
void show_frame(vtkPolyData& output, vtkPolyData& input, const mimetra::MeshSequence& sequence,
                int frame);

/// Fills `mesh` with what all frames of a sequence share: faces, fields, and the rest pose if it is
/// known.
void make_mesh(vtkPolyData& mesh, const mimetra::MeshSequence& sequence,
               const std::vector<mimetra::Field>& fields);

/// Shows a frame of a sequence on `mesh`, which make_mesh() filled.
void show_mesh(vtkPolyData& output, vtkPolyData& mesh, const mimetra::MeshSequence& sequence,
               int frame);

/// Stores fields of `mesh` in `holder`, as arrays that all time steps share.
void make_fields(vtkPolyData& holder, vtkPolyData& mesh, const std::vector<mimetra::Field>& fields,
                 const mimetra::Connectivity& connectivity);
void share_fields(vtkPolyData& holder, vtkPolyData& output);

/// Names of the input's point and cell data that an output on the same points and cells lacks or
/// replaces. Excludes normals, which a new shape loses, and rest poses.
std::set<std::string> lost_arrays(vtkPolyData& input, vtkPolyData& output);

/// Fills `output` with the columns of a table. The column "time" becomes "Time", and an empty cell
/// NaN. A column of words comes last.
void fill(vtkTable& output, const mimetra::Table& table);

/// Fills `output` with the members of a JSON object, one a row, in the text columns "name" and
/// "value".
void fill(vtkTable& output, const std::string& report);
