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

/// What the sources and filters share: an operation's parameters, progress, abort and errors.
class MIMETRAFILTERS_EXPORT vtkMimetraAlgorithm : public vtkPolyDataAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraAlgorithm, vtkPolyDataAlgorithm);

  /// A parameter of the operation by name, or the path of an input; no text for its default.
  void SetInteger(const char* name, int value);
  void SetNumber(const char* name, double value);
  void SetText(const char* name, const char* value);

  /// A file for the manifest of each run, which replaces that of an earlier one; no text for none.
  void SetRunFile(const char* path);

  /// How often components were computed.
  int GetDecompositions();

  int ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputs,
                           vtkInformationVector* outputs, int port, vtkMTimeType* changed) override;

 protected:
  explicit vtkMimetraAlgorithm(std::unique_ptr<OperationCall> call);
  ~vtkMimetraAlgorithm() override;

  OperationCall& call() { return *call_; }
  const OperationCall& call() const { return *call_; }
  /// Takes another operation, with its defaults.
  void set_call(std::unique_ptr<OperationCall> call);
  /// Outputs besides those that are not optional.
  virtual std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation);
  /// The operation's outcome, kept while it holds; its progress is shown from `begin` on. Throws
  /// what the operation throws.
  const mimetra::Outcome& outcome(double begin = 0);
  /// Calls `work`; what it throws is shown as an error, save an abort, which is no result.
  Attempt attempt(const std::function<void()>& work);
  /// Shows progress; false to stop.
  bool show_progress(double share);
  /// The next update begins anew, at the same time too.
  void begin_anew() { begins_anew_ = true; }
  /// What was begun anew has ended: until then, what was said is not said again.
  void end_anew() { is_anew_ = false; }
  /// Forgets an abort of an earlier execution.
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
