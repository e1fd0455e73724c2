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

/// Input at a port of a process.
struct Incoming {
  vtkDataObject* data = nullptr;
  std::vector<double> steps = {};  ///< available times
};

/// Empties the outputs, so that no process keeps a part that others lack. The outputs get the
/// requested time on all processes, because VTK uses it to decide whether to ask a process again.
void empty_outputs(vtkInformationVector& outputs);

/// Runs a filter that needs whole meshes on a server of several processes, each with one piece. The
/// first process works on meshes merged from all pieces, and the others follow its orders. With one
/// process, nothing is exchanged. Collective functions must be called by all processes.
class PieceExchange {
 public:
  /// Reads the input at a port of this process, at a time if one is given. Throws if the input
  /// cannot be read.
  using Input = std::function<Incoming(int port, std::optional<double> time)>;

  explicit PieceExchange(Input input) : input_(std::move(input)) {}

  /// Call this on each process when a request begins. Returns true if a request for pieces follows
  /// one for the whole mesh, or the reverse: earlier inputs then do not count. Throws
  /// std::invalid_argument unless each process is asked for its own piece.
  bool begin(vtkInformation& output);
  /// Returns false if this process has the whole mesh.
  bool in_pieces() const { return processes_.has_value(); }
  bool is_first() const { return !processes_ || processes_->is_first(); }
  int processes() const { return processes_ ? processes_->count() : 1; }
  /// Collective. Returns whether `mine` is true on all processes.
  bool all(bool mine) { return !processes_ || processes_->all(mine); }
  /// Collective. Returns the words of the first process.
  vtkMultiProcessStream told(const vtkMultiProcessStream& words) {
    return processes_ ? processes_->told(words) : words;
  }

  /// On the first process: input at a port, merged from the pieces of all processes. Throws
  /// MismatchError for pieces that do not fit, such as pieces of different times. Throws
  /// std::invalid_argument if a piece is not a mesh, and IoError if a process cannot read its
  /// piece.
  vtkDataObject* input_at(int port, std::optional<double> time);
  /// On the first process: forgets the mesh at a port, because another one follows.
  void forget(int port) { merged_.erase(port); }
  /// On the first process: returns whether the points of a mesh have the numbers that a single
  /// process would see.
  bool is_ordered(int port) const;
  /// On the first process: number of points of a mesh that were joined with others by their
  /// positions alone.
  std::size_t joined(int port) const;

  /// On the first process: gives the others their pieces of the outputs, and keeps its own. Returns
  /// false if some process lacks memory. The outputs of all processes are empty in that case, if
  /// this throws, and unless `how` is done.
  bool end(Attempt how, vtkInformationVector& outputs);
  /// On the other processes: follows the first one's orders until the request ends.
  Attempt serve(vtkInformationVector& outputs);

 private:
  /// Collective. Gathers the pieces at a port on the first process.
  std::optional<std::vector<Parcel>> gather(int port, std::optional<double> time);
  /// Collective. Gives each process its piece of the outputs. Returns false on all if one lacks
  /// memory.
  bool share(std::vector<Parcel> parcels, vtkInformationVector& outputs);

  void put_outputs(Parcel& parcel, vtkInformationVector& outputs, std::size_t process) const;
  void put_mesh(Parcel& parcel, vtkPolyData& output, std::size_t process) const;
  void take_outputs(Parcel& parcel, vtkInformationVector& outputs);
  void take_mesh(Parcel& parcel, vtkPolyData& output);

  Input input_;
  std::optional<Processes> processes_;
  std::map<int, MergedPieces> merged_;                  ///< on the first process, by port
  std::map<int, vtkSmartPointer<vtkPolyData>> pieces_;  ///< of this process, by port
};
