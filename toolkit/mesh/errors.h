#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace mimetra {

/// A file is wrong in itself: missing, unreadable, truncated, not what its name says. The message
/// starts with the path.
class IoError : public std::runtime_error {
 public:
  IoError(std::string_view path, std::string_view message);
};

/// Inputs that are sound by themselves contradict each other or what was asked: another vertex
/// count, another connectivity, no known weight name, more components than vertices.
class MismatchError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A file cannot be written or exists already. The message starts with the path.
class OutputError : public std::runtime_error {
 public:
  OutputError(std::string_view path, std::string_view message);
};

/// The caller's progress function asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled();
};

}  // namespace mimetra
