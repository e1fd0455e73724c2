#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

/// Readers that libFuzzer feeds with damaged files. A target is an object of a .cpp file:
///
///   const Target kObj({"obj", "mesh.obj",
///                      [](const fs::path& file) { read_mesh(file); },
///                      [](const fs::path& file) { write_mesh(file, grid()); }});
namespace mimetra::fuzz {

namespace fs = std::filesystem;

struct TargetDescription {
  std::string name;
  std::string file;  ///< what the reader finds the bytes under
  /// Reads it. It may throw what readers promise: std::invalid_argument, IoError, OutputError.
  std::function<void(const fs::path& file)> read;
  /// Writes a sound file of the format, to start from.
  std::function<void(const fs::path& file)> write;
};

/// Known to the program as long as it runs.
class Target {
 public:
  explicit Target(TargetDescription description);
};

/// 3 x 3 vertices, eight triangles.
const TriMesh& grid();
/// Three frames of it.
MeshSequence take();

}  // namespace mimetra::fuzz
