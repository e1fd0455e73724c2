#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mimetra::bench {

/// A program that has ended.
struct ProcessResult {
  int code = 0;  ///< -1 where a signal ended it
  double seconds = 0;
  double peak_bytes = 0;  ///< most memory held
  std::string output;     ///< what it wrote to stdout
  std::string errors;     ///< and to stderr
};

/// Runs a program, found on PATH unless its name holds a slash, and waits for it; `scratch` is a
/// folder for its output. The code is 127 where there is no such program.
ProcessResult run_process(const std::vector<std::string>& arguments,
                          const std::filesystem::path& scratch);

/// As run_process; throws std::runtime_error with what it wrote to stderr where it failed.
ProcessResult run_or_throw(const std::vector<std::string>& arguments,
                           const std::filesystem::path& scratch);

}  // namespace mimetra::bench
