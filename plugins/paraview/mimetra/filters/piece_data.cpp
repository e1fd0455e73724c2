#include "plugins/paraview/mimetra/filters/piece_data.h"

#include <algorithm>
#include <string>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

namespace {

bool is_empty(vtkPolyData& piece) {
  return piece.GetNumberOfPoints() == 0;
}

vtkPolyData& first_of(const Pieces& pieces) {
  return **std::ranges::find_if_not(pieces, [](const auto& piece) { return is_empty(*piece); });
}

/// Array `name` of each piece. Empty unless all pieces with points have it in the same type and
/// shape.
std::vector<vtkDataArray*> alike(const Pieces& pieces, const char* name,
                                 const auto& attributes_of) {
  std::vector<vtkDataArray*> arrays;
  const vtkDataArray* first = nullptr;
  for (const auto& piece : pieces) {
    vtkDataArray* array = is_empty(*piece) ? nullptr : attributes_of(*piece).GetArray(name);
    arrays.push_back(array);
    if (is_empty(*piece)) continue;
    if (!first) first = array;
    const bool fits = array && array->GetDataType() == first->GetDataType() &&
                      array->GetDataType() != VTK_BIT &&
                      array->GetNumberOfComponents() == first->GetNumberOfComponents();
    if (!fits) return {};
  }
  return arrays;
}

vtkSmartPointer<vtkDataArray> collected(const std::vector<vtkDataArray*>& arrays,
                                        const std::vector<PieceElement>& holders) {
  vtkDataArray* like = *std::ranges::find_if(arrays, [](const auto* each) { return each; });
  vtkSmartPointer<vtkDataArray> all;
  all.TakeReference(like->NewInstance());
  all->SetNumberOfComponents(like->GetNumberOfComponents());
  all->CopyComponentNames(like);
  all->SetName(like->GetName());
  all->SetNumberOfTuples(static_cast<vtkIdType>(holders.size()));
  for (std::size_t i = 0; i < holders.size(); ++i) {
    all->SetTuple(static_cast<vtkIdType>(i), holders[i].index, arrays[holders[i].piece]);
  }
  return all;
}

void merge_attributes(vtkDataSetAttributes& merged, const Pieces& pieces,
                      const std::vector<PieceElement>& holders, const auto& attributes_of) {
  vtkDataSetAttributes& first = attributes_of(first_of(pieces));
  for (int i = 0; i < first.GetNumberOfArrays(); ++i) {
    const char* name = first.GetArrayName(i);
    if (!name || std::string(name) == vtkDataSetAttributes::GhostArrayName()) continue;
    const auto arrays = alike(pieces, name, attributes_of);
    if (!arrays.empty()) merged.AddArray(collected(arrays, holders));
  }
  for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role) {
    vtkAbstractArray* active = first.GetAbstractAttribute(role);
    if (active && active->GetName()) merged.SetActiveAttribute(active->GetName(), role);
  }
}

vtkSmartPointer<vtkPoints> merged_points(const Pieces& pieces,
                                         const std::vector<PieceElement>& holders) {
  std::vector<vtkDataArray*> positions;
  int type = VTK_FLOAT;
  for (const auto& piece : pieces) {
    positions.push_back(is_empty(*piece) ? nullptr : piece->GetPoints()->GetData());
    if (positions.back() && positions.back()->GetDataType() != VTK_FLOAT) type = VTK_DOUBLE;
  }
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  points->SetNumberOfPoints(static_cast<vtkIdType>(holders.size()));
  for (std::size_t i = 0; i < holders.size(); ++i) {
    const PieceElement& from = holders[i];
    points->SetPoint(static_cast<vtkIdType>(i), positions[from.piece]->GetTuple3(from.index));
  }
  return points;
}

/// Throws MismatchError if some pieces have an array that defines a rest pose, but not all have it
/// alike.
void expect_alike(const Pieces& pieces, const char* name) {
  const auto attributes_of = [](vtkPolyData& piece) -> vtkDataSetAttributes& {
    return *piece.GetPointData();
  };
  const auto has_one = [&](const auto& piece) {
    return !is_empty(*piece) && piece->GetPointData()->HasArray(name);
  };
  const auto found = std::ranges::find_if(pieces, has_one);
  if (found == pieces.end() || !alike(pieces, name, attributes_of).empty()) return;
  throw MismatchError("the point data " + std::string(name) + " of process " +
                      std::to_string(found - pieces.begin()) +
                      " are not on all processes, or of another type there; expected them on all "
                      "points of the mesh, or on none");
}

/// Throws MismatchError if a rest pose is field data. Distributing a mesh may leave field data
/// behind, whole or in part, so it is unknown which rows belong to a piece, even if their number
/// fits.
void expect_no_rest_in_fields(const Pieces& pieces) {
  for (const auto& piece : pieces) {
    const bool on_points = piece->GetPointData()->HasArray(kRestPose) != 0;
    if (on_points || !piece->GetFieldData()->HasArray(kRestPose)) continue;
    throw MismatchError("the rest pose is field data (" + std::string(kRestPose) +
                        "), and which of its points the pieces of several processes hold cannot "
                        "be known; read the file by mimetra Sequence, which makes it point data, "
                        "or leave it out by Pass Arrays");
  }
}

}  // namespace

void merge_data(vtkPolyData& mesh, const Pieces& pieces, const std::vector<PieceElement>& points,
                const std::vector<PieceElement>& cells) {
  for (const char* name : {kRestPose, kPlaced, kDisplacement}) expect_alike(pieces, name);
  expect_no_rest_in_fields(pieces);
  mesh.SetPoints(merged_points(pieces, points));
  merge_attributes(
      *mesh.GetPointData(), pieces, points,
      [](vtkPolyData& piece) -> vtkDataSetAttributes& { return *piece.GetPointData(); });
  merge_attributes(
      *mesh.GetCellData(), pieces, cells,
      [](vtkPolyData& piece) -> vtkDataSetAttributes& { return *piece.GetCellData(); });
  mesh.GetFieldData()->ShallowCopy(first_of(pieces).GetFieldData());
  mesh.GetFieldData()->RemoveArray(kRestPose);
}

vtkSmartPointer<vtkDataArray> rows_at(vtkDataArray& array, const Places& places) {
  vtkSmartPointer<vtkDataArray> rows;
  rows.TakeReference(array.NewInstance());
  rows->SetNumberOfComponents(array.GetNumberOfComponents());
  rows->CopyComponentNames(&array);
  rows->SetName(array.GetName());
  rows->SetNumberOfTuples(static_cast<vtkIdType>(places.size()));
  vtkIdType row = 0;
  for (const vtkIdType place : places) rows->SetTuple(row++, place, &array);
  return rows;
}
