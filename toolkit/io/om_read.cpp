#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// An OpenMesh file (version 2.2) is a sequence of chunks. OmOf is the kind of element that a
/// chunk's rows belong to, and OmWhat is the kind of data.
enum class OmOf : unsigned { vertices = 0, mesh = 1, faces = 2, edges = 4, halfedges = 6, end = 7 };
enum class OmWhat : unsigned {
  positions = 0,
  normals = 1,
  texture = 2,
  status = 3,
  colors = 4,
  custom = 6,
  topology = 7
};

/// 16 bits before a chunk. Custom properties use only the first three fields.
struct OmChunk {
  bool is_named;
  OmOf of;
  OmWhat what;
  bool is_signed, is_float;
  unsigned dimension;   ///< 1 to 8 numbers in a row
  unsigned size_class;  ///< number's size: integers 1, 2, 4, 8 bytes; floats 4, 8, 16

  std::size_t integer_bytes() const { return std::size_t{1} << size_class; }
  std::size_t float_bytes() const { return std::size_t{4} << size_class; }
};

OmChunk om_chunk(std::uint16_t bits) {
  const auto part = [bits](int first, int count) {
    return (static_cast<unsigned>(bits) >> first) & ((1U << count) - 1);
  };
  return {part(1, 1) == 1,
          static_cast<OmOf>(part(2, 3)),
          static_cast<OmWhat>(part(5, 4)),
          part(9, 1) == 1,
          part(10, 1) == 1,
          part(11, 3) + 1,
          part(14, 2)};
}

/// Integer of 1, 2, 4 or 8 bytes. \pre `at` has that many bytes
std::int64_t om_integer(const char* at, std::size_t bytes, bool is_signed) {
  const auto as = [at, is_signed](auto number) -> std::int64_t {
    using Unsigned = decltype(number);
    const auto read = number_at<Unsigned>(at, std::endian::little);
    return is_signed ? static_cast<std::make_signed_t<Unsigned>>(read)
                     : static_cast<std::int64_t>(read);
  };
  switch (bytes) {
    case 1:
      return as(std::uint8_t{});
    case 2:
      return as(std::uint16_t{});
    case 4:
      return as(std::uint32_t{});
    default:
      return as(std::uint64_t{});
  }
}

/// Reader of a file's bytes, piece by piece, that fails at the end.
class OmBytes {
 public:
  OmBytes(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  [[noreturn]] void fail(const std::string& message) const { throw IoError(path_, message); }

  bool at_end() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }

  std::string_view take(std::uint64_t size, const std::string& what) {
    if (size > bytes_.size()) {
      fail("ends within " + what + ": " + std::to_string(bytes_.size()) + " bytes, expected " +
           std::to_string(size));
    }
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  template <typename Number>
  Number number(const std::string& what) {
    return number_at<Number>(take(sizeof(Number), what).data(), std::endian::little);
  }

  /// Word of up to 255 letters, stored after its length.
  std::string word(const std::string& what) {
    return std::string(take(number<std::uint8_t>(what), what));
  }

 private:
  const std::string& path_;
  std::string_view bytes_;
};

/// Custom property: a row of numbers for each element, and its type in OpenMesh's words.
struct OmProperty {
  OmOf of;
  std::string name, type;
  std::string_view values;
};

/// Parts of a file that are used.
struct OmParts {
  std::array<std::uint32_t, 3> counts = {};  ///< vertices, faces, edges
  std::vector<double> coordinates;
  std::vector<double> of_vertices, of_halfedges;  ///< texture coordinates; empty for none
  /// Three numbers for each half-edge: next half-edge, vertex it points to, and face or -1.
  std::vector<std::int64_t> halfedges;
  std::vector<std::int64_t> face_halfedges;
  Polygons polygons;  ///< from files before version 2, whose faces list their corners
  std::vector<OmProperty> properties;
};

class OmReader {
 public:
  OmReader(const std::string& path, std::string_view bytes) : bytes_(path, bytes) {}

  OmParts read(const Context& context) {
    const auto size = static_cast<double>(bytes_.left());
    read_header();
    while (!bytes_.at_end()) {
      context.report(1 - static_cast<double>(bytes_.left()) / size);
      const OmChunk chunk = om_chunk(bytes_.number<std::uint16_t>("a chunk's header"));
      if (chunk.of == OmOf::end) break;
      read_chunk(chunk);
    }
    if (!bytes_.at_end()) {
      bytes_.fail(std::to_string(bytes_.left()) + " bytes follow the last element");
    }
    if (parts_.coordinates.size() != 3 * std::size_t{parts_.counts[0]}) {
      bytes_.fail("has no positions of its " + std::to_string(parts_.counts[0]) + " vertices");
    }
    return std::move(parts_);
  }

 private:
  void read_header() {
    if (bytes_.take(2, "its first letters") != "OM") {
      bytes_.fail("is no mesh of OpenMesh, which begins with 'OM'");
    }
    mesh_ = static_cast<char>(bytes_.number<std::uint8_t>("its header"));
    const auto version = bytes_.number<std::uint8_t>("its header");
    constexpr int kMinorBits = 5;
    major_ = version >> kMinorBits;
    minor_ = version & ((1 << kMinorBits) - 1);
    if (major_ < 1 || major_ > 2) {
      bytes_.fail("is of version " + std::to_string(major_) + "." + std::to_string(minor_) +
                  ", expected 1 or 2");
    }
    for (std::uint32_t& count : parts_.counts) {
      count = bytes_.number<std::uint32_t>("its header");
      if (count > INT_MAX / 2) bytes_.fail("counts " + std::to_string(count) + " elements");
    }
  }

  std::uint64_t count(OmOf of) const {
    switch (of) {
      case OmOf::vertices:
        return parts_.counts[0];
      case OmOf::faces:
        return parts_.counts[1];
      case OmOf::edges:
        return parts_.counts[2];
      case OmOf::halfedges:
        return 2 * std::uint64_t{parts_.counts[2]};
      case OmOf::mesh:
        return 1;
      case OmOf::end:
        break;
    }
    bytes_.fail("has a chunk of no known element");
  }

  void read_chunk(const OmChunk& chunk) {
    const std::uint64_t elements = count(chunk.of);
    switch (chunk.what) {
      case OmWhat::positions:
        floats(chunk, 3, elements, "the positions of vertices", parts_.coordinates);
        return;
      case OmWhat::normals:
        bytes_.take(elements * chunk.dimension * chunk.float_bytes(), "normals");
        return;
      case OmWhat::texture:
        read_texture(chunk, elements);
        return;
      case OmWhat::status:
        read_status(chunk, elements);
        return;
      case OmWhat::colors:
        bytes_.take(elements * chunk.dimension * (chunk.is_float ? chunk.float_bytes() : 1),
                    "colours");
        return;
      case OmWhat::custom:
        read_property(chunk);
        return;
      case OmWhat::topology:
        read_topology(chunk, elements);
        return;
    }
    bytes_.fail("has a chunk of an unknown kind");
  }

  void floats(const OmChunk& chunk, unsigned dimension, std::uint64_t elements,
              const std::string& what, std::vector<double>& values) {
    if (chunk.dimension != dimension || !chunk.is_float || chunk.float_bytes() > sizeof(double)) {
      bytes_.fail(what + " are no vectors of " + std::to_string(dimension) + " floats or doubles");
    }
    const std::string_view stored = bytes_.take(elements * dimension * chunk.float_bytes(), what);
    values.resize(elements * dimension);
    if (chunk.float_bytes() == sizeof(float)) {
      decode_numbers<float>(stored.data(), std::endian::little, values);
    } else {
      decode_numbers<double>(stored.data(), std::endian::little, values);
    }
  }

  void read_texture(const OmChunk& chunk, std::uint64_t elements) {
    const std::string what = "texture coordinates";
    const bool is_flat = chunk.dimension == 2;
    if (is_flat && chunk.of == OmOf::vertices) {
      floats(chunk, 2, elements, what, parts_.of_vertices);
    } else if (is_flat && chunk.of == OmOf::halfedges) {
      floats(chunk, 2, elements, what, parts_.of_halfedges);
    } else {
      bytes_.take(elements * chunk.dimension * chunk.float_bytes(), what);
    }
  }

  void read_status(const OmChunk& chunk, std::uint64_t elements) {
    const std::string_view stored = bytes_.take(elements * sizeof(std::uint32_t), "the status");
    if (chunk.of != OmOf::vertices && chunk.of != OmOf::faces) return;
    for (std::uint64_t i = 0; i < elements; ++i) {
      constexpr std::uint32_t kDeleted = 1;
      const char* at = stored.data() + i * sizeof(std::uint32_t);
      if (!(number_at<std::uint32_t>(at, std::endian::little) & kDeleted)) continue;
      bytes_.fail((chunk.of == OmOf::faces ? "face " : "vertex ") + std::to_string(i) +
                  " is marked deleted; call garbage_collection() before it is written");
    }
  }

  void read_property(const OmChunk& chunk) {
    OmProperty property{chunk.of, "", "", {}};
    if (chunk.is_named) property.name = bytes_.word("a property's name");
    constexpr int kTyped = 2;
    if (major_ == 2 && minor_ >= kTyped) property.type = bytes_.word("a property's type");
    const std::string what = "the property '" + property.name + "'";
    property.values = bytes_.take(bytes_.number<std::uint32_t>(what), what);
    parts_.properties.push_back(std::move(property));
  }

  void read_topology(const OmChunk& chunk, std::uint64_t elements) {
    if (chunk.of == OmOf::faces && major_ == 1) {
      read_corners(chunk);
    } else if (chunk.of == OmOf::halfedges) {
      integers(chunk, 3 * elements, "half-edges", parts_.halfedges);
    } else if (chunk.of == OmOf::faces) {
      integers(chunk, elements, "the half-edges of faces", parts_.face_halfedges);
    } else {
      bytes_.take(elements * chunk.integer_bytes(), "half-edges");
    }
  }

  void read_corners(const OmChunk& chunk) {
    constexpr int kTriangle = 3, kQuad = 4;
    std::vector<std::int64_t> corners;
    for (std::uint32_t face = 0; face < parts_.counts[1]; ++face) {
      const int size = mesh_ == 'T'   ? kTriangle
                       : mesh_ == 'Q' ? kQuad
                                      : bytes_.number<std::uint16_t>("the faces");
      integers(chunk, static_cast<std::uint64_t>(size), "the faces", corners);
      for (const std::int64_t corner : corners) {
        parts_.polygons.corners.push_back(static_cast<int>(corner));
      }
      parts_.polygons.offsets.push_back(static_cast<int>(parts_.polygons.corners.size()));
    }
  }

  /// Reads integers; -1 marks a missing element.
  void integers(const OmChunk& chunk, std::uint64_t many, const std::string& what,
                std::vector<std::int64_t>& values) {
    const std::size_t width = chunk.integer_bytes();
    const std::string_view stored = bytes_.take(many * width, what);
    values.resize(many);
    for (std::size_t i = 0; i < many; ++i) {
      values[i] = om_integer(stored.data() + i * width, width, chunk.is_signed);
    }
  }

  OmBytes bytes_;
  char mesh_ = 'P';
  int major_ = 2, minor_ = 2;
  OmParts parts_;
};

/// Corners of faces, found by following half-edges. Each corner is the vertex that a half-edge
/// points to.
class OmFaces {
 public:
  OmFaces(const std::string& path, const OmParts& parts) : parts_(parts) {
    if (parts.counts[1] > 0 && parts.face_halfedges.empty()) {
      throw IoError(path, "has no half-edges of its faces");
    }
    std::vector<bool> is_used(parts.halfedges.size() / 3, false);
    for (std::size_t face = 0; face < parts.face_halfedges.size(); ++face) {
      std::int64_t halfedge = parts.face_halfedges[face];
      do {
        if (halfedge < 0 || halfedge >= static_cast<std::int64_t>(is_used.size()) ||
            is_used[static_cast<std::size_t>(halfedge)]) {
          throw IoError(path, "face " + std::to_string(face) + ": half-edge " +
                                  std::to_string(halfedge) + " leads around no face of its own");
        }
        is_used[static_cast<std::size_t>(halfedge)] = true;
        corners_.push_back(static_cast<std::size_t>(halfedge));
        const std::int64_t vertex = of(corners_.back(), kTo);
        polygons_.corners.push_back(
            static_cast<int>(std::clamp<std::int64_t>(vertex, INT_MIN, INT_MAX)));
        halfedge = of(corners_.back(), kNext);
      } while (halfedge != parts.face_halfedges[face]);
      polygons_.offsets.push_back(static_cast<int>(polygons_.corners.size()));
    }
  }

  const Polygons& polygons() const { return polygons_; }
  /// Half-edge that points to each corner.
  const std::vector<std::size_t>& corners() const { return corners_; }

 private:
  enum Number { kNext, kTo };  // index among a half-edge's three numbers

  std::int64_t of(std::size_t halfedge, Number number) const {
    return parts_.halfedges[3 * halfedge + static_cast<std::size_t>(number)];
  }

  const OmParts& parts_;
  Polygons polygons_;
  std::vector<std::size_t> corners_;
};

std::vector<Eigen::Vector2d> pairs_of(const std::vector<double>& values) {
  std::vector<Eigen::Vector2d> pairs;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
    pairs.emplace_back(values[i], values[i + 1]);
  }
  return pairs;
}

/// Numeric type of properties, by its name in OpenMesh.
struct NumberType {
  std::string_view name;
  std::size_t columns, width;
  bool is_integer;
  void (*decode)(const char* stored, std::endian order, std::span<double> values);
};

template <typename Number>
constexpr NumberType number_type(std::string_view name, std::size_t columns = 1) {
  return {name, columns, sizeof(Number), std::is_integral_v<Number>, decode_numbers<Number>};
}

constexpr std::array kNumberTypes = {
    number_type<std::int8_t>("int8_t"),    number_type<std::uint8_t>("uint8_t"),
    number_type<std::int16_t>("int16_t"),  number_type<std::uint16_t>("uint16_t"),
    number_type<std::int32_t>("int32_t"),  number_type<std::uint32_t>("uint32_t"),
    number_type<std::int64_t>("int64_t"),  number_type<std::uint64_t>("uint64_t"),
    number_type<float>("float"),           number_type<double>("double"),
    number_type<float>("Vec2f", 2),        number_type<double>("Vec2d", 2),
    number_type<float>("Vec3f", 3),        number_type<double>("Vec3d", 3),
    number_type<float>("Vec4f", 4),        number_type<double>("Vec4d", 4),
    number_type<std::int32_t>("Vec2i", 2), number_type<std::int32_t>("Vec3i", 3),
    number_type<std::int32_t>("Vec4i", 4)};

/// Bits in a byte.
constexpr std::size_t kBits = 8;

/// Values of bool properties, packed with the first one in the lowest bit.
Eigen::MatrixXd bits_of(std::string_view stored, std::size_t rows) {
  Eigen::MatrixXd values(rows, 1);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto byte = static_cast<unsigned char>(stored[i / kBits]);
    values(static_cast<Eigen::Index>(i), 0) = (byte >> (i % kBits)) & 1;
  }
  return values;
}

/// Values (rows x columns), and whether they are integers. None if the type is not numeric, or if
/// the number of values differs from the number of elements.
std::optional<std::pair<Eigen::MatrixXd, bool>> values_of(const OmProperty& property,
                                                          std::size_t rows) {
  if (property.type == "bool") {
    if (property.values.size() != (rows + kBits - 1) / kBits) return {};
    return std::pair(bits_of(property.values, rows), true);
  }
  const auto type = std::ranges::find(kNumberTypes, property.type, &NumberType::name);
  if (type == kNumberTypes.end() || property.values.size() != rows * type->columns * type->width) {
    return {};
  }
  std::vector<double> numbers(rows * type->columns);
  type->decode(property.values.data(), std::endian::little, numbers);
  return std::pair(Eigen::MatrixXd(Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
                       numbers.data(), static_cast<Eigen::Index>(rows),
                       static_cast<Eigen::Index>(type->columns))),
                   type->is_integer);
}

}  // namespace

MeshContent read_om(const std::string& path, std::string_view bytes, const Context& context) {
  OmParts parts = OmReader(path, bytes).read(context);
  MeshContent content;
  content.coordinates = std::move(parts.coordinates);
  if (parts.polygons.size() > 0) {
    content.polygons = std::move(parts.polygons);
    return content;
  }
  const OmFaces faces(path, parts);
  content.polygons = faces.polygons();
  if (!parts.of_halfedges.empty()) {
    const std::vector<Eigen::Vector2d> all = pairs_of(parts.of_halfedges);
    for (const std::size_t halfedge : faces.corners()) {
      content.texture.corners.push_back(static_cast<int>(content.texture.coordinates.size()));
      content.texture.coordinates.push_back(all[halfedge]);
    }
  } else if (!parts.of_vertices.empty()) {
    content.texture = {pairs_of(parts.of_vertices), content.polygons.corners};
  }
  return content;
}

FieldsRead read_om_fields(const std::filesystem::path& path, const Connectivity& connectivity,
                          const Context& context) {
  const std::string name = path.string(), bytes = read_file(path);
  const OmParts parts = OmReader(name, bytes).read(context);
  const auto faces = static_cast<std::size_t>(connectivity.polygons.size());
  FieldsRead read;
  for (const OmProperty& property : parts.properties) {
    const bool on_vertices = property.of == OmOf::vertices, on_faces = property.of == OmOf::faces;
    std::optional<std::pair<Eigen::MatrixXd, bool>> found;
    if (on_vertices || on_faces) {
      found = values_of(property,
                        on_vertices ? static_cast<std::size_t>(connectivity.vertices) : faces);
    }
    if (!found || property.name.empty()) {
      read.left_out.push_back(property.name.empty() ? "without a name" : property.name);
      continue;
    }
    const auto& [values, is_integer] = *found;
    if (on_vertices) {
      read.fields.push_back({property.name, Field::Location::vertices, values, is_integer});
    } else {
      read.fields.push_back({property.name, Field::Location::triangles,
                             values(connectivity.polygon_of_triangle, Eigen::all), is_integer});
    }
  }
  return read;
}

}  // namespace mimetra
