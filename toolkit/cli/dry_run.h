#pragma once

#include <string>

#include "toolkit/cli/command_line.h"

namespace mimetra::cli {

/// Bytes of memory that this process has, and the most it ever had; 0 where the system does not
/// tell.
struct MemoryUse {
  double now = 0;
  double peak = 0;

  static MemoryUse of_this_process();
};

/// As people read it: "238 MB".
std::string megabytes(double bytes);

/// What a run would do with its inputs once they are read: the outcome of --dry-run.
Outcome planned(const OperationTable& table, const Operation& operation,
                const Invocation& invocation);

}  // namespace mimetra::cli
