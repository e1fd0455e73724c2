#pragma once

namespace mimetra {

/// Bytes of memory that this process has, and the most it ever had; 0 where the system does not
/// tell.
struct MemoryUse {
  double now = 0;
  double peak = 0;

  static MemoryUse of_this_process();
};

}  // namespace mimetra
