#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vtkPolyDataAlgorithm.h>

#include <MimetraFiltersModule.h>

#include "plugins/paraview/mimetra/filters/attempt.h"

class OperationCall;
namespace mimetra {
struct Invocation;
struct Outcome;
}  // namespace mimetra

/// Base of the sources and filters: an operation's parameters, progress, abort and errors.
class MIMETRAFILTERS_EXPORT vtkMimetraAlgorithm : public vtkPolyDataAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraAlgorithm, vtkPolyDataAlgorithm);

  /// Sets a parameter of the operation, or the path of an input. Empty text restores the default.
  void SetInteger(const char* name, int value);
  void SetNumber(const char* name, double value);
  void SetText(const char* name, const char* value);

  /// Sets a file for the manifest of each run, which replaces the manifest of an earlier run; empty
  /// for none.
  void SetRunFile(const char* path);

  /// Number of times that components were computed.
  int GetDecompositions();

  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputs,
                           vtkInformationVector* outputs, int port, vtkMTimeType* changed) override;

 protected:
  explicit vtkMimetraAlgorithm(std::unique_ptr<OperationCall> call);
  ~vtkMimetraAlgorithm() override;

  OperationCall& call() { return *call_; }
  const OperationCall& call() const { return *call_; }
  /// Switches to another operation, with its defaults.
  void set_call(std::unique_ptr<OperationCall> call);
  /// Optional outputs to make.
  virtual std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation);
  /// Outcome of the operation, cached while it is valid. Progress is shown from `begin` on. Throws
  /// what the operation throws.
  const mimetra::Outcome& outcome(double begin = 0);
  /// Calls `work` and shows what it throws as an error. An abort shows nothing, and the next update
  /// starts over.
  Attempt attempt(const std::function<void()>& work);
  /// Shows progress. Returns false if the user aborts.
  bool show_progress(double share);
  /// Makes the next update start over, even at the same time.
  void begin_anew() { begins_anew_ = true; }
  /// Ends an update that started over. Until then, an error that was shown before is not shown
  /// again.
  void end_anew() { is_anew_ = false; }
  /// Clears an abort of an earlier execution.
  void begin_execution();

 private:
  vtkMimetraAlgorithm(const vtkMimetraAlgorithm&) = delete;
  void operator=(const vtkMimetraAlgorithm&) = delete;

  void show_error(const std::string& message);

  std::unique_ptr<OperationCall> call_;
  bool begins_anew_ = false;
  bool is_anew_ = false;
  std::string said_;
};
