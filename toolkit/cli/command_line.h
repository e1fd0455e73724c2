#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra::cli {

enum class ProgressBar { automatic, always, never };

constexpr std::string_view choice_name(ProgressBar value) {
  switch (value) {
    case ProgressBar::automatic:
      return "auto";
    case ProgressBar::always:
      return "always";
    case ProgressBar::never:
      return "never";
  }
  return {};
}

/// One parsed call of the program.
struct Request {
  const Operation* operation = nullptr;
  std::vector<std::string> arguments;  ///< as typed, without the program's name
  Parameters parameters;
  /// Files read besides the inputs and the files of options: of --config.
  std::vector<std::string> files;
  std::map<std::string, std::vector<std::string>> inputs;
  std::map<std::string, std::filesystem::path> outputs;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  bool force = false;
  bool dry_run = false;
  int threads = 0;  ///< 0 for all available threads
  ProgressBar progress = ProgressBar::automatic;
};

/// Either a request, or text to print (help, version).
struct ParsedLine {
  std::optional<Request> request;
  std::string text;
};

/// Parses a command line against the table. Throws UsageError with suggestions ("did you mean"),
/// and IoError for a configuration file that cannot be read.
ParsedLine parse_command_line(const OperationTable& table,
                              const std::vector<std::string>& arguments);

/// Text of `--version` after the version: the licence, the instruction set of the build, and the
/// linked libraries.
std::string_view libraries();

}  // namespace mimetra::cli
