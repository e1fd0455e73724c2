#pragma once

#include <filesystem>

namespace mimetra {

/// Memory of this process in bytes, now and at its peak; 0 if the system does not report it.
struct MemoryUse {
  double now = 0;
  double peak = 0;

  static MemoryUse of_this_process();
};

/// Bytes of memory that are left for this process, on the machine and in its control group.
/// +infinity if the system does not report it.
double available_memory();

/// Makes available_memory() return one process's share, for `processes` processes of a run on this
/// machine. \pre no other thread calls available_memory()
void share_memory(int processes);

/// Path of the program or library that contains this code; empty if the system does not report it.
std::filesystem::path this_binary();

}  // namespace mimetra
