#include "toolkit/io/whole_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <vector>

#include "toolkit/io/binary_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

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

bool is_there(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

fs::path without_trailing_slash(fs::path path) {
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

void fail_missing(const std::string& path) {
  if (path == "-") {
    throw IoError(path, "standard input is not read; expected a file or folder of that name");
  }
  const std::string message = "no such file or folder";
  const fs::path named = (fs::path(path) / "").parent_path();
  std::vector<std::string> names;
  std::error_code unreadable;
  for (fs::directory_iterator entry(named.has_parent_path() ? named.parent_path() : ".",
                                    unreadable);
       !unreadable && entry != fs::directory_iterator(); entry.increment(unreadable)) {
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  // Short names are similar to any other, and a hidden file is seldom meant.
  constexpr std::size_t kTelling = 3;
  const std::string asked = named.filename().string();
  if (!asked.starts_with('.')) {
    std::erase_if(names, [](const std::string& name) { return name.starts_with('.'); });
  }
  // Compare stems, since files of one kind share their extension.
  const std::string stem = named.stem().string();
  std::erase_if(names, [&stem](const std::string& name) {
    return nearest_word(stem, {fs::path(name).stem().string()}).empty();
  });
  const std::string nearest = asked.size() < kTelling ? "" : nearest_word(asked, names);
  if (nearest.empty()) throw IoError(path, message);
  throw IoError(path,
                message + "; did you mean '" + (named.parent_path() / nearest).string() + "'?");
}

namespace {

constexpr std::string_view kExport =
    "; export it as OBJ or PLY files, one a frame, as glTF (.glb), or as a point cache (.pc2, "
    ".mdd) with option 'topology'";
constexpr std::string_view kVideo =
    "; 'mimetra fit VIDEO --model MODEL -o take/' makes a sequence of the face in it";
constexpr std::string_view kImage = "; 'mimetra fit' makes a sequence of images";
constexpr std::string_view kUnpack = "; unpack it first";
constexpr std::string_view kWeights =
    "; as blendshape weights it drives a model: name the model, with option 'weights' and this "
    "file";

struct Kind {
  std::string_view extensions;  ///< each surrounded by blanks
  std::string_view name;
  std::string_view remedy;
};

constexpr std::array kKinds = {
    Kind{" .fbx ", "an FBX scene", kExport},
    Kind{" .abc ", "an Alembic cache", kExport},
    Kind{" .usd .usda .usdc .usdz ", "a USD scene", kExport},
    Kind{" .blend ", "a scene of Blender",
         "; mimetra's add-on works on it in Blender, or export it as OBJ files or a point cache"},
    Kind{" .ma .mb ", "a scene of Maya", kExport},
    Kind{" .max .3ds ", "a scene of 3ds Max", kExport},
    Kind{" .c4d ", "a scene of Cinema 4D", kExport},
    Kind{" .dae ", "a COLLADA scene", kExport},
    Kind{" .gltf .glb ", "a glTF scene", kExport},
    Kind{" .3mf .x3d .wrl .ztl .lwo ", "a scene", kExport},
    Kind{" .mp4 .mov .avi .mkv .webm .m4v .mpg .mpeg .wmv ", "a video", kVideo},
    Kind{" .png .jpg .jpeg .tif .tiff .exr .bmp .webp .heic .gif ", "an image", kImage},
    Kind{" .zip .7z .rar .gz .tgz .tar .bz2 .xz .zst ", "an archive", kUnpack},
    Kind{" .csv ", "a table", kWeights},
    Kind{" .json ", "JSON", kWeights},
    Kind{" .mtl ", "a file of materials", "; name the .obj file that it belongs to"},
};

const Kind* kind_of(const std::string& extension) {
  const auto found = std::ranges::find_if(kKinds, [&extension](const Kind& kind) {
    return kind.extensions.find(' ' + extension + ' ') != std::string_view::npos;
  });
  return found == kKinds.end() ? nullptr : &*found;
}

}  // namespace

std::string_view kind_of_file(const fs::path& path) {
  const Kind* kind = kind_of(lower_extension(path));
  return kind ? kind->name : "";
}

std::string foreign_file(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension.empty()) return {};
  if (const Kind* kind = kind_of(extension)) return std::string(kind->name).append(kind->remedy);
  std::error_code unreadable;
  if (!fs::is_regular_file(path, unreadable)) return {};
  // Other programs may give glTF files another extension.
  std::array<char, 4> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != "glTF") return {};
  return "glTF by its first bytes; give it a name that ends in .glb";
}

}  // namespace mimetra
