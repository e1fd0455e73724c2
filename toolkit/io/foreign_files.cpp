#include "toolkit/io/foreign_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "toolkit/mesh/text.h"

namespace mimetra {
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
  std::string_view extensions;  ///< each between blanks
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

}  // namespace

std::string foreign_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension.empty()) return {};
  const auto found = std::ranges::find_if(kKinds, [&extension](const Kind& kind) {
    return kind.extensions.find(' ' + extension + ' ') != std::string_view::npos;
  });
  if (found != kKinds.end()) return std::string(found->name).append(found->remedy);
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return {};
  // Another program's name for it.
  std::array<char, 4> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != "glTF") return {};
  return "glTF by its first bytes; give it a name that ends in .glb";
}

}  // namespace mimetra
