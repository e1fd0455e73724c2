#include <algorithm>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

bool is_textured_by_corner(const Connectivity& connectivity) {
  return !connectivity.texture.coordinates.empty() && !is_textured_by_vertex(connectivity);
}

/// True if a byte can count the corners of every polygon, which all readers expect. Corners with
/// texture coordinates need two numbers each.
bool bytes_suffice(const Connectivity& connectivity) {
  const Polygons& polygons = connectivity.polygons;
  const int most = is_textured_by_corner(connectivity) ? 255 / 2 : 255;
  for (int face = 0; face < polygons.size(); ++face) {
    if (polygons.offsets[face + 1] - polygons.offsets[face] > most) return false;
  }
  return true;
}

std::string header(const Connectivity& connectivity, bool double_precision) {
  const std::string scalar = double_precision ? "double" : "float";
  const std::string count = bytes_suffice(connectivity) ? "uchar" : "uint";
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(connectivity.vertices) + '\n';
  for (const char* axis : {"x", "y", "z"}) text += "property " + scalar + ' ' + axis + '\n';
  if (is_textured_by_vertex(connectivity)) {
    for (const char* axis : {"s", "t"}) text += "property " + scalar + ' ' + axis + '\n';
  }
  text += "element face " + std::to_string(connectivity.polygons.size()) + "\nproperty list " +
          count + " int vertex_indices\n";
  // The form that MeshLab uses.
  if (is_textured_by_corner(connectivity)) {
    text += "property list " + count + ' ' + scalar + " texcoord\n";
  }
  return text + "end_header\n";
}

/// Bytes of x y z s t of each vertex.
template <typename Scalar>
std::string textured_bytes(const PositionsView& positions,
                           const std::vector<Eigen::Vector2d>& texture) {
  std::string bytes(5 * sizeof(Scalar) * texture.size(), '\0');
  char* at = bytes.data();
  const auto put = [&at](double value) {
    put_little_endian(at, static_cast<Scalar>(value));
    at += sizeof(Scalar);
  };
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    for (int axis = 0; axis < 3; ++axis) put(positions(vertex, axis));
    for (const double value : texture[static_cast<std::size_t>(vertex)]) put(value);
  }
  return bytes;
}

/// Appends a face's list of two numbers for each corner, or an empty list if a corner has no
/// texture coordinates.
template <typename Count, typename Scalar>
void append_texture(std::string& bytes, const TextureCoordinates& texture, int first, int last) {
  const auto begin = texture.corners.begin();
  const bool is_whole = std::all_of(begin + first, begin + last, [](int at) { return at >= 0; });
  append_little_endian(bytes, static_cast<Count>(is_whole ? 2 * (last - first) : 0));
  for (int corner = first; is_whole && corner < last; ++corner) {
    for (const double value : texture.coordinates[static_cast<std::size_t>(begin[corner])]) {
      append_little_endian(bytes, static_cast<Scalar>(value));
    }
  }
}

template <typename Count, typename Scalar>
std::string face_bytes(const Connectivity& connectivity, const Context& context) {
  const Polygons& polygons = connectivity.polygons;
  const bool textured = is_textured_by_corner(connectivity);
  std::string bytes;
  for (int face = 0; face < polygons.size(); ++face) {
    report_element(context, face, polygons.size() - face, polygons.size());
    const int first = polygons.offsets[face], last = polygons.offsets[face + 1];
    append_little_endian(bytes, static_cast<Count>(last - first));
    for (int corner = first; corner < last; ++corner) {
      append_little_endian(bytes, static_cast<std::int32_t>(polygons.corners[corner]));
    }
    if (textured) append_texture<Count, Scalar>(bytes, connectivity.texture, first, last);
  }
  return bytes;
}

template <typename Scalar>
MeshFrame frame(const Connectivity& connectivity, std::string before, const Context& context) {
  MeshFrame result;
  result.before = std::move(before);
  result.after = bytes_suffice(connectivity)
                     ? face_bytes<std::uint8_t, Scalar>(connectivity, context)
                     : face_bytes<std::uint32_t, Scalar>(connectivity, context);
  result.positions = position_bytes<Scalar>;
  if (is_textured_by_vertex(connectivity)) {
    result.positions = [texture = connectivity.texture.coordinates](const PositionsView& poses) {
      return textured_bytes<Scalar>(poses, texture);
    };
  }
  return result;
}

}  // namespace

MeshFrame ply_frame(const Connectivity& connectivity, const std::vector<Field>&,
                    bool double_precision, const Context& context) {
  double_precision = double_precision || !fits_single_precision(connectivity.texture);
  std::string before = header(connectivity, double_precision);
  return double_precision ? frame<double>(connectivity, std::move(before), context)
                          : frame<float>(connectivity, std::move(before), context);
}

}  // namespace mimetra
