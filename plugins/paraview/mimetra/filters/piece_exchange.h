#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "plugins/paraview/mimetra/filters/attempt.h"
#include "plugins/paraview/mimetra/filters/merged_pieces.h"
#include "plugins/paraview/mimetra/filters/parcel.h"

class vtkDataObject;
class vtkInformation;
class vtkInformationVector;

/// What comes in at a port of a process.
struct Incoming {
  vtkDataObject* data = nullptr;
  std::vector<double> steps = {};  ///< the times at which it could be had
};

/// What cannot be given to all processes is not left on one. The outputs are of the time that was
/// asked for, on all: VTK goes by it when it decides whether a process is asked again.
void empty_outputs(vtkInformationVector& outputs);

/// Runs a filter that needs whole meshes on a server of several processes, each of which holds a
/// piece: the first one works, on meshes merged from all pieces, and the others do what it says.
/// Of one process, nothing is exchanged.
class PieceExchange {
 public:
  /// What comes in at a port of this process, brought to a time where one is given. Throws where it
  /// cannot be had.
  using Input = std::function<Incoming(int port, std::optional<double> time)>;

  explicit PieceExchange(Input input) : input_(std::move(input)) {}

  /// By each process when a request begins; true where what earlier ones found is not this
  /// request's. Throws std::invalid_argument for a piece that no other process has the rest of.
  bool begin(vtkInformation& output);
  /// False where this process has the whole mesh.
  bool in_pieces() const { return processes_.has_value(); }
  bool is_first() const { return !processes_ || processes_->is_first(); }
  int processes() const { return processes_ ? processes_->count() : 1; }
  /// By all: true where it is true on all.
  bool all(bool mine) { return !processes_ || processes_->all(mine); }
  /// By all: what the first one says.
  vtkMultiProcessStream told(const vtkMultiProcessStream& words) {
    return processes_ ? processes_->told(words) : words;
  }

  /// On the first: what comes in at a port, the pieces of all merged. Throws MismatchError for
  /// pieces that do not fit, as those of different times, std::invalid_argument where one is no
  /// mesh, IoError where a process could not read its own.
  vtkDataObject* input_at(int port, std::optional<double> time);
  /// On the first: what comes in at a port from now on is another mesh.
  void forget(int port) { merged_.erase(port); }
  /// On the first: true where the numbers of a mesh's points are those that one process knows.
  bool is_ordered(int port) const;
  /// On the first: points of a mesh that became one with others by their positions alone.
  std::size_t joined(int port) const;

  /// On the first: gives the others their pieces of the outputs, and keeps its own. False where
  /// memory did not suffice on some process. There is nothing in the outputs of any process then,
  /// where it throws, and where nothing was done.
  bool end(Attempt how, vtkInformationVector& outputs);
  /// On the others: does what the first says to its end.
  Attempt serve(vtkInformationVector& outputs);

 private:
  /// By all: the pieces at a port on the first.
  std::optional<std::vector<Parcel>> gather(int port, std::optional<double> time);
  /// By all: their pieces of the outputs. False on all where memory did not suffice on one.
  bool share(std::vector<Parcel> parcels, vtkInformationVector& outputs);

  void put_outputs(Parcel& parcel, vtkInformationVector& outputs, std::size_t process) const;
  void put_mesh(Parcel& parcel, vtkPolyData& output, std::size_t process) const;
  void take_outputs(Parcel& parcel, vtkInformationVector& outputs);
  void take_mesh(Parcel& parcel, vtkPolyData& output);

  Input input_;
  std::optional<Processes> processes_;
  std::map<int, MergedPieces> merged_;                  ///< on the first, by port
  std::map<int, vtkSmartPointer<vtkPolyData>> pieces_;  ///< of this process, by port
};
