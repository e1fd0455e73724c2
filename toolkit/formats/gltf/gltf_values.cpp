#include "toolkit/formats/gltf/gltf_values.h"

#include <limits>

#include <meshoptimizer.h>

#include "toolkit/formats/gltf/scene.h"
#include "toolkit/io/bytes.h"
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

}  // namespace

std::string decompressed(const std::string& path, const std::string& what,
                         const GltfCompression& view, std::string_view bytes) {
  constexpr decltype(&meshopt_decodeVertexBuffer) kDecoders[] = {
      meshopt_decodeVertexBuffer, meshopt_decodeIndexBuffer, meshopt_decodeIndexSequence};
  constexpr decltype(&meshopt_decodeFilterOct) kFilters[] = {
      nullptr, meshopt_decodeFilterOct, meshopt_decodeFilterQuat, meshopt_decodeFilterExp};
  const std::string elements = std::to_string(view.count) + " elements";
  std::string problem, values;
  if (view.filter == MeshoptFilter::color) {
    problem = " has the filter COLOR, which is not read; use another filter";
  } else if (view.mode == MeshoptMode::attributes && bytes.starts_with('\xa1')) {
    problem =
        " uses version 1 of the vertex codec, and only version 0 is read; "
        "export it with EXT_meshopt_compression";
  } else if (!has_sound_layout(view)) {
    problem = ": no compressed view has " + elements + " of " + std::to_string(view.stride) +
              " bytes in this mode";
  } else if (!may_hold(view, bytes.size())) {
    problem = ": " + std::to_string(bytes.size()) + " bytes cannot hold " + elements;
  } else {
    values.resize(view.count * view.stride);
    const auto decode = kDecoders[static_cast<std::size_t>(view.mode)];
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const int error = decode(values.data(), view.count, view.stride, from, bytes.size());
    if (error != 0) problem = " cannot be decompressed: it is damaged or of a newer version";
  }
  if (!problem.empty()) throw IoError(path, what + problem);
  const auto undo = kFilters[static_cast<std::size_t>(view.filter)];
  if (undo) undo(values.data(), view.count, view.stride);
  return values;
}

namespace {

struct GltfNumber {
  std::size_t bytes;
  bool is_index;
  double one;  ///< integer that represents 1 in normalised components [glTF 2.0, 3.11]
  void (*decode)(const char*, std::endian, std::span<double>);
};

template <typename Number>
constexpr GltfNumber gltf_number() {
  constexpr bool kHasOne = sizeof(Number) < 4;
  return {sizeof(Number), std::is_unsigned_v<Number>,
          kHasOne ? static_cast<double>(std::numeric_limits<Number>::max()) : 1,
          decode_numbers<Number>};
}

/// Kinds of numbers, from component type 5120 on. Type 5124 does not exist.
constexpr GltfNumber kGltfNumbers[] = {gltf_number<std::int8_t>(),
                                       gltf_number<std::uint8_t>(),
                                       gltf_number<std::int16_t>(),
                                       gltf_number<std::uint16_t>(),
                                       GltfNumber{},
                                       gltf_number<std::uint32_t>(),
                                       gltf_number<float>()};

const GltfNumber& kind_of(int component_type) {
  return kGltfNumbers[component_type - 5120];
}

}  // namespace

void GltfValues::fail(std::size_t accessor, const std::string& message) const {
  throw IoError(document_.path, "accessors[" + std::to_string(accessor) + "]: " + message);
}

std::string_view GltfValues::bytes(std::size_t index) {
  const std::string what = "bufferViews[" + std::to_string(index) + ']';
  const GltfView& view = document_.views[index];
  const auto& packed = view.compression;
  const GltfBuffer& buffer = document_.buffers[packed ? packed->buffer : view.buffer];
  const std::size_t offset = packed ? packed->offset : view.offset;
  const std::size_t size = packed ? packed->bytes : view.bytes, all = buffer.bytes.size();
  if (!buffer.missing.empty()) throw IoError(document_.path, buffer.missing);
  if (offset > all || size > all - offset) {
    throw IoError(document_.path, what + ": ends at byte " + std::to_string(offset) + " + " +
                                      std::to_string(size) + " of a buffer of " +
                                      std::to_string(all));
  }
  const std::string_view stored = std::string_view(buffer.bytes).substr(offset, size);
  if (!packed) return stored;
  auto [known, is_new] = decompressed_.try_emplace(index);
  std::string& values = known->second;
  if (is_new) {
    values = decompressed(document_.path, what, *packed, stored);
    decompressed_bytes_ += values.size();
    // Many views may decompress the same bytes, so their sum is checked.
    check_scene_size(document_.path, static_cast<double>(decompressed_bytes_) / 24, 1,
                     document_.file_bytes);
  }
  if (values.size() >= view.bytes) return std::string_view(values).substr(0, view.bytes);
  throw IoError(document_.path, what + ": holds " + std::to_string(values.size()) +
                                    " bytes, expected " + std::to_string(view.bytes));
}

Frames GltfValues::stored(std::size_t accessor, const GltfPlace& place, std::size_t count,
                          int components, int type) {
  const std::string_view all = bytes(place.view);
  const GltfNumber& kind = kind_of(type);
  const std::size_t element = static_cast<std::size_t>(components) * kind.bytes;
  const std::size_t given = document_.views[place.view].stride;
  const std::size_t stride = given > 0 ? given : element;
  if (stride < element) {
    fail(accessor, "elements of " + std::to_string(element) + " bytes stand " +
                       std::to_string(stride) + " apart");
  }
  const std::size_t held = all.size() - std::min(all.size(), place.offset);
  if (held < element || (held - element) / stride < count - 1) {
    fail(accessor, "its " + std::to_string(count) + " elements do not lie within bufferViews[" +
                       std::to_string(place.view) + "] of " + std::to_string(all.size()) +
                       " bytes");
  }
  Frames values(static_cast<Eigen::Index>(count), components);
  for (std::size_t i = 0; i < count; ++i) {
    kind.decode(
        all.data() + place.offset + i * stride, std::endian::little,
        {values.row(static_cast<Eigen::Index>(i)).data(), static_cast<std::size_t>(components)});
  }
  return values;
}

Frames GltfValues::read(std::size_t index, int components, std::optional<Eigen::Index> expected) {
  const GltfAccessor& accessor = document_.accessors[index];
  const std::string count = std::to_string(accessor.count) + " elements";
  if (accessor.components != components) {
    fail(index, "has " + std::to_string(accessor.components) + " numbers an element, expected " +
                    std::to_string(components));
  }
  if (expected && accessor.count != static_cast<std::size_t>(*expected)) {
    fail(index, "has " + count + ", expected " + std::to_string(*expected));
  }
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 16;
  if (accessor.count > kMost) fail(index, "has " + count);
  Frames values;
  if (accessor.place) {
    values = stored(index, *accessor.place, accessor.count, components, accessor.type);
  } else if (accessor.count > document_.file_bytes) {
    fail(index, count + " of which the file holds nothing");
  } else {
    values = Frames::Zero(static_cast<Eigen::Index>(accessor.count), components);
  }
  if (accessor.sparse && accessor.sparse->count > 0) {
    const GltfSparse& sparse = *accessor.sparse;
    if (!kind_of(sparse.index_type).is_index) fail(index, "its sparse indices are no counts");
    const Frames places = stored(index, sparse.indices, sparse.count, 1, sparse.index_type);
    const Frames given = stored(index, sparse.values, sparse.count, components, accessor.type);
    if (places.maxCoeff() >= static_cast<double>(values.rows())) {
      fail(index, "replaces elements beyond its " + count);
    }
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
      values.row(static_cast<Eigen::Index>(places(i, 0))) = given.row(i);
    }
  }
  values = scaled(index, std::move(values));
  if (!values.allFinite()) fail(index, "holds a number that is not finite");
  return values;
}

Frames GltfValues::scaled(std::size_t index, Frames stored) const {
  const GltfAccessor& accessor = document_.accessors[index];
  if (accessor.normalized) stored = (stored / kind_of(accessor.type).one).cwiseMax(-1);
  return stored;
}

std::vector<int> GltfValues::indices(std::size_t index, Eigen::Index size) {
  const GltfAccessor& accessor = document_.accessors[index];
  if (!kind_of(accessor.type).is_index || accessor.normalized) fail(index, "holds no indices");
  const Frames values = read(index, 1);
  if (values.maxCoeff() >= static_cast<double>(size)) {
    fail(index, "names vertex " + std::to_string(static_cast<std::size_t>(values.maxCoeff())) +
                    ", expected 0 to " + std::to_string(size - 1));
  }
  const Eigen::VectorXi whole = values.col(0).cast<int>();
  return {whole.begin(), whole.end()};
}

}  // namespace mimetra
