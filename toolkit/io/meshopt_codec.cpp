#include "toolkit/io/meshopt_codec.h"

#include <meshoptimizer.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using MeshoptMode = GltfCompression::Mode;
using MeshoptFilter = GltfCompression::Filter;

/// What the library takes for granted. [EXT_meshopt_compression]
bool has_sound_layout(const GltfCompression& view) {
  const std::size_t stride = view.stride;
  if (view.mode != MeshoptMode::attributes) {
    return (stride == 2 || stride == 4) && view.filter == MeshoptFilter::none &&
           (view.mode == MeshoptMode::indices || view.count % 3 == 0);
  }
  if (view.filter == MeshoptFilter::octahedral && stride != 4 && stride != 8) return false;
  if (view.filter == MeshoptFilter::quaternion && stride != 8) return false;
  return stride > 0 && stride <= 256 && stride % 4 == 0;
}

/// Elements that as many bytes can hold at most: 16 equal bytes of attributes take two bits, and a
/// triangle one byte at least.
bool may_hold(const GltfCompression& view, std::size_t bytes) {
  const std::size_t most = view.mode == MeshoptMode::attributes
                               ? 64 * bytes / view.stride + 256  // a block may be half empty
                               : 3 * bytes;
  return view.count > 0 && view.count <= most;
}

int decode_meshopt(const GltfCompression& view, std::string_view bytes, std::string& to) {
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  switch (view.mode) {
    case MeshoptMode::attributes:
      return meshopt_decodeVertexBuffer(to.data(), view.count, view.stride, from, bytes.size());
    case MeshoptMode::triangles:
      return meshopt_decodeIndexBuffer(to.data(), view.count, view.stride, from, bytes.size());
    case MeshoptMode::indices:
      return meshopt_decodeIndexSequence(to.data(), view.count, view.stride, from, bytes.size());
  }
  return -1;
}

void apply_filter(const GltfCompression& view, std::string& bytes) {
  switch (view.filter) {
    case MeshoptFilter::none:
      break;
    case MeshoptFilter::octahedral:
      meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
      break;
    case MeshoptFilter::quaternion:
      meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
      break;
    case MeshoptFilter::exponential:
      meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
      break;
  }
}

}  // namespace

std::string decompressed(const std::string& path, const std::string& what,
                         const GltfCompression& compression, std::string_view bytes) {
  if (!has_sound_layout(compression)) {
    throw IoError(path, what + ": no compressed view has " + std::to_string(compression.count) +
                            " elements of " + std::to_string(compression.stride) +
                            " bytes in this mode");
  }
  if (!may_hold(compression, bytes.size())) {
    throw IoError(path, what + ": " + std::to_string(bytes.size()) + " bytes cannot hold " +
                            std::to_string(compression.count) + " elements");
  }
  std::string values(compression.count * compression.stride, '\0');
  if (decode_meshopt(compression, bytes, values) != 0) {
    throw IoError(path, what + " cannot be decompressed: it is damaged or of a newer version");
  }
  apply_filter(compression, values);
  return values;
}

}  // namespace mimetra
