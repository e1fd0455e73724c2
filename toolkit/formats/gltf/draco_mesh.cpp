#include "toolkit/formats/gltf/gltf_values.h"

#include <algorithm>
#include <cstdint>
#include <new>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include "toolkit/formats/gltf/scene.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

/// Values of an attribute (points x components), decoded as `Number`. Integers are decoded as
/// integers, because Draco would scale some of them when it converts them to floats.
template <typename Number>
Frames draco_values(const std::string& path, const std::string& what, const draco::Mesh& mesh,
                    const draco::PointAttribute& attribute, int components) {
  // Draco would load the bytes as bool, whatever their values are.
  const bool is_of_numbers = attribute.data_type() != draco::DT_BOOL;
  Frames values(mesh.num_points(), components);
  Number element[4] = {};
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    if (!is_of_numbers ||
        !attribute.ConvertValue<Number>(attribute.mapped_index(point),
                                        static_cast<int8_t>(components), element)) {
      throw IoError(path, what + ": its compressed mesh has no number for a vertex");
    }
    for (int c = 0; c < components; ++c) {
      values(point.value(), c) = static_cast<double>(element[c]);
    }
  }
  return values;
}

Frames draco_values(const std::string& path, const std::string& what, const draco::Mesh& mesh,
                    const draco::PointAttribute& attribute, int components) {
  const bool is_real =
      attribute.data_type() == draco::DT_FLOAT32 || attribute.data_type() == draco::DT_FLOAT64;
  return is_real ? draco_values<float>(path, what, mesh, attribute, components)
                 : draco_values<std::int64_t>(path, what, mesh, attribute, components);
}

DracoMesh draco_parts(const std::string& path, const std::string& what, const draco::Mesh& mesh,
                      const GltfDraco& draco) {
  const auto attribute = [&mesh](std::optional<std::size_t> id) {
    return id ? mesh.GetAttributeByUniqueId(static_cast<uint32_t>(*id)) : nullptr;
  };
  const auto* positions = attribute(draco.positions);
  if (!positions) throw IoError(path, what + ": its compressed mesh has no positions");
  DracoMesh parts{
      Triangles(mesh.num_faces(), 3), draco_values(path, what, mesh, *positions, 3), {}, {}};
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto point = mesh.face(face)[static_cast<std::size_t>(corner)].value();
      if (point >= mesh.num_points()) throw IoError(path, what + ": a face has no such vertex");
      parts.triangles(face.value(), corner) = static_cast<int>(point);
    }
  }
  if (const Eigen::Index v = first_unusable(parts.positions); v >= 0) {
    throw IoError(path, what + ": vertex " + std::to_string(v) + " has no usable position");
  }
  const auto held = [&](std::optional<std::size_t> id, const char* name, int components) {
    Frames values;
    if (!id) return values;
    const auto* values_of = attribute(id);
    if (!values_of) throw IoError(path, what + ": its compressed mesh has no " + name);
    values = draco_values(path, what, mesh, *values_of, components);
    if (!values.allFinite()) throw IoError(path, what + ": its " + name + " are not finite");
    return values;
  };
  parts.texture = held(draco.texture, "texture coordinates", 2);
  for (const auto& [joints, weights] : draco.joints) {
    parts.joints.push_back({held(joints, "joints", 4), held(weights, "weights of joints", 4)});
  }
  return parts;
}

/// Takes a count off Draco's stream: seven bits a byte, the lowest first.
std::uint64_t take_count(std::string_view& bytes) {
  std::uint64_t count = 0;
  for (int shift = 0; shift < 63 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    count |= static_cast<std::uint64_t>(byte & 127) << shift;
    if (byte < 128) break;
  }
  return count;
}

/// Checks what Draco does not. Draco also reads versions older than glTF's, in which damage does
/// more harm, and allocates as many faces as the file claims. [KHR_draco_mesh_compression; Draco
/// bitstream 2.2]
void check_header(const std::string& path, const std::string& what, std::string_view bytes) {
  constexpr std::size_t kHeader = 11, kMajor = 5, kMinor = 6, kMethod = 8, kFlags = 10;
  if (bytes.size() < kHeader) return;  // Draco reports the truncation
  const int major = static_cast<unsigned char>(bytes[kMajor]);
  const int minor = static_cast<unsigned char>(bytes[kMinor]);
  if (major < 2 || (major == 2 && minor < 2)) {
    throw IoError(path, what + " cannot be decompressed: it has version " + std::to_string(major) +
                            '.' + std::to_string(minor) + " of Draco's stream, expected 2.2");
  }
  constexpr int kHasMetadata = 0x80;  // metadata precede the counts
  if ((bytes[kFlags] & kHasMetadata) != 0) return;
  const std::size_t size = bytes.size();
  const bool is_edgebreaker = bytes[kMethod] == 1;
  bytes.remove_prefix(kHeader);
  if (is_edgebreaker) {
    bytes.remove_prefix(std::min<std::size_t>(1, bytes.size()));  // traversal method
    take_count(bytes);                                            // number of vertices
  }
  // The limit counts a face like the position of a vertex.
  check_scene_size(path + ": " + what, static_cast<double>(take_count(bytes)), 1, size);
}

}  // namespace

DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco& draco,
                       std::string_view bytes) {
  check_header(path, what, bytes);
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  try {
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) {
      throw IoError(path, what + " cannot be decompressed: " + mesh.status().error_msg_string());
    }
    return draco_parts(path, what, *mesh.value(), draco);
  } catch (const std::bad_alloc&) {
    throw IoError(path, what + " cannot be decompressed: its counts are larger than memory");
  }
}

}  // namespace mimetra
