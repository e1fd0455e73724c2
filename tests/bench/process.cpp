#include "tests/bench/process.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mimetra::bench {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Where the output of a child goes.
class Redirection {
 public:
  Redirection(const std::string& output, const std::string& errors) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, output.c_str(), kFlags, 0644);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, errors.c_str(), kFlags, 0644);
  }
  ~Redirection() { posix_spawn_file_actions_destroy(&actions_); }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Follows the most memory that a child has held until this object goes. What wait4 returns counts
/// the memory that its parent had when the child began.
class MemoryWatch {
 public:
  MemoryWatch(pid_t child, double& peak_bytes)
      : thread_([child, &peak_bytes](const std::stop_token& stop) {
          const std::string path = "/proc/" + std::to_string(child) + "/status";
          while (!stop.stop_requested()) {
            peak_bytes = std::max(peak_bytes, high_water(path));
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
          }
        }) {}

 private:
  static double high_water(const std::string& path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
    }
    return 0;
  }

  std::jthread thread_;
};

}  // namespace

ProcessResult run_process(const std::vector<std::string>& arguments,
                          const std::filesystem::path& scratch) {
  const std::string output = scratch / "stdout.txt", errors = scratch / "stderr.txt";
  const Redirection redirection(output, errors);
  std::vector<std::string> copies = arguments;
  std::vector<char*> pointers;
  for (std::string& copy : copies) pointers.push_back(copy.data());
  pointers.push_back(nullptr);

  ProcessResult result;
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  if (posix_spawnp(&child, pointers[0], redirection.actions(), nullptr, pointers.data(), environ) !=
      0) {
    result.code = 127;
    return result;
  }
  int status = 0;
  {
    const MemoryWatch watch(child, result.peak_bytes);
    if (waitpid(child, &status, 0) != child) {
      throw std::runtime_error(arguments[0] + ": cannot wait for it");
    }
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.output = content(output);
  result.errors = content(errors);
  return result;
}

ProcessResult run_or_throw(const std::vector<std::string>& arguments,
                           const std::filesystem::path& scratch) {
  ProcessResult result = run_process(arguments, scratch);
  if (result.code == 0) return result;
  std::string command;
  for (const std::string& argument : arguments) command += argument + ' ';
  throw std::runtime_error(command + "ended with " + std::to_string(result.code) + ": " +
                           result.errors);
}

}  // namespace mimetra::bench
