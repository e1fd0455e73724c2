#include "plugins/paraview/mimetra/filters/vtkMimetraSequence.h"

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/reading.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;
using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkMimetraSequence);

namespace {

const FieldSequence& sequence_of(const Outcome& outcome) {
  return std::get<FieldSequence>(outcome.outputs.at("out").front().data);
}

}  // namespace

vtkMimetraSequence::vtkMimetraSequence()
    : vtkMimetraAlgorithm(std::make_unique<OperationCall>(reading_operation())) {
  SetNumberOfInputPorts(0);
}

void vtkMimetraSequence::read() {
  const FieldSequence& read = sequence_of(outcome());
  make_mesh(*mesh_, read.sequence(), read.fields);
}

int vtkMimetraSequence::RequestInformation(vtkInformation*, vtkInformationVector**,
                                           vtkInformationVector* outputs) {
  begin_execution();
  if (read_at_ != GetMTime()) attempt([this] { read(); });
  read_at_ = GetMTime();
  vtkInformation* out = outputs->GetInformationObject(0);
  if (!call().is_done() || sequence_of(call().outcome()).sequence().frames() == 1) {
    out->Remove(Pipeline::TIME_STEPS());
    out->Remove(Pipeline::TIME_RANGE());
    return 1;
  }
  const Eigen::VectorXd& times = sequence_of(call().outcome()).sequence().times();
  const int count = static_cast<int>(times.size());
  const double range[] = {times[0], times[count - 1]};
  out->Set(Pipeline::TIME_STEPS(), times.data(), count);
  out->Set(Pipeline::TIME_RANGE(), range, 2);
  return 1;
}

int vtkMimetraSequence::RequestData(vtkInformation*, vtkInformationVector**,
                                    vtkInformationVector* outputs) {
  if (!call().is_done()) return 1;
  const MeshSequence& sequence = sequence_of(call().outcome()).sequence();
  vtkInformation* out = outputs->GetInformationObject(0);
  const bool is_asked = out->Has(Pipeline::UPDATE_TIME_STEP());
  const int frame = is_asked ? frame_at(sequence, out->Get(Pipeline::UPDATE_TIME_STEP())) : 0;
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  output->ShallowCopy(mesh_);
  set_positions(*output, sequence.frame(frame), Precision::double_precision);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), sequence.times()[frame]);
  return 1;
}
