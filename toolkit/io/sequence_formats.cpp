#include <algorithm>

#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

// Each in the file of its name.
SequenceFormat gltf_format(), mdd_format(), npy_format(), npz_format(), pc2_format(),
    splocs_format(), usd_format();
SequenceFormat mesh_format(MeshFormat format);

const std::vector<SequenceFormat>& sequence_formats() {
  static const std::vector<SequenceFormat> formats = {npy_format(),
                                                      npz_format(),
                                                      pc2_format(),
                                                      mdd_format(),
                                                      splocs_format(),
                                                      gltf_format(),
                                                      usd_format(),
                                                      mesh_format(MeshFormat::ply),
                                                      mesh_format(MeshFormat::obj),
                                                      mesh_format(MeshFormat::off),
                                                      mesh_format(MeshFormat::stl),
                                                      mesh_format(MeshFormat::om)};
  return formats;
}

const SequenceFormat* sequence_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const auto& formats = sequence_formats();
  const auto found = std::ranges::find_if(formats, [&extension](const SequenceFormat& format) {
    return std::ranges::find(format.extensions, extension) != format.extensions.end();
  });
  return found == formats.end() ? nullptr : &*found;
}

std::vector<std::string> sequence_extensions() {
  std::vector<std::string> all;
  for (const SequenceFormat& format : sequence_formats()) {
    all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  }
  return all;
}

}  // namespace mimetra
