#include "plugins/paraview/mimetra/filters/piece_exchange.h"

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "plugins/paraview/mimetra/filters/piece_answer.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/parameter.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace {

/// Order of the first process to the others.
enum class Order { gather, end };

/// Kind of data that a process has at a port.
enum class Held { mesh, nothing, no_mesh, unreadable };

/// In place of a port: the mesh of an output is on the first process only.
constexpr int kOnFirst = -1;

int number_of(auto value) {
  return static_cast<int>(value);
}

/// Returns whether data are empty, whatever their type. Sources that have data on the first process
/// only leave an object of no particular kind elsewhere.
bool is_nothing(vtkDataObject* data) {
  vtkDataSet* set = vtkDataSet::SafeDownCast(data);
  return !data || data->GetDataObjectType() == VTK_DATA_OBJECT ||
         (set && set->GetNumberOfPoints() == 0 && set->GetNumberOfCells() == 0);
}

std::string class_of(vtkDataObject* data) {
  return data ? data->GetClassName() : "nothing";
}

/// Report of a process on its piece.
struct Report {
  Held held = Held::unreadable;
  std::string type = {};
  bool has_points = false;
  std::vector<double> steps = {};   ///< available times
  std::optional<double> time = {};  ///< time of the piece
};

Report report_of(const Incoming& incoming) {
  vtkPolyData* mesh = vtkPolyData::SafeDownCast(incoming.data);
  Report report{Held::no_mesh, class_of(incoming.data)};
  // If no process has points, an empty surface is refused, as with one process.
  if (mesh) {
    report.held = Held::mesh;
    report.has_points = mesh->GetNumberOfPoints() > 0;
  } else if (is_nothing(incoming.data)) {
    report.held = Held::nothing;
  }
  report.steps = incoming.steps;
  vtkInformation* about = incoming.data ? incoming.data->GetInformation() : nullptr;
  if (about && about->Has(vtkDataObject::DATA_TIME_STEP())) {
    report.time = about->Get(vtkDataObject::DATA_TIME_STEP());
  }
  return report;
}

void put_report(vtkMultiProcessStream& words, const Report& report) {
  words << number_of(report.held) << report.type << number_of(report.has_points);
  put_times(words, report.steps);
  words << number_of(report.time.has_value()) << report.time.value_or(0);
}

Report taken_report(vtkMultiProcessStream& words) {
  Report report;
  int held = 0, has_points = 0, has_time = 0;
  double time = 0;
  words >> held >> report.type >> has_points;
  report.held = static_cast<Held>(held);
  report.has_points = has_points == 1;
  report.steps = taken_times(words);
  words >> has_time >> time;
  if (has_time == 1) report.time = time;
  return report;
}

/// Checks the reported pieces. Throws as input_at() does.
void expect_meshes(const std::vector<Report>& reports, std::optional<double> time) {
  bool any_mesh = false;
  std::string stranger, nothing;
  for (std::size_t process = 0; process < reports.size(); ++process) {
    const std::string& type = reports[process].type;
    switch (reports[process].held) {
      case Held::mesh:
        any_mesh = true;
        break;
      case Held::nothing:
        if (nothing.empty()) nothing = type;
        break;
      case Held::no_mesh:
        if (stranger.empty()) stranger = type;
        break;
      case Held::unreadable:
        throw IoError(time ? "time " + to_text(*time) : "the mesh",
                      "cannot be read by process " + std::to_string(process) +
                          "; the message before tells why");
    }
  }
  if (stranger.empty() && !any_mesh) stranger = nothing;
  if (!stranger.empty()) throw no_mesh_error(stranger);
}

std::string described(const std::vector<double>& steps) {
  if (steps.empty()) return "none";
  return std::to_string(steps.size()) + ", from " + to_text(steps.front()) + " to " +
         to_text(steps.back());
}

/// Time of the mesh, if pieces have one. Throws MismatchError for pieces of different times.
/// Ignores processes without points, except the first, which defines the time steps.
std::optional<double> one_time_of(const std::vector<Report>& reports) {
  const std::vector<double>& steps = reports.front().steps;
  const Report* first = nullptr;  // first report with points and a time
  for (std::size_t process = 0; process < reports.size(); ++process) {
    const Report& report = reports[process];
    if (!report.has_points) continue;
    const std::string name = "process " + std::to_string(process);
    if (report.steps != steps) {
      throw MismatchError("the time steps of " + name + " (" + described(report.steps) +
                          ") are not those of process 0 (" + described(steps) +
                          "); give all processes a series of the same times");
    }
    if (!report.time) continue;
    if (!first) first = &report;
    if (*report.time == *first->time) continue;
    throw MismatchError(name + " has a piece of time " + to_text(*report.time) + ", process " +
                        std::to_string(first - reports.data()) + " of time " +
                        to_text(*first->time) + "; give all processes a series of the same times");
  }
  return first ? first->time : std::nullopt;
}

/// Meshes of an output: at most one, unless the output is a composite.
std::vector<vtkPolyData*> meshes_of(vtkDataObject* output) {
  if (auto* mesh = vtkPolyData::SafeDownCast(output)) return {mesh};
  std::vector<vtkPolyData*> meshes;
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output);
  for (unsigned i = 0; blocks && i < blocks->GetNumberOfBlocks(); ++i) {
    meshes.push_back(vtkPolyData::SafeDownCast(blocks->GetBlock(i)));
  }
  return meshes;
}

void put_blocks(Parcel& parcel, vtkMultiBlockDataSet& blocks) {
  parcel.words << number_of(blocks.GetNumberOfBlocks());
  for (unsigned i = 0; i < blocks.GetNumberOfBlocks(); ++i) {
    const char* name = blocks.GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
    parcel.words << std::string(name ? name : "");
  }
}

/// Makes the blocks, except on the first process, which has them.
void take_blocks(Parcel& parcel, vtkMultiBlockDataSet& blocks) {
  int count = 0;
  parcel.words >> count;
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
    std::string name;
    parcel.words >> name;
    if (blocks.GetBlock(i)) continue;
    vtkNew<vtkPolyData> block;
    blocks.SetBlock(i, block);
    blocks.GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), name.c_str());
  }
}

void put_time(Parcel& parcel, vtkDataObject& output) {
  vtkInformation& about = *output.GetInformation();
  const bool has_time = about.Has(vtkDataObject::DATA_TIME_STEP()) != 0;
  parcel.words << (has_time ? 1 : 0)
               << (has_time ? about.Get(vtkDataObject::DATA_TIME_STEP()) : 0.0);
}

void take_time(Parcel& parcel, vtkDataObject& output) {
  int has_time = 0;
  double time = 0;
  parcel.words >> has_time >> time;
  vtkInformation& about = *output.GetInformation();
  about.Remove(vtkDataObject::DATA_TIME_STEP());
  if (has_time == 1) about.Set(vtkDataObject::DATA_TIME_STEP(), time);
}

}  // namespace

void empty_outputs(vtkInformationVector& outputs) {
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    vtkInformation& asked = *outputs.GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(&outputs, port);
    if (!output) continue;
    output->Initialize();
    vtkInformation& about = *output->GetInformation();
    about.Remove(vtkDataObject::DATA_TIME_STEP());
    if (!asked.Has(Pipeline::UPDATE_TIME_STEP())) continue;
    about.Set(vtkDataObject::DATA_TIME_STEP(), asked.Get(Pipeline::UPDATE_TIME_STEP()));
  }
}

bool PieceExchange::begin(vtkInformation& output) {
  const bool was_in_pieces = in_pieces();
  processes_.reset();
  const int pieces = output.Has(Pipeline::UPDATE_NUMBER_OF_PIECES())
                         ? output.Get(Pipeline::UPDATE_NUMBER_OF_PIECES())
                         : 1;
  if (pieces <= 1) return was_in_pieces;
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  const bool shared =
      controller && controller->GetNumberOfProcesses() == pieces &&
      output.Get(Pipeline::UPDATE_PIECE_NUMBER()) == controller->GetLocalProcessId();
  if (!shared) {
    throw std::invalid_argument(
        "expected a piece of the mesh on each process, found one of " + std::to_string(pieces) +
        " pieces on " + std::to_string(controller ? controller->GetNumberOfProcesses() : 1) +
        " processes; ask for the whole mesh");
  }
  processes_.emplace(*controller);
  return !was_in_pieces;
}

std::optional<std::vector<Parcel>> PieceExchange::gather(int port, std::optional<double> time) {
  Report report;
  vtkPolyData* mesh = nullptr;
  try {
    const Incoming incoming = input_(port, time);
    mesh = vtkPolyData::SafeDownCast(incoming.data);
    report = report_of(incoming);
  } catch (const std::exception&) {
    mesh = nullptr;  // the first process reports this for all
  }
  std::optional<Parcel> parcel;
  try {
    const auto piece = vtkSmartPointer<vtkPolyData>::New();
    if (mesh) piece->ShallowCopy(mesh);
    parcel = packed(*piece);
    vtkMultiProcessStream words;
    put_report(words, report);
    put_words(words, parcel->words);
    parcel->words = words;
    pieces_[port] = piece;
  } catch (const std::bad_alloc&) {
    parcel.reset();
  }
  return processes_->gather(std::move(parcel));
}

vtkDataObject* PieceExchange::input_at(int port, std::optional<double> time) {
  if (!processes_) return input_(port, time).data;
  vtkMultiProcessStream order;
  order << number_of(Order::gather) << port << (time ? 1 : 0) << time.value_or(0);
  processes_->told(order);
  std::optional<std::vector<Parcel>> parcels = gather(port, time);
  if (!parcels) throw std::bad_alloc();
  std::vector<Report> reports;
  for (Parcel& parcel : *parcels) reports.push_back(taken_report(parcel.words));
  expect_meshes(reports, time);
  const std::optional<double> shown = one_time_of(reports);
  Pieces pieces;
  for (Parcel& parcel : *parcels) {
    parcel.words = taken_words(parcel.words);
    pieces.push_back(unpacked(parcel));
  }
  const auto before = merged_.find(port);
  MergedPieces found =
      merged(std::move(pieces), before == merged_.end() ? nullptr : &before->second);
  vtkPolyData* mesh = found.mesh;
  if (shown) mesh->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), *shown);
  merged_[port] = std::move(found);
  return mesh;
}

bool PieceExchange::is_ordered(int port) const {
  const auto found = merged_.find(port);
  return !processes_ || found == merged_.end() || found->second.points.counted;
}

std::size_t PieceExchange::joined(int port) const {
  const auto found = merged_.find(port);
  return !processes_ || found == merged_.end() ? 0 : found->second.points.joined;
}

bool PieceExchange::end(Attempt how, vtkInformationVector& outputs) {
  if (!processes_) return true;
  std::vector<Parcel> parcels;
  std::exception_ptr failure;
  try {
    parcels.resize(static_cast<std::size_t>(processes_->count()));
    for (std::size_t i = 0; how == Attempt::done && i < parcels.size(); ++i) {
      put_outputs(parcels[i], outputs, i);
    }
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  // The others wait for this order, even after a failure.
  vtkMultiProcessStream order;
  order << number_of(Order::end) << number_of(failure ? Attempt::failed : how);
  processes_->told(order);
  const bool is_shared = !failure && how == Attempt::done && share(std::move(parcels), outputs);
  if (!is_shared) empty_outputs(outputs);
  if (failure) std::rethrow_exception(failure);
  return is_shared || how != Attempt::done;
}

Attempt PieceExchange::serve(vtkInformationVector& outputs) {
  for (;;) {
    vtkMultiProcessStream words = processes_->told({});
    int order = 0;
    words >> order;
    if (order == number_of(Order::gather)) {
      int port = 0, has_time = 0;
      double time = 0;
      words >> port >> has_time >> time;
      gather(port, has_time == 1 ? std::optional(time) : std::nullopt);
      continue;
    }
    int how = 0;
    words >> how;
    const auto end = static_cast<Attempt>(how);
    const bool is_shared = end == Attempt::done && share({}, outputs);
    if (!is_shared) empty_outputs(outputs);
    return is_shared || end != Attempt::done ? end : Attempt::failed;
  }
}

bool PieceExchange::share(std::vector<Parcel> parcels, vtkInformationVector& outputs) {
  std::optional<Parcel> mine = processes_->scatter(std::move(parcels));
  if (!mine) return false;
  bool is_taken = false;
  try {
    take_outputs(*mine, outputs);
    is_taken = true;
  } catch (const std::bad_alloc&) {
    is_taken = false;  // the first process reports this for all
  }
  return all(is_taken);
}

void PieceExchange::put_outputs(Parcel& parcel, vtkInformationVector& outputs,
                                std::size_t process) const {
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    vtkDataObject* output = vtkDataObject::GetData(&outputs, port);
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output)) put_blocks(parcel, *blocks);
    for (vtkPolyData* mesh : meshes_of(output)) put_mesh(parcel, *mesh, process);
    put_time(parcel, *output);
  }
}

void PieceExchange::take_outputs(Parcel& parcel, vtkInformationVector& outputs) {
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    vtkDataObject* output = vtkDataObject::GetData(&outputs, port);
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output)) take_blocks(parcel, *blocks);
    for (vtkPolyData* mesh : meshes_of(output)) take_mesh(parcel, *mesh);
    take_time(parcel, *output);
  }
}

void PieceExchange::put_mesh(Parcel& parcel, vtkPolyData& output, std::size_t process) const {
  const auto under = std::ranges::find_if(
      merged_, [&](const auto& each) { return lies_on(output, *each.second.mesh); });
  parcel.words << (under == merged_.end() ? kOnFirst : under->first);
  if (under != merged_.end()) {
    put_answer(parcel, output, under->second, process);
    return;
  }
  if (process > 0) put_nothing(parcel, output);
}

void PieceExchange::take_mesh(Parcel& parcel, vtkPolyData& output) {
  int port = kOnFirst;
  parcel.words >> port;
  if (port != kOnFirst) {
    take_answer(parcel, *pieces_.at(port), output);
  } else if (!is_first()) {
    take_nothing(parcel, output);
  }
}
