#pragma once

#include <exception>
#include <string>

#include "plugins/c/mimetra.h"

namespace mimetra {

/// What an exception is on the other side of the C interface.
struct Failure {
  mimetra_status status;
  std::string message;
};

Failure failure_of(const std::exception_ptr& error);

/// Throws what `status` stands for, with `subject` (who failed) before the message.
[[noreturn]] void throw_failure(mimetra_status status, const std::string& subject,
                                const std::string& message);

}  // namespace mimetra
