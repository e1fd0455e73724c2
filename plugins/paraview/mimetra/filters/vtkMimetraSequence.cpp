#include "plugins/paraview/mimetra/filters/vtkMimetraSequence.h"

#include <optional>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/processes.h"
#include "plugins/paraview/mimetra/filters/reading.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/mesh/errors.h"
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

std::vector<double> vtkMimetraSequence::read() {
  const FieldSequence& read = sequence_of(outcome());
  make_mesh(*mesh_, read.sequence(), read.fields);
  const Eigen::VectorXd& times = read.sequence().times();
  if (read.sequence().frames() == 1) return {};
  return {times.begin(), times.end()};
}

void vtkMimetraSequence::read_by_first() {
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  std::optional<Processes> processes;
  if (controller && controller->GetNumberOfProcesses() > 1) processes.emplace(*controller);
  times_.clear();
  Attempt attempted = Attempt::done;
  if (!processes || processes->is_first()) attempted = attempt([this] { times_ = read(); });
  if (!processes) return;
  vtkMultiProcessStream words;
  words << static_cast<int>(attempted);
  put_times(words, times_);
  words = processes->told(words);
  if (processes->is_first()) return;
  int how = 0;
  words >> how;
  times_ = taken_times(words);
  attempt([how] {
    if (static_cast<Attempt>(how) == Attempt::aborted) throw Cancelled();
  });
}

int vtkMimetraSequence::RequestInformation(vtkInformation*, vtkInformationVector**,
                                           vtkInformationVector* outputs) {
  begin_execution();
  if (read_at_ != GetMTime()) read_by_first();
  read_at_ = GetMTime();
  vtkInformation* out = outputs->GetInformationObject(0);
  if (times_.empty()) {
    out->Remove(Pipeline::TIME_STEPS());
    out->Remove(Pipeline::TIME_RANGE());
    return 1;
  }
  const double range[] = {times_.front(), times_.back()};
  out->Set(Pipeline::TIME_STEPS(), times_.data(), static_cast<int>(times_.size()));
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
