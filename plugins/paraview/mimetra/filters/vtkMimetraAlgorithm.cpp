#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

#include <utility>

#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/proxy_xml.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/option_words.h"

using namespace mimetra;

namespace {

/// Message with options named as in the dialogs.
std::string in_its_words(const std::string& message) {
  return with_options_spelled(
      message, [](const std::string& option) { return "'" + label_of(option) + "'"; });
}

}  // namespace

vtkMimetraAlgorithm::vtkMimetraAlgorithm(std::unique_ptr<OperationCall> call)
    : call_(std::move(call)) {}

vtkMimetraAlgorithm::~vtkMimetraAlgorithm() = default;

void vtkMimetraAlgorithm::set_call(std::unique_ptr<OperationCall> call) {
  call_ = std::move(call);
}

void vtkMimetraAlgorithm::SetInteger(const char* name, int value) {
  if (call_->set(name, std::int64_t{value})) Modified();
}

void vtkMimetraAlgorithm::SetNumber(const char* name, double value) {
  if (call_->set(name, value)) Modified();
}

void vtkMimetraAlgorithm::SetText(const char* name, const char* value) {
  if (call_->set(name, std::string(value ? value : ""))) Modified();
}

void vtkMimetraAlgorithm::SetRunFile(const char* path) {
  if (call_->set_manifest(path ? path : "")) Modified();
}

int vtkMimetraAlgorithm::GetDecompositions() {
  return call_->decompositions();
}

std::vector<std::string> vtkMimetraAlgorithm::wanted_outputs(const Invocation&) {
  return {};
}

const Outcome& vtkMimetraAlgorithm::outcome(double begin) {
  if (call_->is_done()) return call_->outcome();
  const Log log = [this](LogLevel level, const std::string& text) {
    const std::string message = in_its_words(text);
    if (level == LogLevel::warning) {
      vtkWarningMacro(<< message);
    } else {
      vtkDebugMacro(<< message);
    }
  };
  const Context context =
      Context().with_progress([this](double share) { return show_progress(share); });
  Call loaded = call_->loaded(log, context.part(begin, 1));
  const std::vector<std::string> wanted = wanted_outputs(loaded.invocation());
  return call_->run(std::move(loaded), wanted);
}

Attempt vtkMimetraAlgorithm::attempt(const std::function<void()>& work) {
  try {
    work();
    return Attempt::done;
  } catch (const Cancelled&) {
    begin_anew();
    said_.clear();
    return Attempt::aborted;
  } catch (const std::bad_alloc&) {
    show_error("not enough memory; take fewer time steps");
  } catch (const std::exception& error) {
    show_error(in_its_words(error.what()));
  }
  return Attempt::failed;
}

void vtkMimetraAlgorithm::show_error(const std::string& message) {
  if (is_anew_ && message == said_) return;
  said_ = message;
  vtkErrorMacro(<< message);
}

bool vtkMimetraAlgorithm::show_progress(double share) {
  UpdateProgress(share);
  return GetAbortExecute() == 0;
}

int vtkMimetraAlgorithm::ComputePipelineMTime(vtkInformation* request,
                                              vtkInformationVector** inputs,
                                              vtkInformationVector* outputs, int port,
                                              vtkMTimeType* changed) {
  if (std::exchange(begins_anew_, false)) {
    is_anew_ = true;
    Modified();
  }
  return Superclass::ComputePipelineMTime(request, inputs, outputs, port, changed);
}

void vtkMimetraAlgorithm::begin_execution() {
  // The setter would make this algorithm and all after it execute again.
  AbortExecute = 0;
}
