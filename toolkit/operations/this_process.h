#pragma once

#include <filesystem>

namespace mimetra {

/// Bytes of memory that this process has, and the most it ever had; 0 where the system does not
/// tell.
struct MemoryUse {
  double now = 0;
  double peak = 0;

  static MemoryUse of_this_process();
};

/// Bytes that the machine, or the group of processes that this one is confined with, has left
/// besides what this process has; +infinity where the system does not tell.
double available_memory();

/// available_memory() is one's share of it from now on, where so many processes of a run are on
/// this machine. \pre Nobody asks for it at the same time.
void share_memory(int processes);

/// The program or library that holds this code; empty where the system does not tell.
std::filesystem::path this_binary();

}  // namespace mimetra
