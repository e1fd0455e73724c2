#include "toolkit/io/gltf_values.h"

#include <limits>

#include <meshoptimizer.h>

#include "toolkit/io/bytes.h"
#include "toolkit/io/scene.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

using MeshoptMode = GltfCompression::Mode;
using MeshoptFilter = GltfCompression::Filter;

/// True if the layout meets requirements that meshoptimizer does not check.
/// [EXT_meshopt_compression]
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

/// True if `bytes` can contain all elements of the view. 16 equal bytes of attributes take at least
/// two bits, a triangle at least one byte.
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
    case MeshoptFilter::color:
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
  if (compression.filter == MeshoptFilter::color) {
    throw IoError(path, what + " has the filter COLOR, which is not read; use another filter");
  }
  constexpr std::string_view kSecondVertexCodec = "\xa1";
  if (compression.mode == MeshoptMode::attributes && bytes.starts_with(kSecondVertexCodec)) {
    throw IoError(path, what +
                            " uses version 1 of the vertex codec, and only version 0 is read; "
                            "export it with EXT_meshopt_compression");
  }
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

namespace {

// Component types other than float (5126).
constexpr int kGltfByte = 5120, kGltfUnsignedByte = 5121, kGltfShort = 5122,
              kGltfUnsignedShort = 5123, kGltfUnsignedInt = 5125;

std::size_t gltf_bytes(int type) {
  if (type == kGltfByte || type == kGltfUnsignedByte) return 1;
  return type == kGltfShort || type == kGltfUnsignedShort ? 2 : 4;
}

double gltf_number(const char* at, int type) {
  constexpr auto kOrder = std::endian::little;
  switch (type) {
    case kGltfByte:
      return number_at<std::int8_t>(at, kOrder);
    case kGltfUnsignedByte:
      return number_at<std::uint8_t>(at, kOrder);
    case kGltfShort:
      return number_at<std::int16_t>(at, kOrder);
    case kGltfUnsignedShort:
      return number_at<std::uint16_t>(at, kOrder);
    case kGltfUnsignedInt:
      return number_at<std::uint32_t>(at, kOrder);
    default:
      return number_at<float>(at, kOrder);
  }
}

/// Integer that represents 1 in normalised components. [glTF 2.0, 3.11]
double gltf_one(int type) {
  switch (type) {
    case kGltfByte:
      return 127;
    case kGltfUnsignedByte:
      return 255;
    case kGltfShort:
      return 32767;
    case kGltfUnsignedShort:
      return 65535;
    default:
      return 1;
  }
}

bool is_unsigned(int type) {
  return type == kGltfUnsignedByte || type == kGltfUnsignedShort || type == kGltfUnsignedInt;
}

std::string accessor_name(std::size_t accessor) {
  return "accessors[" + std::to_string(accessor) + ']';
}

}  // namespace

void GltfValues::fail(const std::string& what, const std::string& message) const {
  throw IoError(document_.path, what + ": " + message);
}

std::string_view GltfValues::bytes(std::size_t view) {
  const std::string what = "bufferViews[" + std::to_string(view) + ']';
  const GltfView& stored = document_.views[view];
  const auto part = [&](std::size_t buffer, std::size_t offset, std::size_t size) {
    const auto missing = document_.missing_buffers.find(buffer);
    if (missing != document_.missing_buffers.end()) throw IoError(document_.path, missing->second);
    const std::string_view all = document_.buffers[buffer];
    if (offset > all.size() || size > all.size() - offset) {
      fail(what, "ends at byte " + std::to_string(offset) + " + " + std::to_string(size) +
                     " of a buffer of " + std::to_string(all.size()));
    }
    return all.substr(offset, size);
  };
  if (!stored.compression) return part(stored.buffer, stored.offset, stored.bytes);
  const GltfCompression& compression = *stored.compression;
  auto [known, is_new] = decompressed_.try_emplace(view);
  if (is_new) {
    known->second = decompressed(document_.path, what, compression,
                                 part(compression.buffer, compression.offset, compression.bytes));
    decompressed_bytes_ += known->second.size();
    // Many views may decompress the same bytes, so their sum is checked.
    check_scene_size(document_.path, static_cast<double>(decompressed_bytes_) / 24, 1,
                     document_.file_bytes);
  }
  if (known->second.size() < stored.bytes) {
    fail(what, "holds " + std::to_string(known->second.size()) + " bytes, expected " +
                   std::to_string(stored.bytes));
  }
  return std::string_view(known->second).substr(0, stored.bytes);
}

Frames GltfValues::stored(const std::string& what, const GltfPlace& place, Eigen::Index count,
                          int components, int type) {
  const std::string_view all = bytes(place.view);
  const std::size_t size = gltf_bytes(type), element = static_cast<std::size_t>(components) * size;
  const std::size_t given = document_.views[place.view].stride;
  const std::size_t stride = given > 0 ? given : element;
  if (stride < element) {
    fail(what, "elements of " + std::to_string(element) + " bytes stand " + std::to_string(stride) +
                   " apart");
  }
  const std::size_t held = all.size() - std::min(all.size(), place.offset);
  if (held < element || (held - element) / stride < static_cast<std::size_t>(count - 1)) {
    fail(what, "its " + std::to_string(count) + " elements do not lie within bufferViews[" +
                   std::to_string(place.view) + "] of " + std::to_string(all.size()) + " bytes");
  }
  Frames values(count, components);
  const char* at = all.data() + place.offset;
  for (Eigen::Index i = 0; i < count; ++i, at += stride) {
    for (int c = 0; c < components; ++c) {
      values(i, c) = gltf_number(at + static_cast<std::size_t>(c) * size, type);
    }
    if (i + 1 == count) break;
  }
  return values;
}

void GltfValues::replace_sparse(const std::string& what, const GltfAccessor& accessor,
                                Frames& values) {
  const GltfSparse& sparse = *accessor.sparse;
  if (sparse.count == 0) return;
  if (!is_unsigned(sparse.index_type)) fail(what, "its sparse indices are no counts");
  const auto count = static_cast<Eigen::Index>(sparse.count);
  const Frames places = stored(what + ".sparse", sparse.indices, count, 1, sparse.index_type);
  const Frames given =
      stored(what + ".sparse", sparse.values, count, accessor.components, accessor.type);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double place = places(i, 0);
    if (place >= static_cast<double>(values.rows())) {
      fail(what, "replaces element " + std::to_string(static_cast<std::size_t>(place)) + " of " +
                     std::to_string(values.rows()));
    }
    values.row(static_cast<Eigen::Index>(place)) = given.row(i);
  }
}

Frames GltfValues::read(std::size_t index, int components) {
  const GltfAccessor& accessor = document_.accessors[index];
  const std::string what = accessor_name(index);
  if (accessor.components != components) {
    fail(what, "has " + std::to_string(accessor.components) + " numbers an element, expected " +
                   std::to_string(components));
  }
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 16;
  if (accessor.count > kMost) fail(what, "has " + std::to_string(accessor.count) + " elements");
  const auto count = static_cast<Eigen::Index>(accessor.count);
  Frames values;
  if (accessor.place) {
    values = stored(what, *accessor.place, count, components, accessor.type);
  } else if (accessor.count > document_.file_bytes) {
    fail(what, std::to_string(accessor.count) + " elements of which the file holds nothing");
  } else {
    values = Frames::Zero(count, components);
  }
  if (accessor.sparse) replace_sparse(what, accessor, values);
  values = scaled(index, std::move(values));
  if (!values.allFinite()) fail(what, "holds a number that is not finite");
  return values;
}

Frames GltfValues::scaled(std::size_t index, Frames stored) const {
  const GltfAccessor& accessor = document_.accessors[index];
  if (accessor.normalized) stored = (stored / gltf_one(accessor.type)).cwiseMax(-1);
  return stored;
}

Frames GltfValues::read(std::size_t accessor, int components, Eigen::Index count) {
  const std::size_t held = document_.accessors[accessor].count;
  if (held != static_cast<std::size_t>(count)) {
    fail(accessor_name(accessor),
         "has " + std::to_string(held) + " elements, expected " + std::to_string(count));
  }
  return read(accessor, components);
}

std::vector<int> GltfValues::indices(std::size_t index, Eigen::Index size) {
  const GltfAccessor& accessor = document_.accessors[index];
  if (!is_unsigned(accessor.type) || accessor.normalized) {
    fail(accessor_name(index), "holds no indices");
  }
  const Frames values = read(index, 1);
  std::vector<int> indices;
  indices.reserve(static_cast<std::size_t>(values.rows()));
  for (const double value : values.reshaped<Eigen::RowMajor>()) {
    if (value >= static_cast<double>(size)) {
      fail(accessor_name(index), "names vertex " + std::to_string(static_cast<std::size_t>(value)) +
                                     ", expected 0 to " + std::to_string(size - 1));
    }
    indices.push_back(static_cast<int>(value));
  }
  return indices;
}

}  // namespace mimetra
