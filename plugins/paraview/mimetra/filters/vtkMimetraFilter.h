#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

class TimeSteps;
class vtkAlgorithmOutput;
class vtkDataObject;
class vtkPolyData;

/// A filter that gives its operation all time steps of its input as one sequence (or, for some, the
/// one that is shown), and shows what came of it at the time asked for.
class MIMETRAFILTERS_EXPORT vtkMimetraFilter : public vtkMimetraAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraFilter, vtkMimetraAlgorithm);

 protected:
  enum class Takes { all_time_steps, shown_time_step };

  /// `input`: the operation's name for what comes in at port 0.
  vtkMimetraFilter(const char* operation, const char* input, Takes takes = Takes::all_time_steps);
  ~vtkMimetraFilter() override;
  /// Takes another operation, with its name for what comes in.
  void become(std::unique_ptr<OperationCall> call, const std::string& input);

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputs,
                         vtkInformationVector* outputs) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

  /// True where an output has time steps; a table over time has none.
  virtual bool moves(int port) const;
  /// Where the data at a port come from: other data, save those of another time, have another one.
  struct Origin {
    vtkAlgorithmOutput* connection = nullptr;
    vtkMTimeType changed = 0;
    bool operator==(const Origin&) const = default;
  };
  Origin origin_of(int port);
  /// What comes in at a port, brought to a time where it has times. Throws IoError where it cannot
  /// be had.
  vtkDataObject* input_at(int port, std::optional<double> time);
  /// Gives the operation what comes in at other ports.
  virtual void give_further_inputs(vtkInformationVector** inputs);
  /// Makes what stays the same over time; called before the first show() after any change, and
  /// where the input has other cells beside its polygons than before.
  virtual void prepare(const mimetra::Outcome& outcome, vtkPolyData& input);
  /// Writes the outputs; `input` is the mesh at `time`.
  virtual void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
                    vtkInformationVector* outputs) = 0;

 private:
  /// Gives the operation the input's time steps, where they are others than before, or the one that
  /// is shown.
  void collect(vtkInformation& in, std::optional<double> shown);
  void compute_and_show(std::optional<double> time, vtkInformationVector* outputs);

  std::string input_;
  Takes takes_;
  std::unique_ptr<TimeSteps> steps_;
  std::optional<Origin> collected_;
  vtkMTimeType failed_at_ = 0;
  vtkMTimeType prepared_at_ = 0;
  std::array<vtkIdType, 3> prepared_cells_ = {};  ///< vertices, lines, and all
};
