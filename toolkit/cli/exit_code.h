#pragma once

#include <functional>
#include <iosfwd>

namespace mimetra::cli {

/// Exit codes of the command (docs/errors.md).
enum ExitCode {
  kDone = 0,
  kFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kMismatch = 4,
  kOutput = 5,
  kInterrupted = 130
};

/// Messages of the command go to `stream` from now on.
void say_to(std::ostream& stream);

/// Calls `run`, prints its error, and returns the exit code. Throws std::bad_alloc as `run` does.
ExitCode exit_code_of(const std::function<void()>& run);

}  // namespace mimetra::cli
