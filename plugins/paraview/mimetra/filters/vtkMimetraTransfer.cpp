#include "plugins/paraview/mimetra/filters/vtkMimetraTransfer.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkTable.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/operation.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraTransfer);

vtkMimetraTransfer::vtkMimetraTransfer() : vtkMimetraFilter("transfer") {
  SetNumberOfOutputPorts(2);
}

int vtkMimetraTransfer::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPolyData" : "vtkTable");
  return 1;
}

std::vector<std::string> vtkMimetraTransfer::wanted_outputs(const Invocation& invocation) {
  const BlendshapeModel& model = invocation.get<ModelData>("target").model.average();
  std::vector<std::string> wanted;
  const bool full = invocation.parameters.flag("full");
  if (!full) wanted.push_back("regions-out");
  const bool painted = invocation.parameters.optional_text("paint").has_value();
  if (!full && !painted && !invocation.inputs.contains("regions")) {
    wanted.push_back("components-out");
  }
  if (!solves_for_vertices(invocation.parameters, model)) {
    wanted.push_back("weights-out");
  }
  return wanted;
}

vtkPolyData& vtkMimetraTransfer::shown_mesh(vtkPolyData& input) const {
  vtkPolyData* target = mesh_at(1);
  return target ? *target : input;
}

void vtkMimetraTransfer::prepare(const Outcome& outcome, vtkPolyData& input) {
  fields_->Initialize();
  const auto regions = outcome.outputs.find("regions-out");
  if (regions == outcome.outputs.end()) return;
  const FieldSequence& shown = std::get<RegionData>(regions->second.front().data).fields;
  make_fields(*fields_, shown_mesh(input), shown.fields, shown.sequence().connectivity());
}

void vtkMimetraTransfer::show(const Outcome& outcome, vtkPolyData& input, double time,
                              vtkInformationVector* outputs) {
  const auto& result = std::get<FieldSequence>(outcome.outputs.at("out").front().data).sequence();
  vtkPolyData* output = vtkPolyData::GetData(outputs, 0);
  show_frame(*output, shown_mesh(input), result, frame_at(result, time));
  share_fields(*fields_, *output);
  const auto weights = outcome.outputs.find("weights-out");
  if (weights != outcome.outputs.end()) {
    fill(*vtkTable::GetData(outputs, 1), std::get<Table>(weights->second.front().data));
  }
}
