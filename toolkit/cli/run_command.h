#pragma once

#include "toolkit/cli/command_line.h"

namespace mimetra::cli {

/// Ends the process's current work with Cancelled at the next progress report; async-signal-safe.
void interrupt();

/// Reads the inputs, runs the operation, writes outputs and manifest, prints the result on stdout
/// and everything else on stderr. Throws what these throw.
void run_command(const OperationTable& table, const Request& request);

}  // namespace mimetra::cli
