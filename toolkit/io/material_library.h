#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

/// The .mtl files that OBJ files name.
namespace mimetra {

/// Those that `mesh` names in its `mtllib` statements, as they lie beside it. What is no file that
/// ends in .mtl, or cannot be read, is missing. Null for no statements.
std::shared_ptr<const Materials> read_materials(const std::filesystem::path& mesh,
                                                const std::vector<std::string>& statements);

/// How materials go with OBJ files that are written.
struct WrittenMaterials {
  /// What the files' `mtllib` names; empty where there are no materials.
  std::string name;
  /// Text of the file of that name beside them; none where it lies there already.
  std::optional<std::string> text;
  /// What is to be said: textures that stay where they are, and materials that are missing.
  std::vector<std::string> notes;
};

/// For OBJ files in `folder`. A library keeps its name in a folder of its own; beside a single mesh
/// it is called `stem`.mtl. Relative paths of textures are made to lead to where they lie.
WrittenMaterials materials_in_folder(const Connectivity& connectivity,
                                     const std::filesystem::path& folder);
WrittenMaterials materials_beside(const Connectivity& connectivity,
                                  const std::filesystem::path& mesh);

/// The same mesh, whose OBJ files name a library.
Connectivity with_library(const Connectivity& connectivity, const std::string& name);

}  // namespace mimetra
