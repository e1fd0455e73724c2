#include "toolkit/io/whole_file.h"

#include "toolkit/io/binary_file.h"
#include "toolkit/io/opened_file.h"

namespace mimetra {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  return OpenedFile(path).rest();
}

void write_bytes(const fs::path& path, std::string_view content) {
  OutputFile file(path);
  file.write({content});
  file.close();
}

}  // namespace mimetra
