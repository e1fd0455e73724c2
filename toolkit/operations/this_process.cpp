#include "toolkit/operations/this_process.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <system_error>

#include <dlfcn.h>

namespace mimetra {

namespace {

constexpr double kKilobyte = 1024;

int sharing_processes = 1;

/// Reads "NAME: NUMBER kB" lines and returns bytes.
std::map<std::string, double> kilobytes_in(const std::string& path) {
  std::map<std::string, double> bytes;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    double kilobytes = 0;
    words >> name >> kilobytes;
    bytes[name] = kKilobyte * kilobytes;
  }
  return bytes;
}

/// Memory left in the control group; +infinity without a limit.
double left_in_group() {
  std::ifstream limit("/sys/fs/cgroup/memory.max"), use("/sys/fs/cgroup/memory.current");
  double most = 0, now = 0;
  if (!(limit >> most) || !(use >> now)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, most - now);
}

}  // namespace

MemoryUse MemoryUse::of_this_process() {
  const auto bytes = kilobytes_in("/proc/self/status");
  const auto of = [&bytes](const char* name) {
    const auto found = bytes.find(name);
    return found == bytes.end() ? 0 : found->second;
  };
  return {of("VmRSS:"), of("VmHWM:")};
}

double available_memory() {
  const auto bytes = kilobytes_in("/proc/meminfo");
  const auto available = bytes.find("MemAvailable:");
  const double of_machine =
      available == bytes.end() ? std::numeric_limits<double>::infinity() : available->second;
  return std::min(of_machine, left_in_group()) / sharing_processes;
}

void share_memory(int processes) {
  sharing_processes = processes;
}

std::filesystem::path this_binary() {
  Dl_info info{};
  const bool known = dladdr(reinterpret_cast<const void*>(&this_binary), &info) != 0;
  const std::string name = known && info.dli_fname ? info.dli_fname : "";
  // A program's name is the name that called it, which may not be a path.
  std::error_code error;
  return std::filesystem::canonical(name.find('/') == std::string::npos ? "/proc/self/exe" : name,
                                    error);
}

}  // namespace mimetra
