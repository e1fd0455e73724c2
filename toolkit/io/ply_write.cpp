#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_codecs.h"

namespace mimetra {
namespace {

/// A byte counts the corners, as every reader expects, unless some polygon has too many.
bool bytes_suffice(const Polygons& polygons) {
  for (int face = 0; face < polygons.size(); ++face) {
    if (polygons.offsets[face + 1] - polygons.offsets[face] > 255) return false;
  }
  return true;
}

std::string header(int vertices, const Polygons& polygons, bool double_precision) {
  const std::string scalar = double_precision ? "double" : "float";
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty " + scalar + " x\nproperty " + scalar + " y\nproperty " + scalar +
         " z\nelement face " + std::to_string(polygons.size()) + "\nproperty list " +
         (bytes_suffice(polygons) ? "uchar" : "uint") + " int vertex_indices\nend_header\n";
}

template <typename Scalar>
std::string position_bytes(const PositionsView& positions) {
  std::string bytes(sizeof(Scalar) * static_cast<std::size_t>(positions.size()), '\0');
  char* at = bytes.data();
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    for (int axis = 0; axis < 3; ++axis, at += sizeof(Scalar)) {
      put_little_endian(at, static_cast<Scalar>(positions(vertex, axis)));
    }
  }
  return bytes;
}

template <typename Count>
void append_faces(std::string& bytes, const Polygons& polygons) {
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face], last = polygons.offsets[face + 1];
    append_little_endian(bytes, static_cast<Count>(last - first));
    for (int corner = first; corner < last; ++corner) {
      append_little_endian(bytes, static_cast<std::int32_t>(polygons.corners[corner]));
    }
  }
}

}  // namespace

MeshFrame ply_frame(const Connectivity& connectivity, bool double_precision) {
  const Polygons& polygons = connectivity.polygons;
  std::string after;
  if (bytes_suffice(polygons)) {
    append_faces<std::uint8_t>(after, polygons);
  } else {
    append_faces<std::uint32_t>(after, polygons);
  }
  return {header(connectivity.vertices, polygons, double_precision), std::move(after),
          double_precision ? position_bytes<double> : position_bytes<float>};
}

}  // namespace mimetra
