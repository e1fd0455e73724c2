#pragma once

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

namespace mimetra::test {

/// A file or folder of `data/` or `oracle/` beside the project ($MIMETRA_DATA names another place
/// for `data/`). Real models and independent results are not part of the project.
inline std::filesystem::path shared_path(const std::filesystem::path& relative) {
  const char* data = std::getenv("MIMETRA_DATA");
  if (data && *relative.begin() == "data") {
    return std::filesystem::path(data) / relative.lexically_relative("data");
  }
  return std::filesystem::path(MIMETRA_SHARED_FOLDER) / relative;
}

}  // namespace mimetra::test

/// Skips the running test where `path` is not there.
#define MIMETRA_SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not there"
