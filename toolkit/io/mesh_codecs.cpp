#include "toolkit/io/mesh_codecs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "toolkit/io/text_cursor.h"
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
    // STL renumbers the vertices, so a rest pose in the old order would not fit.
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
              read_om_fields}};

}  // namespace

std::string MeshCodec::extension() const {
  return '.' + std::string(choice_name(format));
}

const MeshCodec* mesh_codec(const std::string& extension) {
  const auto found = std::ranges::find(kCodecs, lower_case(extension), &MeshCodec::extension);
  return found == kCodecs.end() ? nullptr : &*found;
}

HeldParts parts_held_by(MeshFormat format) {
  return std::ranges::find(kCodecs, format, &MeshCodec::format)->holds;
}

bool fits_single_precision(const TextureCoordinates& texture) {
  return std::ranges::all_of(texture.coordinates, [](const Eigen::Vector2d& uv) {
    const double farthest = uv.cwiseAbs().maxCoeff();
    return farthest <= kLargestSingle || !std::isfinite(farthest);
  });
}

std::string position_lines(std::string_view before, const PositionsView& positions,
                           bool double_precision) {
  const std::size_t longest = before.size() + 3 * (kMostDigits + 1);
  std::string text(longest * static_cast<std::size_t>(positions.rows()), ' ');
  char* at = text.data();
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    at = std::copy(before.begin(), before.end(), at);
    for (int axis = 0; axis < 3; ++axis) {
      at = put_number(at, positions(vertex, axis), double_precision);
      *at++ = axis < 2 ? ' ' : '\n';
    }
  }
  text.resize(static_cast<std::size_t>(at - text.data()));
  return text;
}

}  // namespace mimetra
