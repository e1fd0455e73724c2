#include "plugins/paraview/mimetra/filters/vtkMimetraTransfer.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/operation.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkMimetraTransfer);

namespace {

/// A target is one mesh: of a series, the first.
std::optional<double> first_time_of(vtkInformation& info) {
  if (!info.Has(Pipeline::TIME_STEPS())) return {};
  return info.Get(Pipeline::TIME_STEPS())[0];
}

BlendshapeModel model_of(vtkPolyData& mesh) {
  Positions positions = positions_of(mesh, "the target");
  auto connectivity = std::make_shared<Connectivity>(connectivity_of(mesh, "the target"));
  ShapeBasis none{{}, Eigen::MatrixXd(positions.size(), 0)};
  return {std::move(connectivity), std::move(positions), std::move(none)};
}

}  // namespace

vtkMimetraTransfer::vtkMimetraTransfer() : vtkMimetraFilter("transfer", "source") {
  SetNumberOfInputPorts(2);
  SetNumberOfOutputPorts(2);
}

int vtkMimetraTransfer::FillInputPortInformation(int port, vtkInformation* info) {
  if (port == 1) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return Superclass::FillInputPortInformation(port, info);
}

int vtkMimetraTransfer::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPolyData" : "vtkTable");
  return 1;
}

int vtkMimetraTransfer::RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                                            vtkInformationVector* outputs) {
  if (vtkInformation* target = inputs[1]->GetInformationObject(0)) {
    const auto time = first_time_of(*target);
    if (time) {
      target->Set(Pipeline::UPDATE_TIME_STEP(), *time);
    } else {
      target->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return Superclass::RequestUpdateExtent(request, inputs, outputs);
}

void vtkMimetraTransfer::give_further_inputs(vtkInformationVector** inputs) {
  // ParaView asks for a mesh at the port even where the target is a file.
  const Origin origin = call().is_set("target") ? Origin() : origin_of(1);
  if (given_ == origin) return;
  given_.reset();
  target_ = nullptr;
  if (origin == Origin()) {
    call().take_back("target");
  } else {
    // A copy, because the target may be the source too, which moves on.
    target_ = vtkSmartPointer<vtkPolyData>::New();
    target_->ShallowCopy(&mesh_of(input_at(1, first_time_of(*inputs[1]->GetInformationObject(0)))));
    call().give("target", {"the target", model_of(*target_)});
  }
  given_ = origin;
}

std::vector<std::string> vtkMimetraTransfer::wanted_outputs(const Invocation& invocation) {
  if (!invocation.inputs.contains("target")) {
    throw UsageError("expected a target: a mesh at the port Target, or a model as Target File");
  }
  const auto& model = invocation.get<BlendshapeModel>("target");
  std::vector<std::string> wanted;
  const bool full = invocation.parameters.flag("full");
  if (!full) wanted.push_back("regions-out");
  if (!full && !invocation.inputs.contains("regions")) wanted.push_back("components-out");
  if (!solves_for_vertices(invocation.parameters, model)) {
    wanted.push_back("weights-out");
  }
  return wanted;
}

void vtkMimetraTransfer::prepare(const Outcome& outcome, vtkPolyData& input) {
  fields_->Initialize();
  const auto regions = outcome.outputs.find("regions-out");
  if (regions == outcome.outputs.end()) return;
  const FieldSequence& shown = std::get<RegionData>(regions->second.front().data).fields;
  make_fields(*fields_, target_ ? *target_ : input, shown.fields, shown.sequence.connectivity());
}

void vtkMimetraTransfer::show(const Outcome& outcome, vtkPolyData& input, double time,
                              vtkInformationVector* outputs) {
  const auto& result = std::get<SequenceRead>(outcome.outputs.at("out").front().data).sequence;
  vtkPolyData* output = vtkPolyData::GetData(outputs, 0);
  show_frame(*output, target_ ? *target_ : input, result, frame_at(result, time));
  share_fields(*fields_, *output);
  const auto weights = outcome.outputs.find("weights-out");
  if (weights != outcome.outputs.end()) {
    fill(*vtkTable::GetData(outputs, 1), std::get<Table>(weights->second.front().data));
  }
}
