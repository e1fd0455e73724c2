#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

/// Material libraries (.mtl) of OBJ files.
namespace mimetra {

/// Reads the libraries in the `mtllib` statements of `mesh`, relative to its folder. Files that do
/// not end in .mtl, or that cannot be read, are listed as missing. Null if there are no statements.
std::shared_ptr<const Materials> read_materials(const std::filesystem::path& mesh,
                                                const std::vector<std::string>& statements);

/// Material library to write with OBJ files.
struct WrittenMaterials {
  /// Name for the files' `mtllib`; empty if there are no materials.
  std::string name;
  /// Content of the file of that name beside them; none if the file exists already.
  std::optional<std::string> text;
  /// Messages for the user: textures that stay in their folder, and missing materials.
  std::vector<std::string> notes;
};

/// Materials for OBJ files in `folder`, or for the single file `mesh`. In a folder the library
/// keeps its name; beside a mesh it is named after the mesh, as `STEM.mtl`. Relative texture paths
/// are changed so that they still lead to the textures.
WrittenMaterials materials_in_folder(const Connectivity& connectivity,
                                     const std::filesystem::path& folder);
WrittenMaterials materials_beside(const Connectivity& connectivity,
                                  const std::filesystem::path& mesh);

/// Copy of `connectivity` whose OBJ files refer to the library `name`.
Connectivity with_library(const Connectivity& connectivity, const std::string& name);

}  // namespace mimetra
