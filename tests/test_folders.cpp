#include "tests/test_folders.h"

#include <cstdlib>

namespace mimetra::test {

std::filesystem::path source_folder() {
  return MIMETRA_SOURCE_FOLDER;
}

std::filesystem::path shared_path(const std::filesystem::path& relative) {
  const char* data = std::getenv("MIMETRA_DATA");
  if (data && *relative.begin() == "data") {
    return std::filesystem::path(data) / relative.lexically_relative("data");
  }
  return source_folder().parent_path() / "shared" / relative;
}

}  // namespace mimetra::test
