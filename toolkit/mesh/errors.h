#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace mimetra {

/// An unusable input file: missing, unreadable, truncated, or not of the format that its name
/// implies. The message starts with the path.
class IoError : public std::runtime_error {
 public:
  IoError(std::string_view path, std::string_view message);
};

/// Valid inputs that contradict each other or the request: another vertex count or connectivity, an
/// unknown weight name, more components than vertices.
class MismatchError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A file that cannot be written or exists already. The message starts with the path.
class OutputError : public std::runtime_error {
 public:
  OutputError(std::string_view path, std::string_view message);
};

/// Thrown when the caller's progress function asks to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled();
};

}  // namespace mimetra
