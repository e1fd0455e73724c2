#pragma once

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

class PieceExchange;
class TimeSteps;
class vtkAlgorithmOutput;
class vtkDataObject;

/// A filter that passes all time steps of its input to its operation as one sequence, and meshes at
/// further ports as models. Some operations get only the shown time step. The filter shows the
/// outcome at the requested time. On a server of several processes, the first one does this for the
/// pieces of all.
class MIMETRAFILTERS_EXPORT vtkMimetraFilter : public vtkMimetraAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraFilter, vtkMimetraAlgorithm);

 protected:
  enum class Takes { all_time_steps, shown_time_step };

  explicit vtkMimetraFilter(const char* operation, Takes takes = Takes::all_time_steps);
  ~vtkMimetraFilter() override;
  /// Switches to another operation. Throws std::invalid_argument if it does not begin with a mesh.
  void become(std::unique_ptr<OperationCall> call);

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputs,
                         vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

  /// Returns whether an output has time steps; a table over time has none.
  virtual bool moves(int port) const;
  /// Name of the operation's input at port 0.
  const std::string& piped() const { return input_; }
  /// Mesh at a further port, or null if there is none or the input is a file.
  vtkPolyData* mesh_at(int port) const;
  /// Makes what all time steps share. Called before the first show() after any change, and if the
  /// number of the input's vertex, line or other cells changes.
  virtual void prepare(const mimetra::Outcome& outcome, vtkPolyData& input);
  /// Writes the outputs; `input` is the mesh at `time`.
  virtual void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
                    vtkInformationVector* outputs) = 0;

 private:
  /// Origin of the data at a port. Other data have another origin, but other times of the same data
  /// do not.
  struct Origin {
    vtkAlgorithmOutput* connection = nullptr;
    vtkMTimeType changed = 0;
    bool operator==(const Origin&) const = default;
  };
  /// Times at which an input is available.
  struct Times {
    std::vector<double> steps = {};
    std::vector<double> range = {};
    bool operator==(const Times&) const = default;
  };
  /// A further input that may be a mesh.
  struct MeshPort {
    std::string input;
    std::optional<Origin> given = {};
    vtkSmartPointer<vtkPolyData> mesh = {};
  };

  Origin origin_of(int port);
  /// Request to the input at a port.
  struct Asked {
    Origin origin = {};
    std::optional<double> time = {};
    bool operator==(const Asked&) const = default;
  };

  /// Input at a port of this process, at `time` if it has times. Throws IoError if it cannot be
  /// read.
  vtkDataObject* input_at(int port, std::optional<double> time);
  Times input_times();
  void set_times(vtkInformationVector& outputs, const Times& times) const;
  void name_inputs();
  /// On each process: finds out whether the request is for a piece, and updates the inputs. Returns
  /// false on all processes if one of them fails.
  bool begin_request(vtkInformation& output, vtkInformationVector& outputs);
  /// Collective. Gives time-dependent outputs the times of the first process's input. Returns false
  /// if they had other times.
  bool learn_times(vtkInformationVector& outputs);
  bool update_inputs();
  /// Requests at all ports.
  std::vector<Asked> asked();
  /// Forgets earlier inputs.
  void forget_inputs();
  /// Warns of input arrays that the first output does not pass on, once for the same arrays.
  void tell_of_lost_arrays(vtkPolyData& input, vtkInformationVector& outputs);
  /// Computes for all on the first process; the others follow its orders.
  void compute_or_serve(vtkInformationVector** inputs, vtkInformationVector* outputs);
  /// Passes the meshes at further ports to the operation.
  void give_meshes(vtkInformationVector** inputs);
  /// Passes the input's time steps to the operation if they changed, or only the shown one.
  void collect(vtkInformation& in, std::optional<double> shown);
  void compute_and_show(std::optional<double> time, vtkInformationVector* outputs);

  std::string input_;
  std::vector<MeshPort> mesh_ports_;
  Takes takes_;
  std::unique_ptr<PieceExchange> exchange_;
  bool begun_ = true;
  std::optional<std::vector<Asked>> failed_;  ///< requests that failed
  std::optional<Times> times_;  ///< of the first process's input; set on the others only
  std::unique_ptr<TimeSteps> steps_;
  std::optional<Origin> collected_;
  std::set<std::string> told_lost_;
  vtkMTimeType failed_at_ = 0;
  vtkMTimeType prepared_at_ = 0;
  std::array<vtkIdType, 3> prepared_cells_ = {};  ///< vertices, lines, and all
};
