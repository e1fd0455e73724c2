#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  PlyType type;  ///< type of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< type of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

/// Content of the header.
struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;
  std::size_t bytes;  ///< offset of the data
  int lines;
};

PlyType type_named(const TextCursor& cursor, std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  cursor.fail("'" + std::string(name) + "' is no type of PLY");
}

PlyFormat read_format(TextCursor& cursor) {
  const std::string_view name = cursor.word();
  if (name == "ascii") return PlyFormat::ascii;
  if (name == "binary_little_endian") return PlyFormat::little_endian;
  if (name == "binary_big_endian") return PlyFormat::big_endian;
  cursor.fail("expected format ascii, binary_little_endian or binary_big_endian, found '" +
              std::string(name) + "'");
}

PlyElement read_element(TextCursor& cursor) {
  PlyElement element{std::string(cursor.word()), 0, {}};
  const long long count = cursor.integer(cursor.word(), "an element's count");
  if (count < 0) cursor.fail("element " + element.name + " has a negative count");
  element.count = static_cast<std::size_t>(count);
  return element;
}

PlyProperty read_property(TextCursor& cursor, const std::string& element) {
  PlyProperty property;
  std::string_view type = cursor.word();
  if (type == "list") {
    property.is_list = true;
    property.count_type = type_named(cursor, cursor.word());
    if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64) {
      cursor.fail("a list's length is no integer");
    }
    type = cursor.word();
  }
  property.type = type_named(cursor, type);
  property.name = cursor.word();
  if (property.name.empty()) cursor.fail("a property of " + element + " has no name");
  return property;
}

/// Parses the header. Throws IoError with the line.
PlyHeader read_ply_header(const std::string& path, std::string_view bytes) {
  TextCursor cursor(path, without_byte_order_mark(bytes), {});
  if (cursor.word() != "ply")
    cursor.fail("expected 'ply', found another word: this is no PLY file");
  PlyHeader header;
  std::optional<PlyFormat> format;
  while (true) {
    cursor.next_line();
    if (cursor.at_end()) cursor.fail("the header has no end_header");
    const std::string_view keyword = cursor.word();
    if (keyword == "format") {
      format = read_format(cursor);
    } else if (keyword == "element") {
      header.elements.push_back(read_element(cursor));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property stands before the first element");
      PlyElement& element = header.elements.back();
      element.properties.push_back(read_property(cursor, element.name));
    } else if (keyword == "end_header") {
      break;
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      cursor.fail("'" + std::string(keyword.substr(0, 40)) + "' is no keyword of a PLY header");
    }
  }
  if (!format) cursor.fail("the header names no format");
  cursor.next_line();
  header.format = *format;
  header.bytes = bytes.size() - cursor.left();
  header.lines = cursor.line() - 1;
  return header;
}

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

/// Reader of the numbers after the header, in any format.
class PlyBody {
 public:
  PlyBody(const std::string& path, std::string_view bytes, const PlyHeader& header,
          const Context& context)
      : path_(path),
        context_(context),
        format_(header.format),
        data_(bytes.substr(header.bytes)),
        text_(path, without_padding(data_), {}, header.lines + 1),
        size_(left()) {}

  std::size_t left() const { return format_ == PlyFormat::ascii ? text_.left() : data_.size(); }

  /// Smallest number of bytes of a value; in text, a digit and a blank.
  std::size_t least_bytes(PlyType type) const {
    return format_ == PlyFormat::ascii ? 2 : bytes_of(type);
  }

  double value(PlyType type) {
    if (format_ == PlyFormat::ascii) return text_.number(text_.word_anywhere(), kind_);
    const std::size_t size = bytes_of(type);
    if (data_.size() < size) fail("the file ends here");
    const double result = decoded(type, data_.data());
    data_.remove_prefix(size);
    return result;
  }

  /// Sets the element that is read next, for messages such as "face 12". `kind` must outlive the
  /// reading.
  void set_element(std::string_view kind, std::size_t index) {
    kind_ = kind;
    index_ = index;
    report_element(context_, index, left(), size_);
  }

  void expect_end() {
    if (format_ == PlyFormat::ascii) {
      text_.expect_end();
    } else if (!std::ranges::all_of(without_padding(data_), ends_word)) {
      throw IoError(path_, std::to_string(data_.size()) +
                               " bytes follow the last element, expected the end of the file");
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(path_, std::string(kind_) + " " + std::to_string(index_) + ": " + message);
  }
  /// Fails because of an element's declaration.
  [[noreturn]] void fail(const PlyElement& element, const std::string& message) const {
    throw IoError(path_, "element " + element.name + ": " + message);
  }

 private:
  double decoded(PlyType type, const char* at) const {
    const std::endian order =
        format_ == PlyFormat::big_endian ? std::endian::big : std::endian::little;
    switch (type) {
      case PlyType::int8:
        return number_at<std::int8_t>(at, order);
      case PlyType::uint8:
        return number_at<std::uint8_t>(at, order);
      case PlyType::int16:
        return number_at<std::int16_t>(at, order);
      case PlyType::uint16:
        return number_at<std::uint16_t>(at, order);
      case PlyType::int32:
        return number_at<std::int32_t>(at, order);
      case PlyType::uint32:
        return number_at<std::uint32_t>(at, order);
      case PlyType::float32:
        return number_at<float>(at, order);
      case PlyType::float64:
        return number_at<double>(at, order);
    }
    return 0;
  }

  const std::string& path_;
  const Context& context_;
  PlyFormat format_;
  std::string_view data_;
  TextCursor text_;
  std::size_t size_;
  std::string_view kind_;
  std::size_t index_ = 0;
};

/// Fails, before memory is allocated, if the header promises more elements than the file can
/// contain.
void check_room(const PlyBody& body, const PlyElement& element) {
  std::size_t each = 0;
  for (const PlyProperty& property : element.properties) {
    each += body.least_bytes(property.is_list ? property.count_type : property.type);
  }
  // The last number of a text file needs no blank after it.
  if (each > 0 && element.count > (body.left() + 1) / each) {
    body.fail(element, std::to_string(element.count) + " expected, but only " +
                           std::to_string(body.left()) + " bytes follow");
  }
}

std::size_t list_length(PlyBody& body, const PlyProperty& property) {
  const double length = body.value(property.count_type);
  const double room =
      static_cast<double>(body.left() + 1) / static_cast<double>(body.least_bytes(property.type));
  // The negation also refuses the text "nan".
  if (!(length >= 0 && length <= room)) {
    body.fail("a list of " + std::to_string(length) + " numbers, but only " +
              std::to_string(body.left()) + " bytes follow");
  }
  return static_cast<std::size_t>(length);
}

void skip(PlyBody& body, const PlyProperty& property) {
  const std::size_t values = property.is_list ? list_length(body, property) : 1;
  for (std::size_t i = 0; i < values; ++i) body.value(property.type);
}

void skip_element(PlyBody& body, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::size_t i = 0; i < element.count; ++i) {
    body.set_element(element.name, i);
    for (const PlyProperty& property : element.properties) skip(body, property);
  }
}

/// Role of a vertex property: an axis 0 to 2, or a texture coordinate.
constexpr int kFirstTexture = 3;
constexpr int kNothing = -1;

std::size_t index_of(const PlyElement& element, std::string_view name) {
  const auto found = std::ranges::find_if(element.properties, [name](const PlyProperty& property) {
    return property.name == name && !property.is_list;
  });
  return static_cast<std::size_t>(found - element.properties.begin());
}

/// The role of each property of a vertex.
std::vector<int> roles_of(const PlyBody& body, const PlyElement& element) {
  const std::size_t properties = element.properties.size();
  std::vector<int> roles(properties, kNothing);
  std::array<int, 3> found = {0, 0, 0};
  for (std::size_t i = 0; i < properties; ++i) {
    const PlyProperty& property = element.properties[i];
    const std::size_t axis = std::string_view("xyz").find(property.name);
    const bool is_axis = property.name.size() == 1 && axis < 3 && !property.is_list;
    if (is_axis) {
      roles[i] = static_cast<int>(axis);
      ++found[axis];
    }
  }
  if (found != std::array<int, 3>{1, 1, 1}) {
    body.fail(element, "expected the properties x, y and z once each");
  }
  // Names used by Blender, MeshLab and CloudCompare.
  using Names = std::array<std::string_view, 2>;
  for (const Names& names : {Names{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::size_t u = index_of(element, names[0]), v = index_of(element, names[1]);
    if (u == properties || v == properties) continue;
    roles[u] = kFirstTexture;
    roles[v] = kFirstTexture + 1;
    break;
  }
  return roles;
}

void read_vertices(PlyBody& body, const PlyElement& element, MeshContent& content) {
  std::vector<int> roles = roles_of(body, element);
  // Texture coordinates of faces that come before the vertices take precedence.
  if (!content.texture.corners.empty()) {
    std::ranges::replace_if(
        roles, [](int role) { return role >= kFirstTexture; }, kNothing);
  }
  const bool is_textured = std::ranges::find(roles, kFirstTexture) != roles.end();
  content.coordinates.resize(3 * element.count);
  if (is_textured) content.texture.coordinates.resize(element.count);
  for (std::size_t vertex = 0; vertex < element.count; ++vertex) {
    body.set_element("vertex", vertex);
    for (std::size_t i = 0; i < roles.size(); ++i) {
      if (roles[i] == kNothing) {
        skip(body, element.properties[i]);
      } else if (roles[i] < kFirstTexture) {
        content.coordinates[3 * vertex + static_cast<std::size_t>(roles[i])] =
            body.value(element.properties[i].type);
      } else {
        content.texture.coordinates[vertex][roles[i] - kFirstTexture] =
            body.value(element.properties[i].type);
      }
    }
  }
}

void read_corners(PlyBody& body, const PlyProperty& property, Polygons& polygons) {
  const std::size_t corners = list_length(body, property);
  for (std::size_t i = 0; i < corners; ++i) {
    const double vertex = body.value(property.type);
    // Other indices are out of range in any case.
    const bool fits = vertex >= 0 && vertex <= INT_MAX && vertex == std::floor(vertex);
    if (!fits) body.fail("vertex index " + std::to_string(vertex) + ", expected 0 or more");
    polygons.corners.push_back(static_cast<int>(vertex));
  }
  polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
}

bool lists_vertices(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// True for MeshLab's list with two numbers for each corner.
bool lists_texture(const PlyProperty& property) {
  return property.is_list && property.name == "texcoord";
}

/// Texture coordinates of corners; equal ones are stored once.
class CornerTexture {
 public:
  explicit CornerTexture(TextureCoordinates& texture) : texture_(texture) { texture_ = {}; }

  /// Adds the next face. `numbers` are two for each corner; otherwise its corners get no texture
  /// coordinates.
  void add(const std::vector<double>& numbers, std::size_t corners) {
    const bool fits =
        numbers.size() == 2 * corners &&
        std::ranges::all_of(numbers, [](double value) { return std::isfinite(value); });
    for (std::size_t corner = 0; corner < corners; ++corner) {
      texture_.corners.push_back(fits ? index_of({numbers[2 * corner], numbers[2 * corner + 1]})
                                      : -1);
    }
  }

 private:
  int index_of(std::pair<double, double> value) {
    const auto [entry, is_new] =
        index_.try_emplace(value, static_cast<int>(texture_.coordinates.size()));
    if (is_new) texture_.coordinates.emplace_back(value.first, value.second);
    return entry->second;
  }

  TextureCoordinates& texture_;
  std::map<std::pair<double, double>, int> index_;
};

void read_faces(PlyBody& body, const PlyElement& element, MeshContent& content) {
  if (std::ranges::count_if(element.properties, lists_vertices) != 1) {
    body.fail(element, "expected one list named vertex_indices or vertex_index");
  }
  std::optional<CornerTexture> texture;
  if (std::ranges::any_of(element.properties, lists_texture)) texture.emplace(content.texture);
  std::vector<double> numbers;
  for (std::size_t face = 0; face < element.count; ++face) {
    body.set_element("face", face);
    const std::size_t corners_before = content.polygons.corners.size();
    for (const PlyProperty& property : element.properties) {
      if (lists_vertices(property)) {
        read_corners(body, property, content.polygons);
      } else if (lists_texture(property)) {
        numbers.resize(list_length(body, property));
        for (double& number : numbers) number = body.value(property.type);
      } else {
        skip(body, property);
      }
    }
    if (texture) texture->add(numbers, content.polygons.corners.size() - corners_before);
  }
}

}  // namespace

MeshContent read_ply(const std::string& path, std::string_view bytes, const Context& context) {
  const PlyHeader header = read_ply_header(path, bytes);
  PlyBody body(path, bytes, header, context);
  MeshContent content;
  bool has_vertices = false, has_faces = false;
  for (const PlyElement& element : header.elements) {
    check_room(body, element);
    if (element.name == "vertex" && !std::exchange(has_vertices, true)) {
      read_vertices(body, element, content);
    } else if (element.name == "face" && !std::exchange(has_faces, true)) {
      read_faces(body, element, content);
    } else {
      skip_element(body, element);
    }
  }
  const auto strips = std::ranges::find(header.elements, "tristrips", &PlyElement::name);
  if (!has_faces && strips != header.elements.end()) {
    body.fail(*strips, "strips of triangles are not read, expected an element face");
  }
  body.expect_end();
  // The coordinates belong to vertices, so each corner uses its vertex's.
  if (!content.texture.coordinates.empty() && content.texture.corners.empty()) {
    content.texture.corners = content.polygons.corners;
  }
  return content;
}

namespace {

/// Layout of the vertices in a binary file: directly after the header, at equal distances.
struct VertexBlock {
  PlyType type = PlyType::float32;  ///< type of x, y and z
  std::endian order = std::endian::little;
  std::size_t stride = 0;              ///< distance of vertices, in bytes
  std::array<std::size_t, 3> at = {};  ///< offsets of x, y and z in a vertex
  std::size_t bytes = 0;               ///< size of all vertices, in bytes
};

/// Layout of the vertices. None unless the first element holds vertices of fixed size with x, y, z
/// of one real type.
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

/// Layout from the bytes before and after the vertices.
class PlyLayout {
 public:
  PlyLayout(std::string first, std::size_t header_bytes, const VertexBlock& block)
      : block_(block),
        after_(first.substr(header_bytes + block.bytes)),
        before_(std::move(first.erase(header_bytes))) {}

  bool read(std::string_view bytes, std::span<double> coordinates) const {
    if (bytes.size() != before_.size() + block_.bytes + after_.size()) return false;
    if (!bytes.starts_with(before_) || !bytes.ends_with(after_)) return false;
    const char* vertices = bytes.data() + before_.size();
    return block_.type == PlyType::float32 ? decode<float>(block_, vertices, coordinates)
                                           : decode<double>(block_, vertices, coordinates);
  }

 private:
  VertexBlock block_;
  std::string after_;
  std::string before_;
};

}  // namespace

FurtherReader ply_further_reader(std::string first, std::size_t, const Context&) {
  const PlyHeader header = read_ply_header("", first);
  const std::optional<VertexBlock> block = block_of(header);
  if (!block) return {};
  return [layout = PlyLayout(std::move(first), header.bytes, *block)](
             std::string_view bytes, std::span<double> coordinates) {
    return layout.read(bytes, coordinates);
  };
}

}  // namespace mimetra
