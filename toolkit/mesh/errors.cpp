#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

std::string with_path(std::string_view path, std::string_view message) {
  return std::string(path).append(": ").append(message);
}

}  // namespace

IoError::IoError(std::string_view path, std::string_view message)
    : std::runtime_error(with_path(path, message)) {}

OutputError::OutputError(std::string_view path, std::string_view message)
    : std::runtime_error(with_path(path, message)) {}

Cancelled::Cancelled() : std::runtime_error("cancelled") {}

}  // namespace mimetra
