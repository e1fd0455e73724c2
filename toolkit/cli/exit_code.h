#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace mimetra::cli {

/// Makes `text` safe for a terminal, because names of files and texts in files are arbitrary.
/// Escapes all characters except newlines, tabs and printable UTF-8 as \xHH.
std::string terminal_text(std::string_view text);

/// Exit codes of the command (docs/errors.md).
enum ExitCode {
  kDone = 0,
  kFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kMismatch = 4,
  kOutput = 5,
  kInterrupted = 130
};

struct ExitMeaning {
  ExitCode code;
  const char* meaning;
};

constexpr ExitMeaning kExitMeanings[] = {
    {kDone, "done"},
    {kFailed, "the computation failed"},
    {kUsage, "usage: an unknown option, or a value that is wrong whatever the data"},
    {kBadInput,
     "an input is wrong in itself: missing, unreadable, truncated, not finite, without faces"},
    {kMismatch, "inputs contradict each other or the request"},
    {kOutput, "an output cannot be written, or exists and may not be replaced"},
    {kInterrupted, "interrupted; no output is half-written"}};

/// Directs messages of the command to `stream`.
void say_to(std::ostream& stream);

/// Calls `run`, prints its error, and returns the exit code. Throws std::bad_alloc as `run` does.
ExitCode exit_code_of(const std::function<void()>& run);

}  // namespace mimetra::cli
