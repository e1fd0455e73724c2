#include "vtkMimetraTransfer.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <mimetra/operations/operation.h>
#include <mimetra/vtk/poly_data.h>

#include "host_output.h"
#include "operation_call.h"
#include "time_steps.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraTransfer);

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
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (vtkInformation* target = inputs[1]->GetInformationObject(0)) {
    // A target is one mesh: of a series, the first.
    if (target->Has(Pipeline::TIME_STEPS())) {
      target->Set(Pipeline::UPDATE_TIME_STEP(), target->Get(Pipeline::TIME_STEPS())[0]);
    } else {
      target->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  return Superclass::RequestUpdateExtent(request, inputs, outputs);
}

void vtkMimetraTransfer::give_further_inputs(vtkInformationVector** inputs) {
  // ParaView asks for a mesh at the port even where the target is a file.
  const vtkMTimeType changed = call().is_set("target") ? 0 : input_changed_at(1);
  if (changed == 0) {
    target_ = nullptr;
    call().take_back("target");
  } else if (changed != given_at_) {
    target_ = &mesh_of(vtkDataObject::GetData(inputs[1]));
    Positions positions = positions_of(*target_, "the target");
    auto connectivity = std::make_shared<Connectivity>(connectivity_of(*target_, "the target"));
    ShapeBasis none{{}, Eigen::MatrixXd(positions.size(), 0)};
    call().give("target", {"the target", BlendshapeModel(std::move(connectivity),
                                                         std::move(positions), std::move(none))});
  }
  given_at_ = changed;
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
  if (invocation.parameters.text("space") != "vertex" && model.expressions().size() > 0) {
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

void vtkMimetraTransfer::show(const Outcome& outcome, vtkPolyData& input, int frame,
                              vtkInformationVector* outputs) {
  const auto& result = std::get<SequenceRead>(outcome.outputs.at("out").front().data).sequence;
  vtkPolyData* output = vtkPolyData::GetData(outputs, 0);
  show_shape(*output, target_ ? *target_ : input, result.frame(frame));
  if (result.rest_is_known()) {
    set_rest(*output, result.rest());
    add_displacement(*output, result.frame(frame) - result.rest());
  }
  share_fields(*fields_, *output);
  const auto weights = outcome.outputs.find("weights-out");
  if (weights != outcome.outputs.end()) {
    fill(*vtkTable::GetData(outputs, 1), std::get<Table>(weights->second.front().data));
  }
}
