#include "plugins/paraview/mimetra/filters/host_output.h"

#include <limits>

#include <nlohmann/json.hpp>

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include "toolkit/operations/reports.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

namespace {

/// ParaView's charts put this column on the x axis and do not plot it as a curve.
constexpr const char* kTime = "Time";

void remove_normals(vtkDataSetAttributes& attributes) {
  vtkDataArray* normals = attributes.GetNormals();
  if (normals && normals->GetName()) attributes.RemoveArray(normals->GetName());
}

void add_lost(std::set<std::string>& lost, vtkDataSetAttributes& given,
              vtkDataSetAttributes& made) {
  for (int i = 0; i < given.GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = given.GetAbstractArray(i);
    if (!array->GetName() || array == given.GetNormals()) continue;
    if (made.GetAbstractArray(array->GetName()) != array) lost.insert(array->GetName());
  }
}

}  // namespace

void show_shape(vtkPolyData& output, vtkPolyData& input, const Positions& shape) {
  output.ShallowCopy(&input);
  remove_normals(*output.GetPointData());
  remove_normals(*output.GetCellData());
  output.GetPointData()->RemoveArray(kDisplacement);
  output.GetPointData()->RemoveArray(kDisplacementLength);
  set_rest(output, {});
  set_positions(output, shape, Precision::double_precision);
}

void show_frame(vtkPolyData& output, vtkPolyData& input, const MeshSequence& sequence, int frame) {
  show_shape(output, input, sequence.frame(frame));
  if (!sequence.rest_is_known()) return;
  set_rest(output, sequence.rest());
  add_displacement(output, sequence.frame(frame) - sequence.rest());
}

void make_mesh(vtkPolyData& mesh, const MeshSequence& sequence, const std::vector<Field>& fields) {
  mesh.Initialize();
  set_polygons(mesh, sequence.connectivity());
  for (const Field& field : fields) add_field(mesh, field, sequence.connectivity());
  set_rest(mesh, sequence.rest_is_known() ? std::optional(sequence.rest()) : std::nullopt);
}

void show_mesh(vtkPolyData& output, vtkPolyData& mesh, const MeshSequence& sequence, int frame) {
  output.ShallowCopy(&mesh);
  set_positions(output, sequence.frame(frame), Precision::double_precision);
  // A field of that name comes from the operation.
  const bool has_one = output.GetPointData()->HasArray(kDisplacement) != 0;
  if (sequence.rest_is_known() && !has_one) {
    add_displacement(output, sequence.frame(frame) - sequence.rest());
  }
}

void make_fields(vtkPolyData& holder, vtkPolyData& mesh, const std::vector<Field>& fields,
                 const Connectivity& connectivity) {
  holder.Initialize();
  holder.CopyStructure(&mesh);
  for (const Field& field : fields) add_field(holder, field, connectivity);
}

void share_fields(vtkPolyData& holder, vtkPolyData& output) {
  const auto share = [](vtkDataSetAttributes& from, vtkDataSetAttributes& to) {
    for (int i = 0; i < from.GetNumberOfArrays(); ++i) to.AddArray(from.GetAbstractArray(i));
    // ParaView first colours a mesh by its active scalars.
    if (!to.GetScalars() && from.GetScalars()) to.SetActiveScalars(from.GetScalars()->GetName());
  };
  share(*holder.GetPointData(), *output.GetPointData());
  share(*holder.GetCellData(), *output.GetCellData());
}

std::set<std::string> lost_arrays(vtkPolyData& input, vtkPolyData& output) {
  std::set<std::string> lost;
  add_lost(lost, *input.GetPointData(), *output.GetPointData());
  add_lost(lost, *input.GetCellData(), *output.GetCellData());
  for (const char* own : {kRestPose, kPlaced}) lost.erase(own);
  return lost;
}

void fill(vtkTable& output, const Table& table) {
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    vtkNew<vtkDoubleArray> values;
    const std::string& name = table.columns[column];
    values->SetName(name == "time" ? kTime : name.c_str());
    for (const auto& row : table.rows) {
      values->InsertNextValue(row[column].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    output.AddColumn(values);
  }
  if (table.word_column.empty()) return;
  vtkNew<vtkStringArray> words;
  words->SetName(table.word_column.c_str());
  for (const std::string& word : table.words) words->InsertNextValue(word);
  output.AddColumn(words);
}

void fill(vtkTable& output, const std::string& report) {
  vtkNew<vtkStringArray> names;
  vtkNew<vtkStringArray> values;
  names->SetName("name");
  values->SetName("value");
  const Json members = Json::parse(report);
  for (const auto& [name, value] : members.items()) {
    names->InsertNextValue(name);
    values->InsertNextValue(value.is_string() ? value.get<std::string>() : value.dump());
  }
  output.AddColumn(names);
  output.AddColumn(values);
}
