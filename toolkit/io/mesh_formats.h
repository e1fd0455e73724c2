#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mimetra {

enum class MeshFormat { ply, obj, off, stl, om };

/// As people choose it; with a dot before it, its extension.
constexpr std::string_view choice_name(MeshFormat value) {
  switch (value) {
    case MeshFormat::ply:
      return "ply";
    case MeshFormat::obj:
      return "obj";
    case MeshFormat::off:
      return "off";
    case MeshFormat::stl:
      return "stl";
    case MeshFormat::om:
      return "om";
  }
  return {};
}

/// True for an extension (".obj") of a mesh format, in any case.
bool is_mesh_extension(const std::string& extension);
/// All of them, in lower case.
std::vector<std::string> mesh_extensions();
/// What is wrong with an extension in lower case that is_mesh_extension() refuses.
std::string unknown_mesh_extension(const std::string& extension);

}  // namespace mimetra
