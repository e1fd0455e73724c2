#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_layout.h"
#include "toolkit/io/ply_header.h"
#include "toolkit/mesh/coordinate.h"

namespace mimetra {
namespace {

/// How the vertices lie in a binary file: right behind the header, at equal distances.
struct VertexBlock {
  PlyType type = PlyType::float32;  ///< of x, y and z
  std::endian order = std::endian::little;
  std::size_t stride = 0;              ///< bytes from vertex to vertex
  std::array<std::size_t, 3> at = {};  ///< of x, y and z in a vertex
  std::size_t bytes = 0;               ///< of all vertices
};

/// None where the first element is none of vertices of fixed size with x, y, z of one real type.
std::optional<VertexBlock> block_of(const PlyHeader& header) {
  if (header.format == PlyFormat::ascii || header.elements.empty()) return std::nullopt;
  const PlyElement& element = header.elements.front();
  if (element.name != "vertex") return std::nullopt;
  VertexBlock block;
  if (header.format == PlyFormat::big_endian) block.order = std::endian::big;
  std::array<std::optional<PlyType>, 3> types;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return std::nullopt;
    const std::size_t axis = std::string_view("xyz").find(property.name);
    if (property.name.size() == 1 && axis < 3) {
      types[axis] = property.type;
      block.at[axis] = block.stride;
    }
    block.stride += bytes_of(property.type);
  }
  if (types[0] != PlyType::float32 && types[0] != PlyType::float64) return std::nullopt;
  if (types[1] != types[0] || types[2] != types[0]) return std::nullopt;
  block.type = *types[0];
  block.bytes = element.count * block.stride;
  return block;
}

template <typename Number>
bool decode(const VertexBlock& block, const char* vertex, std::span<double> coordinates) {
  bool all = true;
  for (std::size_t i = 0; i < coordinates.size(); i += 3, vertex += block.stride) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = number_at<Number>(vertex + block.at[axis], block.order);
      coordinates[i + axis] = value;
      all = all && is_coordinate(value);
    }
  }
  return all;
}

/// What stands before and after the vertices.
class PlyLayout : public MeshLayout {
 public:
  PlyLayout(std::string first, std::size_t header_bytes, const VertexBlock& block)
      : block_(block),
        after_(first.substr(header_bytes + block.bytes)),
        before_(std::move(first.erase(header_bytes))) {}

  bool read(std::string_view bytes, std::span<double> coordinates) const override {
    if (bytes.size() != before_.size() + block_.bytes + after_.size()) return false;
    if (!bytes.starts_with(before_) || !bytes.ends_with(after_)) return false;
    const char* vertices = bytes.data() + before_.size();
    return block_.type == PlyType::float32 ? decode<float>(block_, vertices, coordinates)
                                           : decode<double>(block_, vertices, coordinates);
  }

 private:
  const VertexBlock block_;
  const std::string after_;
  const std::string before_;
};

}  // namespace

std::unique_ptr<const MeshLayout> ply_layout(std::string first, std::size_t, const Context&) {
  const PlyHeader header = read_ply_header("", first);
  const std::optional<VertexBlock> block = block_of(header);
  if (!block) return nullptr;
  return std::make_unique<PlyLayout>(std::move(first), header.bytes, *block);
}

}  // namespace mimetra
