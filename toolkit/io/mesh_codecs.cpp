#include "toolkit/io/mesh_codecs.h"

#include <algorithm>
#include <array>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr std::array kCodecs = {MeshCodec{MeshFormat::obj, read_obj, obj_layout, obj_frame},
                                MeshCodec{MeshFormat::ply, read_ply, ply_layout, ply_frame},
                                MeshCodec{MeshFormat::off, read_off, off_layout, off_frame},
                                MeshCodec{MeshFormat::stl, nullptr, nullptr, stl_frame}};

}  // namespace

std::string MeshCodec::extension() const {
  return '.' + std::string(choice_name(format));
}

const MeshCodec* mesh_codec(const std::string& extension) {
  const auto found = std::ranges::find(kCodecs, lower_case(extension), &MeshCodec::extension);
  return found == kCodecs.end() ? nullptr : &*found;
}

}  // namespace mimetra
