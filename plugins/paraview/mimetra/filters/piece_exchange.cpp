#include "plugins/paraview/mimetra/filters/piece_exchange.h"

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"

using namespace mimetra;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace {

/// Order of the first process to the others, in place of a port whose pieces it gathers.
constexpr int kEnd = -1;

int taken_number(vtkMultiProcessStream& words) {
  int number = 0;
  words >> number;
  return number;
}

/// Returns whether data are empty, whatever their type. Sources that have data on the first process
/// only leave an object of no particular kind on the others.
bool is_nothing(vtkDataObject* data) {
  auto* set = vtkDataSet::SafeDownCast(data);
  return !data || data->GetDataObjectType() == VTK_DATA_OBJECT ||
         (set && set->GetNumberOfPoints() == 0 && set->GetNumberOfCells() == 0);
}

/// Time under a key: none or one.
std::vector<double> time_in(vtkInformation& info, vtkInformationDoubleKey* key) {
  if (!info.Has(key)) return {};
  return {info.Get(key)};
}

std::vector<double> time_of(vtkDataObject& data) {
  return time_in(*data.GetInformation(), vtkDataObject::DATA_TIME_STEP());
}

void set_time(vtkDataObject& data, const std::vector<double>& time) {
  vtkInformation& about = *data.GetInformation();
  about.Remove(vtkDataObject::DATA_TIME_STEP());
  if (!time.empty()) about.Set(vtkDataObject::DATA_TIME_STEP(), time.front());
}

/// Throws MismatchError for ids beyond the 32 bits that VTK sends.
void expect_small_ids(vtkPolyData& mesh) {
  for (const int where : {vtkDataObject::POINT, vtkDataObject::CELL}) {
    vtkDataSetAttributes& data = *mesh.GetAttributes(where);
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
      vtkDataArray* ids = data.GetArray(i);
      if (!ids || ids->GetDataType() != VTK_ID_TYPE) continue;
      if (std::max(-ids->GetRange()[0], ids->GetRange()[1]) <= VTK_INT_MAX) continue;
      throw MismatchError("the ids " + std::string(ids->GetName() ? ids->GetName() : "") +
                          " exceed 2147483647; apply Generate Global Ids, or remove them");
    }
  }
}

/// Makes the outputs of the parts that a process got, and of the times of the first one.
void take_parts(vtkDataObject& parts, vtkMultiProcessStream& times, vtkInformationVector& outputs) {
  auto& blocks = static_cast<vtkMultiBlockDataSet&>(parts);
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    vtkDataObject& output = *vtkDataObject::GetData(&outputs, port);
    vtkDataObject* part = blocks.GetBlock(static_cast<unsigned>(port));
    if (part && part != &output) output.ShallowCopy(part);
    set_time(output, taken_times(times));
  }
}

}  // namespace

void empty_outputs(vtkInformationVector& outputs) {
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    vtkDataObject* output = vtkDataObject::GetData(&outputs, port);
    if (!output) continue;
    output->Initialize();
    set_time(*output, time_in(*outputs.GetInformationObject(port), Pipeline::UPDATE_TIME_STEP()));
  }
}

/// Piece of a process, or the problem with it.
struct PieceExchange::Piece {
  vtkSmartPointer<vtkPolyData> mesh = {};
  std::string problem = {};
  std::vector<double> shown = {};  ///< time of the piece: none or one
};

bool PieceExchange::begin(vtkInformation& output) {
  const bool was_in_pieces = in_pieces();
  processes_.reset();
  const int pieces = output.Get(Pipeline::UPDATE_NUMBER_OF_PIECES());
  if (pieces <= 1) return was_in_pieces;
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  const bool shared =
      controller && controller->GetNumberOfProcesses() == pieces &&
      output.Get(Pipeline::UPDATE_PIECE_NUMBER()) == controller->GetLocalProcessId();
  if (!shared) {
    throw std::invalid_argument("expected a piece of the mesh on each process, found one of " +
                                std::to_string(pieces) + " pieces; ask for the whole mesh");
  }
  processes_.emplace(*controller);
  return !was_in_pieces;
}

std::vector<PieceExchange::Piece> PieceExchange::gather(int port, vtkMultiProcessStream order) {
  const std::vector<double> time = taken_times(order), steps = taken_times(order);
  Piece own{vtkSmartPointer<vtkPolyData>::New()};
  try {
    vtkDataObject* data = input_(port, time.empty() ? std::nullopt : std::optional(time[0]));
    if (is_first() || !is_nothing(data)) own.mesh->ShallowCopy(&mesh_of(data));
    if (!is_first()) expect_small_ids(*own.mesh);
    if (data) own.shown = time_of(*data);
    if (own.mesh->GetNumberOfPoints() > 0 && steps_(port) != steps) {
      own.problem = "its time steps are not those of process 0; give all the same times";
    }
  } catch (const std::bad_alloc&) {
    own.problem = "not enough memory";
  } catch (const std::exception& error) {
    own.problem = error.what();
  }
  vtkMultiProcessStream words;
  words << own.problem;
  put_times(words, own.shown);
  std::vector<vtkMultiProcessStream> all_words = processes_->gathered(words);
  Processes::Data sent = processes_->nothing();
  sent.front() = own.mesh;
  const Processes::Data meshes = processes_->exchanged(sent);
  std::vector<Piece> pieces(all_words.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].mesh = vtkPolyData::SafeDownCast(meshes[i]);
    all_words[i] >> pieces[i].problem;
    pieces[i].shown = taken_times(all_words[i]);
  }
  return pieces;
}

vtkDataObject* PieceExchange::input_at(int port, const std::string& name,
                                       std::optional<double> time) {
  if (!processes_) return input_(port, time);
  vtkMultiProcessStream order;
  order << port;
  put_times(order, time ? std::vector{*time} : std::vector<double>());
  put_times(order, steps_(port));
  order = processes_->told(order);
  taken_number(order);
  Pieces pieces;
  std::vector<double> shown;
  std::size_t process = 0;
  for (const Piece& piece : gather(port, order)) {
    const std::string who = "process " + std::to_string(process++);
    if (!piece.problem.empty()) throw MismatchError(who + ": " + piece.problem);
    pieces.push_back(piece.mesh);
    if (piece.mesh->GetNumberOfPoints() == 0 || piece.shown.empty()) continue;
    if (shown.empty()) shown = piece.shown;
    if (piece.shown == shown) continue;
    throw MismatchError(who + " has a piece of time " + to_text(piece.shown[0]) +
                        ", others of time " + to_text(shown[0]) + "; give all the same times");
  }
  JoinedPieces& found = joined_[port] = joined(std::move(pieces), name);
  set_time(*found.mesh, shown);
  return found.mesh;
}

void PieceExchange::end(Attempt how, vtkInformationVector& outputs) {
  if (!processes_) return;
  Processes::Data parts = processes_->nothing();
  std::exception_ptr failure;
  try {
    vtkNew<vtkMultiBlockDataSet> all;  // without tables
    for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
      all->SetBlock(static_cast<unsigned>(port), vtkDataObject::GetData(&outputs, port));
    }
    for (std::size_t i = 0; how == Attempt::done && i < parts.size(); ++i) {
      parts[i] = part_for(i, all);
    }
  } catch (const std::exception&) {
    failure = std::current_exception();
    how = Attempt::failed;
  }
  // The others wait for this order, even after a failure.
  vtkMultiProcessStream order;
  order << kEnd << static_cast<int>(how);
  for (int port = 0; port < outputs.GetNumberOfInformationObjects(); ++port) {
    put_times(order, time_of(*vtkDataObject::GetData(&outputs, port)));
  }
  order = processes_->told(order);
  taken_number(order);
  finish(order, parts, outputs);
  if (failure) std::rethrow_exception(failure);
}

Attempt PieceExchange::serve(vtkInformationVector& outputs) {
  for (;;) {
    vtkMultiProcessStream order = processes_->told({});
    const int port = taken_number(order);
    try {
      if (port == kEnd) return finish(order, processes_->nothing(), outputs);
      gather(port, order);
    } catch (const std::bad_alloc&) {
      if (port == kEnd) return Attempt::failed;  // the first process reports this for all
    }
  }
}

Attempt PieceExchange::finish(vtkMultiProcessStream order, const Processes::Data& parts,
                              vtkInformationVector& outputs) {
  const auto how = static_cast<Attempt>(taken_number(order));
  try {
    if (how == Attempt::done) {
      const Processes::Data own = processes_->exchanged(parts);
      processes_->together([&] { take_parts(*own.front(), order, outputs); });
      return how;
    }
  } catch (const std::bad_alloc&) {
    empty_outputs(outputs);
    throw;
  }
  empty_outputs(outputs);
  return how;
}

vtkSmartPointer<vtkDataObject> PieceExchange::part_for(std::size_t process,
                                                       vtkDataObject* output) const {
  if (auto* mesh = vtkPolyData::SafeDownCast(output)) {
    for (const auto& [port, joined] : joined_) {
      if (lies_on(*mesh, *joined.mesh)) return part_of(*mesh, joined, process);
    }
    if (process == 0) return mesh;
    return vtkSmartPointer<vtkPolyData>::New();
  }
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(output);
  if (!blocks) return {};
  const auto parts = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned i = 0; i < blocks->GetNumberOfBlocks(); ++i) {
    parts->SetBlock(i, part_for(process, blocks->GetBlock(i)));
    parts->GetMetaData(i)->Copy(blocks->GetMetaData(i));
  }
  return parts;
}
