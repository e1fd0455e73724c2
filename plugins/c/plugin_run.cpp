#include "plugins/c/plugin_run.h"

#include "plugins/c/failure.h"
#include "plugins/c/interface.h"
#include "plugins/c/job.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

Outcome PluginFunction::operator()(const Operation& operation, const Invocation& invocation) const {
  mimetra_job job(operation, invocation, toolkit);
  mimetra_status status = MIMETRA_FAILED;
  try {
    status = run(&toolkit_interface(), &job, user);
  } catch (...) {
    if (job.cancelled()) throw Cancelled();
    const Failure failure = failure_of(std::current_exception());
    throw std::runtime_error(subject + ": threw an exception: " + failure.message);
  }
  const std::string& message = job.context().message;
  if (status != MIMETRA_OK) {
    if (job.cancelled()) throw Cancelled();
    throw_failure(status, subject, message.empty() ? "failed and does not say why" : message);
  }
  try {
    return std::move(job).outcome();
  } catch (const std::exception& error) {
    throw std::runtime_error(subject + ": " + error.what() +
                             (message.empty() ? "" : "; its last error: " + message));
  }
}

}  // namespace mimetra
