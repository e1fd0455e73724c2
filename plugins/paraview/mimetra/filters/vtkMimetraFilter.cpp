#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

#include <algorithm>

#include <vtkAlgorithmOutput.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessStream.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "plugins/paraview/mimetra/filters/filter_proxies.h"
#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/piece_exchange.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace {

/// Modification time of the data behind an executive, apart from the requested time.
vtkMTimeType changed_at(vtkExecutive* executive) {
  auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(executive);
  return pipeline ? pipeline->GetPipelineMTime() : 0;
}

std::vector<double> times_of(vtkInformation& info,
                             vtkInformationDoubleVectorKey* key = Pipeline::TIME_STEPS()) {
  if (!info.Has(key)) return {};
  const double* times = info.Get(key);
  return {times, times + info.Length(key)};
}

void set_key(vtkInformation& output, vtkInformationDoubleVectorKey* key,
             const std::vector<double>& times) {
  output.Remove(key);
  if (!times.empty()) output.Set(key, times.data(), static_cast<int>(times.size()));
}

/// Time to show: the requested time if the output has time steps, else the first time step. None
/// for a static input.
std::optional<double> asked_time(vtkInformation& in, vtkInformation& out) {
  const std::vector<double> times = times_of(in);
  if (times.empty()) return {};
  const bool is_asked = out.Has(Pipeline::TIME_STEPS()) && out.Has(Pipeline::UPDATE_TIME_STEP());
  return is_asked ? out.Get(Pipeline::UPDATE_TIME_STEP()) : times.front();
}

/// First time of a series, because a model is a single mesh.
std::optional<double> first_time_of(vtkInformation& info) {
  if (!info.Has(Pipeline::TIME_STEPS())) return {};
  return info.Get(Pipeline::TIME_STEPS())[0];
}

ModelData model_of(vtkPolyData& mesh, const std::string& name) {
  Positions positions = positions_of(mesh, name);
  auto connectivity = std::make_shared<Connectivity>(connectivity_of(mesh, name));
  ShapeBasis none{{}, Eigen::MatrixXd(positions.size(), 0)};
  return {MorphableModel(
      BlendshapeModel(std::move(connectivity), std::move(positions), std::move(none)))};
}

/// Throws std::invalid_argument if the data are continuous over a range of time.
void refuse_continuous(vtkInformation& in) {
  if (in.Has(Pipeline::TIME_STEPS()) || !in.Has(Pipeline::TIME_RANGE())) return;
  const double* range = in.Get(Pipeline::TIME_RANGE());
  if (range[0] == range[1]) return;
  throw std::invalid_argument("expected time steps, found a range of time from " +
                              to_text(range[0]) + " to " + to_text(range[1]) +
                              "; save it as a series of files first");
}

/// Share of the progress for reading time steps.
constexpr double kReading = 0.3;

}  // namespace

vtkMimetraFilter::vtkMimetraFilter(const char* operation, Takes takes)
    : vtkMimetraAlgorithm(std::make_unique<OperationCall>(operation)),
      takes_(takes),
      exchange_(std::make_unique<PieceExchange>(
          [this](int port, std::optional<double> time) { return input_at(port, time); },
          [this](int port) { return times_of(*GetInputInformation(port, 0)); })),
      steps_(std::make_unique<TimeSteps>()) {
  name_inputs();
}

vtkMimetraFilter::~vtkMimetraFilter() = default;

void vtkMimetraFilter::become(std::unique_ptr<OperationCall> call) {
  if (!piped_input(call->operation())) {
    throw std::invalid_argument(call->operation().name + ": begins with no mesh");
  }
  set_call(std::move(call));
  name_inputs();
  forget_inputs();
}

void vtkMimetraFilter::name_inputs() {
  input_ = piped_input(call().operation())->name;
  mesh_ports_.clear();
  for (const std::string& name : mesh_inputs(call().operation())) mesh_ports_.push_back({name});
  SetNumberOfInputPorts(1 + static_cast<int>(mesh_ports_.size()));
}

// RequestData refuses data that are not a mesh, with a message that says what to do.
int vtkMimetraFilter::FillInputPortInformation(int port, vtkInformation* info) {
  if (port > 0) info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

// Not collective: if only one process's input changed, only that process calls this.
int vtkMimetraFilter::RequestInformation(vtkInformation*, vtkInformationVector**,
                                         vtkInformationVector* outputs) {
  set_times(*outputs, times_.value_or(input_times()));
  return 1;
}

vtkMimetraFilter::Times vtkMimetraFilter::input_times() {
  vtkInformation& in = *GetInputInformation(0, 0);
  return {times_of(in), times_of(in, Pipeline::TIME_RANGE())};
}

void vtkMimetraFilter::set_times(vtkInformationVector& outputs, const Times& times) const {
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    const Times shown = moves(port) ? times : Times();
    set_key(*outputs.GetInformationObject(port), Pipeline::TIME_STEPS(), shown.steps);
    set_key(*outputs.GetInformationObject(port), Pipeline::TIME_RANGE(), shown.range);
  }
}

int vtkMimetraFilter::RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                                          vtkInformationVector* outputs) {
  vtkInformation* in = inputs[0]->GetInformationObject(0);
  const auto time = asked_time(*in, *outputs->GetInformationObject(0));
  if (time) in->Set(Pipeline::UPDATE_TIME_STEP(), *time);
  for (int port = 1; port < GetNumberOfInputPorts(); ++port) {
    vtkInformation* mesh = inputs[port]->GetInformationObject(0);
    if (!mesh) continue;
    if (const auto first = first_time_of(*mesh)) {
      mesh->Set(Pipeline::UPDATE_TIME_STEP(), *first);
    } else {
      mesh->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  const int port = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  begun_ = begin_request(*outputs->GetInformationObject(port), *outputs);
  // A process whose input fails may not be asked for data.
  if (!begun_) empty_outputs(*outputs);
  return 1;
}

// This happens before RequestData, because VTK does not ask a process for data if its input fails.
// All others would wait for it. VTK asks that process again at the next update, so all processes
// must be asked again.
bool vtkMimetraFilter::begin_request(vtkInformation& output, vtkInformationVector& outputs) {
  bool begun = false;
  attempt([&] {
    if (exchange_->begin(output)) forget_inputs();
    // All processes wait here, even if one failed.
    const bool updated = !exchange_->in_pieces() || update_inputs();
    begun = exchange_->all(updated);
    const bool knew = exchange_->all(learn_times(outputs));
    failed_ = begun ? std::nullopt : std::optional(asked());
    if (!begun || !knew) begin_anew();
    if (!begun && updated && exchange_->is_first()) {
      throw IoError("the input", "cannot be read by another process, whose message tells why");
    }
  });
  return begun;
}

// VTK and later filters never ask a process for another time if it knows no times.
bool vtkMimetraFilter::learn_times(vtkInformationVector& outputs) {
  const Times known = times_.value_or(input_times());
  vtkMultiProcessStream words;
  put_times(words, known.steps);
  put_times(words, known.range);
  words = exchange_->told(words);
  times_.reset();
  if (exchange_->is_first()) return true;
  Times& told = times_.emplace();
  told.steps = taken_times(words);
  told.range = taken_times(words);
  set_times(outputs, told);
  return told == known;
}

// VTK treats a failed update as done: the same request then succeeds without data.
bool vtkMimetraFilter::update_inputs() {
  bool updated = failed_ != asked();
  const Attempt attempted = attempt([&] {
    for (int port = 0; port < GetNumberOfInputPorts(); ++port) {
      if (GetNumberOfInputConnections(port) == 0) continue;
      const int index = GetInputConnection(port, 0)->GetIndex();
      if (!GetInputExecutive(port, 0)->Update(index)) updated = false;
    }
  });
  return updated && attempted == Attempt::done;
}

std::vector<vtkMimetraFilter::Asked> vtkMimetraFilter::asked() {
  std::vector<Asked> all;
  for (int port = 0; port < GetNumberOfInputPorts(); ++port) {
    Asked& each = all.emplace_back(origin_of(port));
    if (GetNumberOfInputConnections(port) == 0) continue;
    vtkInformation& info = *GetInputInformation(port, 0);
    if (!info.Has(Pipeline::UPDATE_TIME_STEP())) continue;
    each.time = info.Get(Pipeline::UPDATE_TIME_STEP());
  }
  return all;
}

void vtkMimetraFilter::forget_inputs() {
  collected_.reset();
  for (MeshPort& each : mesh_ports_) each.given.reset();
}

int vtkMimetraFilter::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                  vtkInformationVector* outputs) {
  begin_execution();
  compute_or_serve(inputs, outputs);
  end_anew();
  return 1;
}

void vtkMimetraFilter::compute_or_serve(vtkInformationVector** inputs,
                                        vtkInformationVector* outputs) {
  if (!begun_) {
    empty_outputs(*outputs);
    return;
  }
  if (!exchange_->is_first()) {
    attempt([&] {
      if (exchange_->serve(*outputs) == Attempt::aborted) throw Cancelled();
    });
    return;
  }
  const vtkMTimeType now = changed_at(GetExecutive());
  const bool fails_again = failed_at_ == now && takes_ == Takes::all_time_steps;
  const Attempt attempted = fails_again ? Attempt::failed : attempt([&] {
    vtkInformation& in = *inputs[0]->GetInformationObject(0);
    const auto time = asked_time(in, *outputs->GetInformationObject(0));
    give_meshes(inputs);
    collect(in, time);
    compute_and_show(time, outputs);
  });
  failed_at_ = attempted == Attempt::failed ? now : 0;
  attempt([&] { exchange_->end(attempted, *outputs); });
}

void vtkMimetraFilter::collect(vtkInformation& in, std::optional<double> shown) {
  const bool all = takes_ == Takes::all_time_steps;
  const Origin origin = origin_of(0);
  if (all && collected_ == origin) return;
  collected_.reset();
  if (all) refuse_continuous(in);
  steps_->begin(all ? times_of(in) : std::vector<double>(), call().looks_at_fields(input_));
  while (!steps_->complete()) {
    steps_->add(exchange_->input_at(0, "the mesh", all ? steps_->next_time() : shown));
    if (!show_progress(kReading * steps_->share())) throw Cancelled();
  }
  call().give(input_, {input_, steps_->taken()});
  for (const std::string& note : steps_->notes()) vtkWarningMacro(<< input_ << ": " << note);
  collected_ = origin;
}

void vtkMimetraFilter::tell_of_lost_arrays(vtkPolyData& input, vtkInformationVector& outputs) {
  vtkPolyData* output = vtkPolyData::GetData(&outputs, 0);
  if (!output) return;
  std::set<std::string> lost;
  const auto look_at = [&](vtkPolyData& mesh) {
    if (lies_on(*output, mesh)) lost.merge(lost_arrays(mesh, *output));
  };
  look_at(input);
  for (const MeshPort& each : mesh_ports_) {
    if (each.mesh) look_at(*each.mesh);
  }
  if (steps_->are_displaced()) {
    for (const char* own : {kDisplacement, kDisplacementLength}) lost.erase(own);
  }
  if (lost == told_lost_) return;
  told_lost_ = lost;
  if (lost.empty()) return;
  vtkWarningMacro(<< "arrays of the input that are not passed on: "
                  << joined({lost.begin(), lost.end()})
                  << "; the output has its own of that name, or is another shape. To keep one, "
                     "give it another name before (Calculator)");
}

void vtkMimetraFilter::compute_and_show(std::optional<double> time, vtkInformationVector* outputs) {
  const Outcome& computed = outcome(kReading);
  // Other filters that share the input may have left it at another time.
  vtkPolyData& mesh = mesh_of(exchange_->input_at(0, "the mesh", time));
  steps_->expect_counts_of(mesh, time);
  const vtkMTimeType now = changed_at(GetExecutive());
  const std::array cells = {mesh.GetNumberOfVerts(), mesh.GetNumberOfLines(),
                            mesh.GetNumberOfCells()};
  if (prepared_at_ != now || prepared_cells_ != cells) prepare(computed, mesh);
  prepared_at_ = now;
  prepared_cells_ = cells;
  vtkInformation* about = mesh.GetInformation();
  const bool has_time = about->Has(vtkDataObject::DATA_TIME_STEP());
  const double shown = has_time ? about->Get(vtkDataObject::DATA_TIME_STEP()) : time.value_or(0);
  show(computed, mesh, shown, outputs);
  tell_of_lost_arrays(mesh, *outputs);
  // An output with time steps has the input's time, whatever it is made of.
  if (!moves(0)) return;
  vtkDataObject::GetData(outputs, 0)
      ->GetInformation()
      ->CopyEntry(about, vtkDataObject::DATA_TIME_STEP());
}

vtkMimetraFilter::Origin vtkMimetraFilter::origin_of(int port) {
  if (GetNumberOfInputConnections(port) == 0) return {};
  return {GetInputConnection(port, 0), changed_at(GetInputExecutive(port, 0))};
}

vtkDataObject* vtkMimetraFilter::input_at(int port, std::optional<double> time) {
  if (time) {
    vtkExecutive* upstream = GetInputExecutive(port, 0);
    const int index = GetInputConnection(port, 0)->GetIndex();
    upstream->GetOutputInformation(index)->Set(Pipeline::UPDATE_TIME_STEP(), *time);
    const std::vector<Asked> asked_now = asked();
    if (failed_ == asked_now || !upstream->Update(index)) {
      failed_ = asked_now;
      throw IoError("time " + to_text(*time), "cannot be read; the message before tells why");
    }
  }
  return GetInputDataObject(port, 0);
}

void vtkMimetraFilter::give_meshes(vtkInformationVector** inputs) {
  int port = 0;
  for (MeshPort& each : mesh_ports_) {
    ++port;
    // ParaView asks for a mesh at the port even if the input is a file.
    const Origin origin = call().is_set(each.input) ? Origin() : origin_of(port);
    if (each.given == origin) continue;
    each.given.reset();
    each.mesh = nullptr;
    if (origin == Origin()) {
      call().take_back(each.input);
    } else {
      // Copy the mesh, because it may also be the first input, whose time changes.
      const std::string name = "the " + each.input;
      const auto first = first_time_of(*inputs[port]->GetInformationObject(0));
      each.mesh = vtkSmartPointer<vtkPolyData>::New();
      each.mesh->ShallowCopy(&mesh_of(exchange_->input_at(port, name, first)));
      call().give(each.input, {name, model_of(*each.mesh, name)});
    }
    each.given = origin;
  }
}

vtkPolyData* vtkMimetraFilter::mesh_at(int port) const {
  return mesh_ports_.at(static_cast<std::size_t>(port - 1)).mesh;
}

bool vtkMimetraFilter::moves(int port) const {
  return port == 0;
}

void vtkMimetraFilter::prepare(const Outcome&, vtkPolyData&) {}
