#include "toolkit/io/material_library.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Replaces the '\' that Windows writes in paths by '/'.
std::string with_slashes(std::string path) {
  std::ranges::replace(path, '\\', '/');
  return path;
}

/// Content of a library. None for files that are not .mtl, cannot be read, or exceed 16 MB, since
/// libraries are small texts.
std::optional<std::string> text_of_library(const fs::path& path) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{16} << 20;
  std::error_code error;
  if (lower_extension(path) != ".mtl" || !fs::is_regular_file(path, error)) return std::nullopt;
  if (const auto size = fs::file_size(path, error); error || size > kMostBytes) {
    return std::nullopt;
  }
  try {
    return read_file(path);
  } catch (const IoError&) {
    return std::nullopt;  // written() reports it as missing
  }
}

/// A statement holds one file name, which may contain spaces, or several names.
void add_libraries(Materials& materials, const fs::path& folder, const std::string& statement) {
  const auto add = [&](const std::string& name) {
    const fs::path path = folder / with_slashes(name);
    std::optional<std::string> text = text_of_library(path);
    if (!text) return false;
    materials.libraries.push_back({path, *std::move(text)});
    return true;
  };
  if (add(statement)) return;
  const std::string unnamed;
  TextCursor words(unnamed, statement, {});
  for (std::string word(words.word()); !word.empty(); word = words.word()) {
    if (!add(word)) materials.missing.push_back(word);
  }
}

bool names_texture(std::string_view keyword) {
  static constexpr std::array<std::string_view, 7> kOthers = {"bump", "disp", "decal",   "refl",
                                                              "norm", "map",  "refl_map"};
  return keyword.starts_with("map_") || std::ranges::find(kOthers, keyword) != kOthers.end();
}

/// Largest number of words after an option of a texture. Options with several words take numbers
/// only, and may have fewer of them.
int words_after(std::string_view option) {
  if (option == "-o" || option == "-s" || option == "-t") return 3;
  return option == "-mm" ? 2 : 1;
}

bool is_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

/// Offset of a texture's path in a line of a library; npos if the line has none.
std::size_t path_in(const std::string& line) {
  const std::string unnamed;
  TextCursor cursor(unnamed, line, {});
  if (!names_texture(lower_case(std::string(cursor.word())))) return std::string::npos;
  std::string_view word = cursor.word();
  while (word.size() > 1 && word[0] == '-') {
    const std::string_view option = word;
    word = cursor.word();
    const bool only_numbers = words_after(option) > 1;
    for (int i = 0; i < words_after(option) && (!only_numbers || is_number(word)); ++i) {
      word = cursor.word();
    }
  }
  return word.empty() ? std::string::npos : static_cast<std::size_t>(word.data() - line.data());
}

fs::path place_of_folder(const fs::path& folder) {
  std::error_code unreadable;
  return fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder), unreadable);
}

/// Text of a library for another folder. Adds the changed texture paths to `textures`. All other
/// bytes stay the same.
std::string moved_text(const MaterialLibrary& library, const fs::path& folder,
                       std::vector<std::string>& textures) {
  const fs::path from = place_of_folder(library.path.parent_path()), to = place_of_folder(folder);
  std::string text;
  for (std::size_t at = 0; at < library.text.size();) {
    const std::size_t end = std::min(library.text.find('\n', at), library.text.size() - 1) + 1;
    std::string line = library.text.substr(at, end - at);
    at = end;
    const std::size_t start = path_in(line);
    if (start != std::string::npos) {
      const std::size_t size = line.find_last_not_of(" \t\r\n") + 1 - start;
      const std::string given = with_slashes(line.substr(start, size));
      std::error_code unreadable;
      const fs::path place = fs::weakly_canonical(from / given, unreadable);
      const std::string way = place.lexically_relative(to).generic_string();
      const bool leads_elsewhere = fs::path(given).is_relative() && from != to && way != given;
      if (leads_elsewhere && fs::exists(place, unreadable)) {
        textures.push_back(way);
        line.replace(start, size, way);
      }
    }
    text += line;
  }
  return text;
}

/// `output` is the mesh or folder for the messages.
WrittenMaterials written(const Materials& materials, const fs::path& folder, std::string name,
                         const fs::path& output) {
  WrittenMaterials result;
  std::vector<std::string> textures;
  if (!materials.libraries.empty()) {
    result.name = std::move(name);
    result.text.emplace();
    for (const MaterialLibrary& library : materials.libraries) {
      if (!result.text->empty() && result.text->back() != '\n') *result.text += '\n';
      *result.text += moved_text(library, folder, textures);
    }
  }
  const std::string place = (folder / result.name).string();
  if (!textures.empty()) {
    std::ranges::sort(textures);
    textures.erase(std::unique(textures.begin(), textures.end()), textures.end());
    result.notes.push_back(place +
                           ": its textures stay where they are, so that its paths lead to " +
                           listed(textures, 3));
  }
  if (!materials.missing.empty()) {
    result.notes.push_back(output.string() + ": without the materials of " +
                           listed(materials.missing, 3) +
                           ", which the source names and which is not beside it");
  }
  return result;
}

}  // namespace

std::shared_ptr<const Materials> read_materials(const fs::path& mesh,
                                                const std::vector<std::string>& statements) {
  if (statements.empty()) return nullptr;
  auto materials = std::make_shared<Materials>();
  for (const std::string& statement : statements) {
    add_libraries(*materials, mesh.parent_path(), statement);
  }
  return materials;
}

WrittenMaterials materials_in_folder(const Connectivity& connectivity, const fs::path& folder) {
  const auto& materials = connectivity.materials;
  if (!materials) return {};
  const auto& libraries = materials->libraries;
  return written(*materials, folder,
                 libraries.empty() ? "" : libraries.front().path.filename().string(), folder);
}

WrittenMaterials materials_beside(const Connectivity& connectivity, const fs::path& mesh) {
  const auto& materials = connectivity.materials;
  if (!materials) return {};
  const fs::path folder = mesh.parent_path();
  WrittenMaterials result = written(*materials, folder, mesh.stem().string() + ".mtl", mesh);
  const auto& libraries = materials->libraries;
  const bool lies_there =
      libraries.size() == 1 &&
      place_of_folder(libraries.front().path.parent_path()) == place_of_folder(folder);
  if (lies_there) {
    result.name = libraries.front().path.filename().string();
    result.text.reset();
  }
  return result;
}

Connectivity with_library(const Connectivity& connectivity, const std::string& name) {
  Connectivity result = connectivity;
  if (!name.empty()) result.groups.insert(result.groups.begin(), {0, "mtllib " + name});
  return result;
}

}  // namespace mimetra
