#include "toolkit/operations/memory_use.h"

#include <fstream>
#include <sstream>
#include <string>

namespace mimetra {

MemoryUse MemoryUse::of_this_process() {
  MemoryUse use;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string name;
    double kilobytes = 0;
    words >> name >> kilobytes;
    if (name == "VmRSS:") use.now = 1024 * kilobytes;
    if (name == "VmHWM:") use.peak = 1024 * kilobytes;
  }
  return use;
}

}  // namespace mimetra
