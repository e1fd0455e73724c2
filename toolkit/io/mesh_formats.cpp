#include "toolkit/io/mesh_formats.h"

#include <algorithm>

#include "toolkit/mesh/choice.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

bool is_mesh_extension(const std::string& extension) {
  const std::vector<std::string> all = mesh_extensions();
  return std::ranges::find(all, lower_case(extension)) != all.end();
}

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> extensions = choice_names<MeshFormat>();
  for (std::string& extension : extensions) extension.insert(0, ".");
  return extensions;
}

std::string unknown_mesh_extension(const std::string& extension) {
  return (extension.empty() ? "has no extension" : "'" + extension + "' is no mesh format") +
         "; expected " + joined(mesh_extensions(), ", ", " or ");
}

}  // namespace mimetra
