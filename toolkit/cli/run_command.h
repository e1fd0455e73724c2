#pragma once

#include <string>

#include "toolkit/cli/command_line.h"
#include "toolkit/mesh/context.h"

namespace mimetra::cli {

/// As people read it: "238 MB".
std::string megabytes(double bytes);

/// Ends the process's current work with Cancelled at the next progress report; async-signal-safe.
void interrupt();

/// Reads the inputs, runs the operation, writes outputs and manifest, prints the result on stdout
/// and everything else on stderr. Several ranks all call it: what they share they compute together,
/// and the first alone does all else. Of the context only the ranks count. Throws what these throw.
void run_command(const OperationTable& table, const Request& request, const Context& context = {});

}  // namespace mimetra::cli
