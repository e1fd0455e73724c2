#include "vtkMimetraFilter.h"

#include <algorithm>

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "operation_call.h"
#include "time_steps.h"

using namespace mimetra;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace {

/// Changes with everything that the data behind an executive are made of, save the time asked for.
vtkMTimeType changed_at(vtkExecutive* executive) {
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(executive);
  return pipeline ? pipeline->GetPipelineMTime() : 0;
}

std::vector<double> times_of(vtkInformation& info) {
  if (!info.Has(Pipeline::TIME_STEPS())) return {};
  const double* times = info.Get(Pipeline::TIME_STEPS());
  return {times, times + info.Length(Pipeline::TIME_STEPS())};
}

/// Share of the progress in which time steps are read.
constexpr double kReading = 0.3;

}  // namespace

vtkMimetraFilter::vtkMimetraFilter(const char* operation, const char* input, Takes takes)
    : vtkMimetraAlgorithm(std::make_unique<OperationCall>(operation)),
      input_(input),
      takes_(takes),
      steps_(std::make_unique<TimeSteps>()) {}

vtkMimetraFilter::~vtkMimetraFilter() = default;

void vtkMimetraFilter::become(std::unique_ptr<OperationCall> call, const std::string& input) {
  set_call(std::move(call));
  input_ = input;
  has_sequence_ = false;
}

// What is no mesh is refused in RequestData, in words that say what to do about it.
int vtkMimetraFilter::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

int vtkMimetraFilter::RequestInformation(vtkInformation*, vtkInformationVector** inputs,
                                         vtkInformationVector* outputs) {
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port) {
    if (moves(port)) continue;
    outputs->GetInformationObject(port)->Remove(Pipeline::TIME_STEPS());
    outputs->GetInformationObject(port)->Remove(Pipeline::TIME_RANGE());
  }
  const vtkMTimeType changed = input_changed_at(0);
  if (takes_ == Takes::shown_time_step || (has_sequence_ && changed == collected_at_)) return 1;
  steps_->begin(times_of(*inputs[0]->GetInformationObject(0)));
  collecting_ = true;
  has_sequence_ = false;
  collected_at_ = changed;
  return 1;
}

int vtkMimetraFilter::RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                                          vtkInformationVector* outputs) {
  vtkInformation* in = inputs[0]->GetInformationObject(0);
  const std::vector<double> times = times_of(*in);
  if (times.empty()) return 1;
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  vtkInformation* out = outputs->GetInformationObject(port);
  // What stands still is made of the first time step, whatever is shown beside it.
  const bool is_asked = out->Has(Pipeline::TIME_STEPS()) && out->Has(Pipeline::UPDATE_TIME_STEP());
  asked_time_ = is_asked ? out->Get(Pipeline::UPDATE_TIME_STEP()) : times.front();
  const auto next = collecting_ ? steps_->next_time() : std::nullopt;
  in->Set(Pipeline::UPDATE_TIME_STEP(), next.value_or(asked_time_));
  return 1;
}

int vtkMimetraFilter::RequestData(vtkInformation* request, vtkInformationVector** inputs,
                                  vtkInformationVector* outputs) {
  if (!request->Has(Pipeline::CONTINUE_EXECUTING())) begin_execution();
  vtkDataObject* data = vtkDataObject::GetData(inputs[0]);
  if (takes_ == Takes::shown_time_step) {
    steps_->begin({});
    collecting_ = true;
    has_sequence_ = false;
  }
  if (collecting_ && !take(data)) {
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  if (has_sequence_) compute_and_show(data, inputs, outputs);
  return 1;
}

bool vtkMimetraFilter::take(vtkDataObject* data) {
  const Attempt attempted = attempt([&] {
    steps_->add(data);
    if (!show_progress(kReading * steps_->share())) throw Cancelled();
  });
  if (attempted == Attempt::aborted) steps_->begin(steps_->times());
  if (attempted == Attempt::failed) collecting_ = false;
  if (attempted != Attempt::done) return true;
  if (!steps_->complete()) return false;
  collecting_ = false;
  has_sequence_ = true;
  call().give(input_, {input_, SequenceRead{steps_->sequence(), false, {}, {}}});
  const std::vector<double>& times = steps_->times();
  return times.empty() || steps_->nearest(asked_time_) == static_cast<int>(times.size()) - 1;
}

void vtkMimetraFilter::compute_and_show(vtkDataObject* data, vtkInformationVector** inputs,
                                        vtkInformationVector* outputs) {
  const vtkMTimeType now = changed_at(GetExecutive());
  if (failed_at_ == now && takes_ == Takes::all_time_steps) return;
  const Attempt attempted = attempt([&] {
    give_further_inputs(inputs);
    const bool has_time = data->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP());
    const double time =
        has_time ? data->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()) : asked_time_;
    const Outcome& computed = outcome(kReading);
    vtkPolyData& mesh = mesh_of(data);
    if (prepared_at_ != now) prepare(computed, mesh);
    prepared_at_ = now;
    show(computed, mesh, steps_->nearest(time), outputs);
  });
  failed_at_ = attempted == Attempt::failed ? now : 0;
}

vtkMTimeType vtkMimetraFilter::input_changed_at(int port) {
  return GetNumberOfInputConnections(port) == 0 ? 0 : changed_at(GetInputExecutive(port, 0));
}

void vtkMimetraFilter::give_further_inputs(vtkInformationVector**) {}

bool vtkMimetraFilter::moves(int port) const {
  return port == 0;
}

void vtkMimetraFilter::prepare(const Outcome&, vtkPolyData&) {}
