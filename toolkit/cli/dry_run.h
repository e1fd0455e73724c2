#pragma once

#include <string>

#include "toolkit/cli/command_line.h"

namespace mimetra::cli {

/// As people read it: "238 MB".
std::string megabytes(double bytes);

/// What a run would do with its inputs once they are read: the outcome of --dry-run.
Outcome planned(const Operation& operation, const Invocation& invocation);

}  // namespace mimetra::cli
