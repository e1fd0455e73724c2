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

/// A filter that gives its operation all time steps of its input as one sequence (or, for some, the
/// one that is shown), and meshes at further ports as models; it shows what came of it at the time
/// asked for. On a server of several processes the first one does so, for the pieces of all.
class MIMETRAFILTERS_EXPORT vtkMimetraFilter : public vtkMimetraAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraFilter, vtkMimetraAlgorithm);

 protected:
  enum class Takes { all_time_steps, shown_time_step };

  explicit vtkMimetraFilter(const char* operation, Takes takes = Takes::all_time_steps);
  ~vtkMimetraFilter() override;
  /// Takes another operation. Throws std::invalid_argument for one that begins with no mesh.
  void become(std::unique_ptr<OperationCall> call);

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputs,
                         vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

  /// True where an output has time steps; a table over time has none.
  virtual bool moves(int port) const;
  /// The operation's name for what comes in at port 0.
  const std::string& piped() const { return input_; }
  /// The mesh that came in at a further port, or null where there is none, or a file instead.
  vtkPolyData* mesh_at(int port) const;
  /// Makes what stays the same over time; called before the first show() after any change, and
  /// where the input has other cells beside its polygons than before.
  virtual void prepare(const mimetra::Outcome& outcome, vtkPolyData& input);
  /// Writes the outputs; `input` is the mesh at `time`.
  virtual void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
                    vtkInformationVector* outputs) = 0;

 private:
  /// Where the data at a port come from: other data, save those of another time, have another one.
  struct Origin {
    vtkAlgorithmOutput* connection = nullptr;
    vtkMTimeType changed = 0;
    bool operator==(const Origin&) const = default;
  };
  /// The times that an input can be had at.
  struct Times {
    std::vector<double> steps = {};
    std::vector<double> range = {};
    bool operator==(const Times&) const = default;
  };
  /// A further input that may come in as a mesh.
  struct MeshPort {
    std::string input;
    std::optional<Origin> given = {};
    vtkSmartPointer<vtkPolyData> mesh = {};
  };

  Origin origin_of(int port);
  /// What is asked of the input at a port.
  struct Asked {
    Origin origin = {};
    std::optional<double> time = {};
    bool operator==(const Asked&) const = default;
  };

  /// What comes in at a port of this process, brought to a time where it has times. Throws IoError
  /// where it cannot be had.
  vtkDataObject* input_at(int port, std::optional<double> time);
  Times input_times();
  void set_times(vtkInformationVector& outputs, const Times& times) const;
  void name_inputs();
  /// By each process: whether this request is for a piece, and brings what comes in up to date.
  /// False, on all processes, where one of them cannot.
  bool begin_request(vtkInformation& output, vtkInformationVector& outputs);
  /// By all: gives outputs that move the times of the first one's input. False where they had
  /// others.
  bool learn_times(vtkInformationVector& outputs);
  bool update_inputs();
  /// Of all ports.
  std::vector<Asked> asked();
  /// Forgets what came in before.
  void forget_inputs();
  /// Throws UsageError where the operation is told points by their numbers, which say nothing where
  /// the mesh is in pieces without global ids.
  void expect_order();
  /// Warns, once for an input, where points without global ids were joined by their positions.
  /// Throws UsageError where the operation keeps apart what is at one position.
  void tell_of_seams();
  /// Warns, once for the same, of the input's arrays that the first output does not pass on.
  void tell_of_lost_arrays(vtkPolyData& input, vtkInformationVector& outputs);
  /// On the first process computes for all; the others do what it says.
  void compute_or_serve(vtkInformationVector** inputs, vtkInformationVector* outputs);
  /// Gives the operation what comes in at further ports.
  void give_meshes(vtkInformationVector** inputs);
  /// Gives the operation the input's time steps, where they are others than before, or the one that
  /// is shown.
  void collect(vtkInformation& in, std::optional<double> shown);
  void compute_and_show(std::optional<double> time, vtkInformationVector* outputs);

  std::string input_;
  std::vector<MeshPort> mesh_ports_;
  Takes takes_;
  std::unique_ptr<PieceExchange> exchange_;
  bool begun_ = true;
  std::optional<std::vector<Asked>> failed_;  ///< what could not be had
  std::optional<Times> times_;                ///< of the first process, save on that one
  std::unique_ptr<TimeSteps> steps_;
  std::optional<Origin> collected_;
  std::optional<Origin> told_of_;  ///< the input whose seams were joined
  std::set<std::string> told_lost_;
  vtkMTimeType failed_at_ = 0;
  vtkMTimeType prepared_at_ = 0;
  std::array<vtkIdType, 3> prepared_cells_ = {};  ///< vertices, lines, and all
};
