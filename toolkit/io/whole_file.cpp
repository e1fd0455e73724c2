#include "toolkit/io/whole_file.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "toolkit/io/binary_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw IoError(path.string(), "no such file");
  }
  if (fs::is_directory(status)) {
    throw IoError(path.string(), "is a folder, expected a file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string(), "cannot be read: " + last_reason());
  // One byte more than the file has, to meet its end at the first reading. A pipe has no size: it
  // is read to its end, whatever the size says.
  constexpr std::uintmax_t kPipeBlock = 1 << 16;
  const std::uintmax_t known = fs::is_regular_file(status) ? fs::file_size(path, error) : 0;
  const auto block = static_cast<std::size_t>(std::max(error ? 0 : known + 1, kPipeBlock));
  std::string content;
  while (file) {
    const std::size_t size = content.size();
    content.resize(size + block);
    file.read(content.data() + size, static_cast<std::streamsize>(block));
    content.resize(size + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw IoError(path.string(), "cannot be read: " + last_reason());
  return content;
}

void write_bytes(const fs::path& path, std::string_view content) {
  OutputFile file(path);
  file.write({content});
  file.close();
}

}  // namespace mimetra
