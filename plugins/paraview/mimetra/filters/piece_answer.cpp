#include "plugins/paraview/mimetra/filters/piece_answer.h"

#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include "plugins/paraview/mimetra/filters/piece_data.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

namespace {

void put_names(Parcel& parcel, const std::vector<std::string>& names) {
  parcel.words << static_cast<int>(names.size());
  for (const std::string& name : names) parcel.words << name;
}

std::vector<std::string> taken_names(Parcel& parcel) {
  int count = 0;
  parcel.words >> count;
  std::vector<std::string> names(static_cast<std::size_t>(count));
  for (std::string& name : names) parcel.words >> name;
  return names;
}

void put_scalars(Parcel& parcel, vtkDataSetAttributes& attributes) {
  vtkDataArray* scalars = attributes.GetScalars();
  parcel.words << std::string(scalars && scalars->GetName() ? scalars->GetName() : "");
}

void take_scalars(Parcel& parcel, vtkDataSetAttributes& attributes) {
  std::string name;
  parcel.words >> name;
  if (!name.empty()) attributes.SetActiveScalars(name.c_str());
}

void put_changes(Parcel& parcel, vtkDataSetAttributes& made, vtkDataSetAttributes& given,
                 const Places& places) {
  std::vector<std::string> gone;
  for (int i = 0; i < given.GetNumberOfArrays(); ++i) {
    const char* name = given.GetArrayName(i);
    if (name && !made.HasArray(name)) gone.push_back(name);
  }
  put_names(parcel, gone);
  std::vector<vtkDataArray*> others;
  for (int i = 0; i < made.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = made.GetArray(i);
    if (array && array->GetName() && array != given.GetArray(array->GetName())) {
      others.push_back(array);
    }
  }
  parcel.words << static_cast<int>(others.size());
  for (vtkDataArray* array : others) parcel.put(rows_at(*array, places));
  put_scalars(parcel, made);
}

void take_changes(Parcel& parcel, vtkDataSetAttributes& attributes) {
  for (const std::string& name : taken_names(parcel)) attributes.RemoveArray(name.c_str());
  int count = 0;
  parcel.words >> count;
  for (int i = 0; i < count; ++i) attributes.AddArray(parcel.take());
  take_scalars(parcel, attributes);
}

void put_empty(Parcel& parcel, vtkDataSetAttributes& attributes) {
  std::vector<vtkDataArray*> arrays;
  for (int i = 0; i < attributes.GetNumberOfArrays(); ++i) {
    if (vtkDataArray* array = attributes.GetArray(i)) arrays.push_back(array);
  }
  parcel.words << static_cast<int>(arrays.size());
  for (vtkDataArray* array : arrays) parcel.put(rows_at(*array, {}));
  put_scalars(parcel, attributes);
}

void take_empty(Parcel& parcel, vtkDataSetAttributes& attributes) {
  int count = 0;
  parcel.words >> count;
  for (int i = 0; i < count; ++i) attributes.AddArray(parcel.take());
  take_scalars(parcel, attributes);
}

}  // namespace

bool lies_on(vtkPolyData& output, vtkPolyData& mesh) {
  return output.GetPolys() == mesh.GetPolys() &&
         output.GetNumberOfPoints() == mesh.GetNumberOfPoints() &&
         output.GetNumberOfCells() == mesh.GetNumberOfCells();
}

void put_answer(Parcel& parcel, vtkPolyData& output, const MergedPieces& merged,
                std::size_t piece) {
  const Places& points = merged.points.places[piece];
  const bool moved = output.GetPoints() != merged.mesh->GetPoints();
  parcel.words << (moved ? 1 : 0);
  if (moved) parcel.put(rows_at(*output.GetPoints()->GetData(), points));
  put_changes(parcel, *output.GetPointData(), *merged.mesh->GetPointData(), points);
  put_changes(parcel, *output.GetCellData(), *merged.mesh->GetCellData(), merged.cells[piece]);
  parcel.words << output.GetFieldData()->HasArray(kRestPose);
}

void take_answer(Parcel& parcel, vtkPolyData& piece, vtkPolyData& output) {
  output.ShallowCopy(&piece);
  int moved = 0;
  parcel.words >> moved;
  if (moved == 1) {
    vtkNew<vtkPoints> points;
    points->SetData(parcel.take());
    output.SetPoints(points);
  }
  take_changes(parcel, *output.GetPointData());
  take_changes(parcel, *output.GetCellData());
  int rest_stays = 0;
  parcel.words >> rest_stays;
  if (rest_stays == 0) output.GetFieldData()->RemoveArray(kRestPose);
}

void put_nothing(Parcel& parcel, vtkPolyData& output) {
  put_empty(parcel, *output.GetPointData());
  put_empty(parcel, *output.GetCellData());
}

void take_nothing(Parcel& parcel, vtkPolyData& output) {
  take_empty(parcel, *output.GetPointData());
  take_empty(parcel, *output.GetCellData());
}
