#include "plugins/paraview/mimetra/filters/joined_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkMath.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

namespace {

/// Positions of one point on several processes may differ by this share of the largest coordinate:
/// about eight times the resolution of single precision.
constexpr double kRounding = 1e-6;

constexpr std::array kPointsAndCells = {vtkDataObject::POINT, vtkDataObject::CELL};

std::size_t as_index(vtkIdType id) {
  return static_cast<std::size_t>(id);
}

/// Throws MismatchError if a piece cannot be joined with others.
void expect_joinable(vtkPolyData& piece, const std::string& process, const std::string& name) {
  for (const int where : kPointsAndCells) {
    vtkDataSetAttributes& data = *piece.GetAttributes(where);
    const vtkIdType count = piece.GetNumberOfElements(where);
    if (count == 0 || (data.GetGlobalIds() && data.GetNumberOfTuples() == count)) continue;
    throw MismatchError(process + " has a piece of " + name +
                        " without global ids; apply the filter Generate Global Ids before "
                        "distributing it");
  }
  for (vtkCellArray* cells :
       {piece.GetVerts(), piece.GetLines(), piece.GetPolys(), piece.GetStrips()}) {
    std::array<double, 2> range = {0, -1};
    vtkDataArray* corners = cells->GetConnectivityArray();
    if (corners->GetNumberOfTuples() > 0) corners->GetRange(range.data());
    const auto points = static_cast<double>(piece.GetNumberOfPoints());
    if (cells->IsValid() && range[0] >= 0 && range[1] < points) continue;
    throw MismatchError("the cells of " + process + " use points that it does not have");
  }
  const bool on_points = piece.GetPointData()->HasArray(kRestPose) != 0;
  if (on_points || !piece.GetFieldData()->HasArray(kRestPose)) return;
  throw MismatchError("the rest pose of " + name + " is field data (" + kRestPose +
                      "), which pieces cannot have; read the file by mimetra Sequence");
}

/// Global ids of points or cells, and the index in the mesh for each id.
struct Ids {
  explicit Ids(vtkDataSetAttributes& data) {
    if (data.GetGlobalIds()) array->DeepCopy(data.GetGlobalIds());
  }
  vtkTypeInt64 operator[](vtkIdType row) const { return array->GetValue(row); }
  std::string name(vtkIdType row) const { return "global id " + std::to_string((*this)[row]); }

  vtkNew<vtkTypeInt64Array> array;
  std::unordered_map<vtkTypeInt64, vtkIdType> places;
};

/// Returns which points or cells are ghosts, those of other pieces.
std::vector<bool> ghosts_of(vtkPolyData& all, int where) {
  constexpr int mark = vtkDataSetAttributes::DUPLICATEPOINT;
  static_assert(mark == int{vtkDataSetAttributes::DUPLICATECELL});
  std::vector<bool> ghosts;
  for (vtkIdType i = 0; i < all.GetNumberOfElements(where); ++i) {
    ghosts.push_back((all.GetGhostArray(where)->GetValue(i) & mark) != 0);
  }
  return ghosts;
}

/// Rows of the points or cells that the mesh has: one for each id, in the order of the ids. Calls
/// `expect_one` with each two rows that have one id and are no ghosts.
std::vector<vtkIdType> owners(const Ids& ids, const std::vector<bool>& ghosts,
                              const auto& expect_one) {
  std::vector<vtkIdType> rows(ghosts.size());
  std::iota(rows.begin(), rows.end(), 0);
  const auto key = [&](vtkIdType row) { return std::pair(ids[row], bool{ghosts[as_index(row)]}); };
  std::ranges::stable_sort(rows, {}, key);
  std::vector<vtkIdType> found;
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    const bool is_ghost = ghosts[as_index(*row)];
    if (row != rows.begin() && ids[*row] == ids[*std::prev(row)]) {
      if (!is_ghost) expect_one(*std::prev(row), *row);
      continue;
    }
    if (is_ghost) {
      throw MismatchError(ids.name(*row) +
                          " names only ghosts; apply Remove Ghost Information, or distribute the "
                          "mesh anew");
    }
    found.push_back(*row);
  }
  return found;
}

/// Copies rows, except the marks of ghosts.
void copy_rows(vtkDataSetAttributes& to, vtkDataSetAttributes& from, vtkIdList& rows) {
  to.CopyAllOn();  // global ids, too
  to.CopyFieldOff(vtkDataSetAttributes::GhostArrayName());
  to.CopyAllocate(&from, rows.GetNumberOfIds());
  to.CopyData(&from, &rows);
}

void copy_points(vtkPolyData& to, vtkPolyData& from, vtkIdList& rows) {
  vtkNew<vtkPoints> points;
  points->SetDataType(from.GetPoints()->GetDataType());
  from.GetPoints()->GetPoints(&rows, points);
  to.SetPoints(points);
  copy_rows(*to.GetPointData(), *from.GetPointData(), rows);
}

/// Sets the points of the mesh, and their places.
void join_points(vtkPolyData& mesh, vtkPolyData& all, const Pieces& pieces, Ids& ids) {
  std::vector<bool> ghosts = ghosts_of(all, vtkDataObject::POINT);
  const std::vector<bool> ghost_cells = ghosts_of(all, vtkDataObject::CELL);
  vtkNew<vtkIdList> rows;
  for (vtkIdType cell = 0; cell < all.GetNumberOfCells(); ++cell) {
    if (ghost_cells[as_index(cell)]) continue;
    all.GetCellPoints(cell, rows);
    for (const vtkIdType corner : *rows) ghosts[as_index(corner)] = false;
  }
  std::vector<std::size_t> processes;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    processes.resize(processes.size() + as_index(pieces[i]->GetNumberOfPoints()), i);
  }
  double largest = 0;
  for (const double bound : std::span(all.GetBounds(), 6)) {
    largest = std::max(largest, std::abs(bound));
  }
  rows->Reset();
  for (const vtkIdType row : owners(ids, ghosts, [&](vtkIdType a, vtkIdType b) {
         const std::size_t process = processes[as_index(b)];
         if (processes[as_index(a)] == process) {
           throw MismatchError(ids.name(b) + " names two points of process " +
                               std::to_string(process) +
                               "; use one process, or give each point its own id");
         }
         std::array<double, 3> first = {}, second = {};
         all.GetPoint(a, first.data());
         all.GetPoint(b, second.data());
         const double apart = vtkMath::Distance2BetweenPoints(first.data(), second.data());
         if (std::sqrt(apart) <= kRounding * largest || std::isnan(apart)) return;
         throw MismatchError(ids.name(b) + " names points at different positions, one on process " +
                             std::to_string(process) + "; give each point its own id");
       })) {
    ids.places[ids[row]] = rows->InsertNextId(row);
  }
  copy_points(mesh, all, *rows);
}

/// Sets the cells of the mesh, and their places.
void join_cells(vtkPolyData& mesh, vtkPolyData& all, const Ids& points, Ids& ids) {
  auto found = owners(ids, ghosts_of(all, vtkDataObject::CELL), [&](vtkIdType, vtkIdType row) {
    throw MismatchError(ids.name(row) +
                        " names two cells, and neither is a ghost; give each cell its own id");
  });
  // VTK numbers vertices first, then lines, ...
  const vtkIdType lines = all.GetNumberOfVerts(), polygons = lines + all.GetNumberOfLines(),
                  strips = polygons + all.GetNumberOfPolys();
  const auto kind = [&](vtkIdType row) {
    return std::size_t{row >= lines} + std::size_t{row >= polygons} + std::size_t{row >= strips};
  };
  std::ranges::stable_sort(found, {}, kind);
  std::array<vtkNew<vtkCellArray>, 4> cells;
  vtkNew<vtkIdList> rows, corners;
  for (const vtkIdType row : found) {
    all.GetCellPoints(row, corners);
    for (vtkIdType& corner : *corners) corner = points.places.at(points[corner]);
    cells[kind(row)]->InsertNextCell(corners);
    ids.places[ids[row]] = rows->InsertNextId(row);
  }
  mesh.SetVerts(cells[0]);
  mesh.SetLines(cells[1]);
  mesh.SetPolys(cells[2]);
  mesh.SetStrips(cells[3]);
  copy_rows(*mesh.GetCellData(), *all.GetCellData(), *rows);
}

void set_places(vtkIdList& places, vtkDataSetAttributes& piece, const Ids& ids) {
  const Ids own(piece);
  for (vtkIdType i = 0; i < own.array->GetNumberOfValues(); ++i) {
    places.InsertNextId(ids.places.at(own[i]));
  }
}

}  // namespace

JoinedPieces joined(Pieces pieces, const std::string& name) {
  JoinedPieces joined{vtkSmartPointer<vtkPolyData>::New(), pieces, Places(pieces.size()),
                      Places(pieces.size())};
  const auto has_points = [](const auto& piece) { return piece->GetNumberOfPoints() > 0; };
  const auto filled = std::ranges::count_if(pieces, has_points);
  if (filled > 0) joined.mesh = *std::ranges::find_if(pieces, has_points);
  vtkPolyData& first = *joined.mesh;
  if (filled < 2 && !first.GetPointData()->GetGlobalIds() && !first.HasAnyGhostPoints() &&
      !first.HasAnyGhostCells()) {
    return joined;
  }
  vtkNew<vtkAppendPolyData> append;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    expect_joinable(*pieces[i], "process " + std::to_string(i), name);
    vtkNew<vtkPolyData> piece;
    piece->ShallowCopy(pieces[i]);
    piece->AllocatePointGhostArray();
    piece->AllocateCellGhostArray();
    append->AddInputData(piece);
  }
  append->Update();
  vtkPolyData& all = *append->GetOutput();
  expect_joinable(all, "some process", name);  // ids of one type
  Ids points(*all.GetPointData()), cells(*all.GetCellData());
  joined.mesh = vtkSmartPointer<vtkPolyData>::New();
  join_points(*joined.mesh, all, pieces, points);
  join_cells(*joined.mesh, all, points, cells);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    set_places(*joined.points[i], *pieces[i]->GetPointData(), points);
    set_places(*joined.cells[i], *pieces[i]->GetCellData(), cells);
  }
  joined.mesh->GetFieldData()->ShallowCopy(first.GetFieldData());
  return joined;
}

bool lies_on(vtkPolyData& output, vtkPolyData& mesh) {
  return output.GetPolys() == mesh.GetPolys() &&
         output.GetNumberOfPoints() == mesh.GetNumberOfPoints() &&
         output.GetNumberOfCells() == mesh.GetNumberOfCells();
}

vtkSmartPointer<vtkPolyData> part_of(vtkPolyData& output, const JoinedPieces& joined,
                                     std::size_t piece) {
  vtkPolyData& given = *joined.pieces[piece];
  if (&given == joined.mesh) return &output;
  const auto part = vtkSmartPointer<vtkPolyData>::New();
  if (given.GetNumberOfPoints() == 0) return part;
  part->CopyStructure(&given);
  copy_points(*part, output, *joined.points[piece]);
  copy_rows(*part->GetCellData(), *output.GetCellData(), *joined.cells[piece]);
  for (const int where : kPointsAndCells) {
    if (auto* marks = given.GetGhostArray(where)) part->GetAttributes(where)->AddArray(marks);
  }
  part->GetFieldData()->ShallowCopy(output.GetFieldData());
  return part;
}
