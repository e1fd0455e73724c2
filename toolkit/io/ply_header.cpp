#include "toolkit/io/ply_header.h"

#include <array>
#include <optional>
#include <utility>

#include "toolkit/io/text_cursor.h"

namespace mimetra {
namespace {

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

}  // namespace

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

}  // namespace mimetra
