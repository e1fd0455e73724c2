#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plugins/paraview/mimetra/filters/attempt.h"
#include "plugins/paraview/mimetra/filters/joined_pieces.h"
#include "plugins/paraview/mimetra/filters/processes.h"

class vtkInformation;
class vtkInformationVector;

/// Empties the outputs, so that no process keeps a part that others lack. The outputs get the
/// requested time on all processes, because VTK uses it to decide whether to ask a process again.
void empty_outputs(vtkInformationVector& outputs);

/// Runs a filter that needs whole meshes on a server of several processes, each with one piece. The
/// first process works on meshes joined from all pieces, and the others follow its orders. With one
/// process, nothing is exchanged. Collective functions must be called by all processes.
class PieceExchange {
 public:
  /// Reads the input at a port of this process, at a time if one is given. Throws if the input
  /// cannot be read.
  using Input = std::function<vtkDataObject*(int port, std::optional<double> time)>;
  /// Returns the times that are available at a port of this process.
  using Steps = std::function<std::vector<double>(int port)>;

  PieceExchange(Input input, Steps steps) : input_(std::move(input)), steps_(std::move(steps)) {}

  /// Call this on each process when a request begins. Returns true if a request for pieces follows
  /// one for the whole mesh, or the reverse: earlier inputs then do not count. Throws
  /// std::invalid_argument unless each process is asked for its own piece.
  bool begin(vtkInformation& output);
  /// Returns false if this process has the whole mesh.
  bool in_pieces() const { return processes_.has_value(); }
  bool is_first() const { return !processes_ || processes_->is_first(); }
  /// Collective. Returns whether `mine` is true on all processes.
  bool all(bool mine) { return !processes_ || processes_->all(mine); }
  /// Collective. Returns the words of the first process.
  vtkMultiProcessStream told(const vtkMultiProcessStream& words) {
    return processes_ ? processes_->told(words) : words;
  }

  /// On the first process: the input `name` at a port, joined from the pieces of all processes.
  /// Throws what joined() throws, and MismatchError for pieces of different times, or if a process
  /// cannot read its piece.
  vtkDataObject* input_at(int port, const std::string& name, std::optional<double> time);

  /// On the first process: gives the others their pieces of the outputs, and keeps its own. The
  /// outputs of all processes are empty if this throws, and unless `how` is done.
  void end(Attempt how, vtkInformationVector& outputs);
  /// On the other processes: follows the first one's orders until the request ends.
  Attempt serve(vtkInformationVector& outputs);

 private:
  struct Piece;

  /// Collective. Gathers the pieces at a port on the first process, at the time of the order.
  std::vector<Piece> gather(int port, vtkMultiProcessStream order);
  /// Collective. Gives each process its parts of the outputs, or empties them if the first process
  /// has not done its work. Returns what that process orders. Throws std::bad_alloc on all.
  Attempt finish(vtkMultiProcessStream order, const Processes::Data& parts,
                 vtkInformationVector& outputs);
  /// Part of an output for a process; null for a table.
  vtkSmartPointer<vtkDataObject> part_for(std::size_t process, vtkDataObject* output) const;

  Input input_;
  Steps steps_;
  std::optional<Processes> processes_;
  std::map<int, JoinedPieces> joined_;  ///< on the first process, by port
};
