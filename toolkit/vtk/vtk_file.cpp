#include "toolkit/vtk/vtk_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {
namespace {

/// Corners of all cells, and the end of each cell's corners.
struct CellCorners {
  std::vector<int> corners;
  std::vector<int> ends;
};

/// Decodes the arrays of one piece, with messages that begin with the path.
class PieceReader {
 public:
  PieceReader(const std::string& path, const VtkStorage& storage, const VtkPiece& piece)
      : path_(path), storage_(storage), piece_(piece) {}

  [[noreturn]] void fail(const std::string& problem) const { throw IoError(path_, problem); }

  /// An array of `tuples` tuples, which belongs to `owner`, such as "PointData".
  vtkSmartPointer<vtkDataArray> array(const VtkArray& stored, std::uint64_t tuples,
                                      const std::string& owner) const {
    if (stored.type.empty()) fail(owner + ": expected an array");
    const std::string name = owner + (stored.name.empty() ? "" : ", array '" + stored.name + "'");
    auto values =
        decoded(stored, storage_, [&](const std::string& problem) { fail(name + ": " + problem); });
    const auto found = static_cast<std::uint64_t>(values->GetNumberOfTuples());
    // Bits fill whole bytes.
    if (stored.type == "Bit" && found > tuples) {
      values->SetNumberOfTuples(static_cast<vtkIdType>(tuples));
    } else if (found != tuples) {
      fail(name + ": expected " + std::to_string(tuples) + " tuples, found " +
           std::to_string(found));
    }
    return values;
  }

  vtkSmartPointer<vtkPoints> points() const {
    const auto values = array(piece_.positions, piece_.points, "Points");
    if (values->GetNumberOfComponents() != 3) {
      fail("Points: expected 3 components, found " +
           std::to_string(values->GetNumberOfComponents()));
    }
    auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetData(values);
    return points;
  }

  CellCorners corners_of(const VtkCells& cells, const std::string& owner) const {
    if (cells.count == 0) return {};
    const std::vector<int> stored = integers(cells.corners, owner);
    CellCorners found = cells.are_interleaved ? without_counts(stored, cells.count, owner)
                                              : CellCorners{stored, integers(cells.ends, owner)};
    if (cells.has_start && !found.ends.empty()) found.ends.erase(found.ends.begin());
    check(found, cells.count, owner);
    return found;
  }

  std::vector<int> integers(const VtkArray& stored, const std::string& owner) const {
    const std::string name = owner + ", array '" + stored.name + "'";
    if (stored.type.empty()) fail(owner + ": expected arrays 'connectivity' and 'offsets'");
    VtkArray flat = stored;
    flat.components = 1;  // whatever the file says
    const auto values =
        decoded(flat, storage_, [&](const std::string& problem) { fail(name + ": " + problem); });
    std::vector<int> numbers(static_cast<std::size_t>(values->GetNumberOfValues()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double number = values->GetComponent(static_cast<vtkIdType>(i), 0);
      if (!(std::abs(number) <= std::numeric_limits<int>::max()) || number != std::floor(number)) {
        fail(name + ": expected whole numbers that fit 32 bits, found " + readable(number));
      }
      numbers[i] = static_cast<int>(number);
    }
    return numbers;
  }

 private:
  CellCorners without_counts(const std::vector<int>& stored, std::uint64_t cells,
                             const std::string& owner) const {
    CellCorners found;
    std::size_t at = 0;
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
      const std::size_t count = at < stored.size() && stored[at] >= 0
                                    ? static_cast<std::size_t>(stored[at])
                                    : stored.size();
      if (stored.size() - at <= count) {
        fail(owner + ": cell " + std::to_string(cell) + " has more corners than the file");
      }
      const auto first = stored.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      found.corners.insert(found.corners.end(), first, first + static_cast<std::ptrdiff_t>(count));
      found.ends.push_back(static_cast<int>(found.corners.size()));
      at += 1 + count;
    }
    return found;
  }

  void check(const CellCorners& cells, std::uint64_t count, const std::string& owner) const {
    if (cells.ends.size() != count) {
      fail(owner + ", array 'offsets': expected " + std::to_string(count) + " numbers, found " +
           std::to_string(cells.ends.size()));
    }
    int before = 0;
    for (const int end : cells.ends) {
      if (end < before)
        fail(owner + ", array 'offsets': falls from " + std::to_string(before) + " to " +
             std::to_string(end));
      before = end;
    }
    if (static_cast<std::size_t>(before) != cells.corners.size()) {
      fail(owner + ", array 'offsets': ends at " + std::to_string(before) + ", but there are " +
           std::to_string(cells.corners.size()) + " corners");
    }
    for (const int corner : cells.corners) {
      if (corner >= 0 && static_cast<std::uint64_t>(corner) < piece_.points) continue;
      fail(owner + ": corner " + std::to_string(corner) + " is none of the " +
           std::to_string(piece_.points) + " points");
    }
  }

  const std::string& path_;
  const VtkStorage& storage_;
  const VtkPiece& piece_;
};

vtkSmartPointer<vtkTypeInt32Array> array_of(const std::vector<int>& numbers, bool with_start) {
  auto array = vtkSmartPointer<vtkTypeInt32Array>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(numbers.size()) + with_start);
  if (with_start) array->SetValue(0, 0);
  std::ranges::copy(numbers, array->GetPointer(with_start));
  return array;
}

vtkSmartPointer<vtkCellArray> cell_array(const CellCorners& cells) {
  auto array = vtkSmartPointer<vtkCellArray>::New();
  if (!cells.ends.empty())
    array->SetData(array_of(cells.ends, true), array_of(cells.corners, false));
  return array;
}

/// Polygons of an unstructured grid.
struct GridPolygons {
  CellCorners polygons;
  vtkSmartPointer<vtkIdList> cells;  ///< number of each polygon among the cells
};

GridPolygons polygons_of(const PieceReader& reader, const VtkPiece& piece) {
  const CellCorners all = reader.corners_of(piece.cells, "Cells");
  GridPolygons found{{}, vtkSmartPointer<vtkIdList>::New()};
  if (piece.cells.count == 0) return found;
  const std::vector<int> types = reader.integers(piece.types, "Cells");
  if (types.size() != all.ends.size()) {
    reader.fail("Cells, array 'types': expected " + std::to_string(all.ends.size()) +
                " numbers, found " + std::to_string(types.size()));
  }
  auto& [corners, ends] = found.polygons;
  for (std::size_t cell = 0; cell < types.size(); ++cell) {
    const int first = cell == 0 ? 0 : all.ends[cell - 1];
    switch (types[cell]) {
      case VTK_EMPTY_CELL:
      case VTK_VERTEX:
      case VTK_POLY_VERTEX:
      case VTK_LINE:
      case VTK_POLY_LINE:
        continue;
      case VTK_TRIANGLE:
      case VTK_QUAD:
      case VTK_POLYGON:
      case VTK_PIXEL:
        break;
      default:
        reader.fail("cell " + std::to_string(cell) + " has VTK's type " +
                    std::to_string(types[cell]) +
                    ", which is no polygon; apply ParaView's Extract Surface first");
    }
    corners.insert(corners.end(), all.corners.begin() + first,
                   all.corners.begin() + all.ends[cell]);
    // A pixel's corners come row by row.
    if (types[cell] == VTK_PIXEL && all.ends[cell] - first == 4) {
      std::swap(corners[corners.size() - 2], corners[corners.size() - 1]);
    }
    ends.push_back(static_cast<int>(corners.size()));
    found.cells->InsertNextId(static_cast<vtkIdType>(cell));
  }
  return found;
}

bool is_same(const VtkArray& a, const VtkArray& b) {
  return a.type == b.type && a.form == b.form && a.stored == b.stored;
}

bool is_same(const VtkCells& a, const VtkCells& b) {
  return a.count == b.count && is_same(a.corners, b.corners) && is_same(a.ends, b.ends);
}

bool is_same(const VtkPiece& a, const VtkPiece& b) {
  return a.points == b.points && is_same(a.verts, b.verts) && is_same(a.lines, b.lines) &&
         is_same(a.strips, b.strips) && is_same(a.polys, b.polys) && is_same(a.cells, b.cells) &&
         is_same(a.types, b.types);
}

VtkLayout layout_of(const std::string& path, const std::string& text) {
  VtkLayout layout = text.starts_with("# vtk") ? legacy_layout(path, text) : xml_layout(path, text);
  std::erase_if(layout.pieces, [](const VtkPiece& piece) { return piece.points == 0; });
  if (layout.pieces.empty()) throw IoError(path, "has no points");
  return layout;
}

}  // namespace

const std::vector<std::string>& vtk_extensions() {
  static const std::vector<std::string> extensions = {".vtp", ".vtu", ".vtk"};
  return extensions;
}

VtkFile::VtkFile(const std::filesystem::path& path)
    : path_(path.string()), text_(read_file(path)), layout_(layout_of(path_, text_)) {}

vtkSmartPointer<vtkPolyData> VtkFile::piece(
    const VtkPiece& piece, bool points_only,
    const std::function<bool(const std::string&)>& is_wanted) const {
  const PieceReader reader(path_, layout_.storage, piece);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(reader.points());
  if (points_only) return data;
  GridPolygons grid;
  std::uint64_t cells =
      piece.verts.count + piece.lines.count + piece.polys.count + piece.strips.count;
  if (layout_.is_grid) {
    grid = polygons_of(reader, piece);
    data->SetPolys(cell_array(grid.polygons));
    cells = piece.cells.count;
  } else {
    data->SetVerts(cell_array(reader.corners_of(piece.verts, "Verts")));
    data->SetLines(cell_array(reader.corners_of(piece.lines, "Lines")));
    data->SetPolys(cell_array(reader.corners_of(piece.polys, "Polys")));
    data->SetStrips(cell_array(reader.corners_of(piece.strips, "Strips")));
  }
  for (const VtkArray& array : piece.point_data) {
    if (is_wanted && !is_wanted(array.name)) continue;
    data->GetPointData()->AddArray(reader.array(array, piece.points, "PointData"));
  }
  for (const VtkArray& array : piece.cell_data) {
    if (is_wanted && !is_wanted(array.name)) continue;
    vtkSmartPointer<vtkDataArray> values = reader.array(array, cells, "CellData");
    if (layout_.is_grid) {
      const auto chosen = vtkSmartPointer<vtkDataArray>::Take(values->NewInstance());
      chosen->SetName(values->GetName());
      chosen->SetNumberOfComponents(values->GetNumberOfComponents());
      chosen->SetNumberOfTuples(grid.cells->GetNumberOfIds());
      values->GetTuples(grid.cells, chosen);
      values = chosen;
    }
    data->GetCellData()->AddArray(values);
  }
  return data;
}

vtkSmartPointer<vtkPolyData> VtkFile::points() const {
  if (layout_.pieces.size() > 1) return poly_data([](const std::string&) { return false; });
  return piece(layout_.pieces.front(), true, {});
}

vtkSmartPointer<vtkPolyData> VtkFile::poly_data(
    const std::function<bool(const std::string&)>& is_wanted) const {
  vtkSmartPointer<vtkPolyData> data;
  if (layout_.pieces.size() == 1) {
    data = piece(layout_.pieces.front(), false, is_wanted);
  } else {
    const SilentVtk silent;
    const vtkNew<vtkAppendPolyData> append;
    append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    for (const VtkPiece& part : layout_.pieces) append->AddInputData(piece(part, false, is_wanted));
    append->Update();
    data = append->GetOutput();
  }
  for (const VtkArray& array : layout_.field_data) {
    if (is_wanted && !is_wanted(array.name)) continue;
    data->GetFieldData()->AddArray(decoded(array, layout_.storage, [&](const std::string& problem) {
      throw IoError(path_, "FieldData, array '" + array.name + "': " + problem);
    }));
  }
  return data;
}

std::vector<VtkFile::StoredField> VtkFile::stored_fields() const {
  std::vector<StoredField> fields;
  for (const VtkArray& array : layout_.pieces.front().point_data) {
    fields.push_back({Field::Location::vertices, array.name});
  }
  for (const VtkArray& array : layout_.pieces.front().cell_data) {
    fields.push_back({Field::Location::triangles, array.name});
  }
  return fields;
}

bool VtkFile::stores_cells_of(const VtkFile& other) const {
  return layout_.storage == other.layout_.storage && layout_.is_grid == other.layout_.is_grid &&
         std::ranges::equal(layout_.pieces, other.layout_.pieces,
                            [](const VtkPiece& a, const VtkPiece& b) { return is_same(a, b); });
}

bool VtkFile::stores_field_of(const VtkFile& other, const StoredField& field) const {
  const auto array_in = [&field](const VtkPiece& piece) {
    const bool is_on_points = field.location == Field::Location::vertices;
    const auto& arrays = is_on_points ? piece.point_data : piece.cell_data;
    const auto found = std::ranges::find(arrays, field.name, &VtkArray::name);
    return found == arrays.end() ? nullptr : &*found;
  };
  const auto is_in_both = [&](const VtkPiece& a, const VtkPiece& b) {
    const VtkArray *mine = array_in(a), *others = array_in(b);
    return mine && others && mine->components == others->components && is_same(*mine, *others);
  };
  return stores_cells_of(other) &&
         std::ranges::equal(layout_.pieces, other.layout_.pieces, is_in_both);
}

}  // namespace mimetra
