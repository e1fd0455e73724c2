#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/vtk/vtk_array.h"

/// Where the arrays of a surface are in a file of VTK. Internal to the readers.
namespace mimetra {

/// Cells of one kind, in one of two forms: `corners` of all cells and `ends` of each, or `corners`
/// with the number of corners before each cell (legacy files).
struct VtkCells {
  std::uint64_t count = 0;
  VtkArray corners = {};
  VtkArray ends = {};
  bool are_interleaved = false;
  /// True if `ends` begins with a 0 before the first cell's end.
  bool has_start = false;
};

struct VtkPiece {
  std::uint64_t points = 0;
  VtkArray positions = {};
  VtkCells verts = {}, lines = {}, strips = {}, polys = {};
  /// Cells of an unstructured grid, instead of the four kinds, and their VTK cell types.
  VtkCells cells = {};
  VtkArray types = {};
  std::vector<VtkArray> point_data = {}, cell_data = {};
};

struct VtkLayout {
  VtkStorage storage = {};
  bool is_grid = false;  ///< an unstructured grid
  std::vector<VtkPiece> pieces = {};
  std::vector<VtkArray> field_data = {};
};

/// Layout of a file of VTK in XML: PolyData or UnstructuredGrid. The arrays refer to `text`. Throws
/// IoError, beginning with `path`, for malformed XML, and for counts and sizes that the text cannot
/// hold.
VtkLayout xml_layout(const std::string& path, std::string_view text);

/// Layout of a legacy file of VTK (.vtk): POLYDATA or UNSTRUCTURED_GRID in ASCII or binary, up to
/// version 5.1. Throws as xml_layout().
/// [VTK File Formats. Kitware, 2023]
VtkLayout legacy_layout(const std::string& path, std::string_view text);

}  // namespace mimetra
