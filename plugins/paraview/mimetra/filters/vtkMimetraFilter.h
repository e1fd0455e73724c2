#pragma once

#include <memory>
#include <string>

#include "vtkMimetraAlgorithm.h"

class TimeSteps;
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
  /// When what comes in at a port last became other data; 0 for nothing.
  vtkMTimeType input_changed_at(int port);
  /// Gives the operation what comes in at other ports.
  virtual void give_further_inputs(vtkInformationVector** inputs);
  /// Makes what stays the same over time; called before the first show() after any change.
  virtual void prepare(const mimetra::Outcome& outcome, vtkPolyData& input);
  /// Writes the outputs; `input` is the mesh at the time of the sequence's frame `frame`.
  virtual void show(const mimetra::Outcome& outcome, vtkPolyData& input, int frame,
                    vtkInformationVector* outputs) = 0;

 private:
  /// Takes the time step that came in; false where the next pass brings another one.
  bool take(vtkDataObject* data);
  void compute_and_show(vtkDataObject* data, vtkInformationVector** inputs,
                        vtkInformationVector* outputs);

  std::string input_;
  Takes takes_;
  std::unique_ptr<TimeSteps> steps_;
  bool collecting_ = false;
  bool has_sequence_ = false;
  vtkMTimeType collected_at_ = 0;
  vtkMTimeType failed_at_ = 0;
  vtkMTimeType prepared_at_ = 0;
  double asked_time_ = 0;
};
