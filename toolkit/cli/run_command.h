#pragma once

#include <string>

#include "toolkit/cli/command_line.h"
#include "toolkit/mesh/context.h"

namespace mimetra::cli {

/// Size in text: "238 MB".
std::string megabytes(double bytes);

/// Ends the process's current work with Cancelled at the next progress report; async-signal-safe.
void interrupt();

/// Reads the inputs, runs the operation, and writes outputs and manifest. Prints the result on
/// stdout and everything else on stderr. All ranks call it: they compute shared operations
/// together, and only rank 0 does the rest. Only the ranks of `context` count. Throws what Call
/// throws.
void run_command(const OperationTable& table, const Request& request, const Context& context = {});

}  // namespace mimetra::cli
