#include "toolkit/io/mesh_codecs.h"

#include <algorithm>
#include <array>

#include "toolkit/io/om_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

using Texture = HeldParts::Texture;

constexpr std::array kCodecs = {
    MeshCodec{MeshFormat::obj,
              read_obj,
              obj_layout,
              obj_frame,
              {.polygons = true, .texture = Texture::corners, .groups = true}},
    MeshCodec{MeshFormat::ply,
              read_ply,
              ply_layout,
              ply_frame,
              {.polygons = true, .texture = Texture::corners}},
    MeshCodec{MeshFormat::off, read_off, off_layout, off_frame, {.polygons = true}},
    // A rest pose in the old order would not fit.
    MeshCodec{MeshFormat::stl,
              nullptr,
              nullptr,
              stl_frame,
              {.rest = false, .vertex_order = false, .exact_positions = false}},
    MeshCodec{MeshFormat::om,
              read_om,
              nullptr,
              om_frame,
              {.polygons = true, .texture = Texture::corners, .bare_faces = false},
              read_om_fields,
              om_properties}};

}  // namespace

std::string MeshCodec::extension() const {
  return '.' + std::string(choice_name(format));
}

const MeshCodec* mesh_codec(const std::string& extension) {
  const auto found = std::ranges::find(kCodecs, lower_case(extension), &MeshCodec::extension);
  return found == kCodecs.end() ? nullptr : &*found;
}

bool is_textured_by_vertex(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  return static_cast<int>(texture.coordinates.size()) == connectivity.vertices &&
         texture.corners == connectivity.polygons.corners;
}

HeldParts parts_held_by(MeshFormat format) {
  return std::ranges::find(kCodecs, format, &MeshCodec::format)->holds;
}

}  // namespace mimetra
