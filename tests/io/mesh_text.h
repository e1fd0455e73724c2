#pragma once

#include <string>

#include "tests/temporary_folder.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

/// Mesh files by their bytes.
namespace mimetra::test {

inline TriMesh read_text(const std::string& extension, const std::string& text) {
  const TemporaryFolder folder;
  write_bytes(folder / ("mesh" + extension), text);
  return read_mesh(folder / ("mesh" + extension));
}

/// What reading it throws.
inline std::string error_of(const std::string& extension, const std::string& text) {
  return message_of<IoError>([&] { read_text(extension, text); });
}

}  // namespace mimetra::test
