#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mimetra {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  PlyType type;  ///< of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties;
};

/// What stands before `end_header`. Internal to ply.cpp.
struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;
  std::size_t bytes;  ///< where the data starts
  int lines;
};

/// Throws IoError that names the line.
PlyHeader read_ply_header(const std::string& path, std::string_view bytes);

std::size_t bytes_of(PlyType type);

}  // namespace mimetra
