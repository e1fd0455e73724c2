#include <Eigen/Geometry>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kPreambleBytes = kHeaderBytes + 4;  // with the number of triangles
constexpr std::size_t kTriangleBytes = 50;                // normal, three corners, attribute

std::size_t triangle_count(std::string_view bytes) {
  return number_at<std::uint32_t>(bytes.data() + kHeaderBytes, std::endian::little);
}

/// Some binary files start with "solid" too, and only their size identifies them.
bool is_binary(std::string_view bytes) {
  if (!without_byte_order_mark(bytes).starts_with("solid")) return true;
  return bytes.size() >= kPreambleBytes &&
         bytes.size() == kPreambleBytes + kTriangleBytes * triangle_count(bytes);
}

std::vector<double> read_binary(const std::string& path, std::string_view bytes,
                                const Context& context) {
  if (bytes.size() < kPreambleBytes) {
    throw IoError(path, "is no STL file: " + std::to_string(bytes.size()) +
                            " bytes, expected at least " + std::to_string(kPreambleBytes));
  }
  const std::size_t triangles = triangle_count(bytes);
  const std::size_t expected = kPreambleBytes + kTriangleBytes * triangles;
  if (bytes.size() != expected) {
    throw IoError(path, (bytes.size() < expected ? "is truncated: " : "is too long: ") +
                            std::to_string(bytes.size()) + " bytes, expected " +
                            std::to_string(expected) + " for " + std::to_string(triangles) +
                            " triangles");
  }
  std::vector<double> corners;
  corners.reserve(9 * triangles);
  for (std::size_t triangle = 0; triangle < triangles; ++triangle) {
    report_element(context, triangle, triangles - triangle, triangles);
    const char* at = bytes.data() + kPreambleBytes + kTriangleBytes * triangle;
    for (std::size_t i = 3; i < 12; ++i) {  // the first three numbers are the normal
      corners.push_back(number_at<float>(at + i * sizeof(float), std::endian::little));
    }
  }
  return corners;
}

void expect(TextCursor& cursor, std::string_view keyword) {
  const std::string_view found = cursor.word_anywhere();
  if (found != keyword) cursor.fail_expected("'" + std::string(keyword) + "'", found);
}

void read_facet(TextCursor& cursor, std::vector<double>& corners) {
  expect(cursor, "normal");
  for (int axis = 0; axis < 3; ++axis) {
    if (cursor.word_anywhere().empty()) cursor.fail("expected a normal, found the file's end");
  }
  expect(cursor, "outer");
  expect(cursor, "loop");
  for (int corner = 0; corner < 3; ++corner) {
    expect(cursor, "vertex");
    for (int axis = 0; axis < 3; ++axis) {
      corners.push_back(cursor.number(cursor.word_anywhere(), "a vertex coordinate"));
    }
  }
  expect(cursor, "endloop");
  expect(cursor, "endfacet");
}

std::vector<double> read_ascii(const std::string& path, std::string_view bytes,
                               const Context& context) {
  TextCursor cursor(path, bytes, {});
  std::vector<double> corners;
  std::string_view keyword = cursor.word_anywhere();
  // Several solids may follow each other.
  while (keyword == "solid") {
    cursor.next_line();  // the solid's name
    keyword = cursor.word_anywhere();
    for (; keyword == "facet"; keyword = cursor.word_anywhere()) {
      report_element(context, corners.size() / 9, cursor.left(), bytes.size());
      read_facet(cursor, corners);
    }
    if (keyword != "endsolid") cursor.fail_expected("'facet' or 'endsolid'", keyword);
    cursor.next_line();
    keyword = cursor.word_anywhere();
  }
  if (!keyword.empty()) cursor.fail_expected("'solid' or the end of the file", keyword);
  return corners;
}

void append_point(std::string& bytes, const Eigen::Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis) {
    append_little_endian(bytes, static_cast<float>(point[axis]));
  }
}

std::string triangle_bytes(const PositionsView& positions, const Triangles& triangles) {
  std::string bytes;
  bytes.reserve(kTriangleBytes * static_cast<std::size_t>(triangles.rows()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0));
    const Eigen::Vector3d b = positions.row(triangles(t, 1));
    const Eigen::Vector3d c = positions.row(triangles(t, 2));
    append_point(bytes, (b - a).cross(c - a).normalized());  // 0 for a triangle without area
    append_point(bytes, a);
    append_point(bytes, b);
    append_point(bytes, c);
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace

std::vector<double> read_stl_corners(const std::string& path, std::string_view bytes,
                                     const Context& context) {
  return is_binary(bytes) ? read_binary(path, bytes, context)
                          : read_ascii(path, without_byte_order_mark(bytes), context);
}

MeshFrame stl_frame(const Connectivity& connectivity, const std::vector<Field>&, bool,
                    const Context&) {
  std::string before(kHeaderBytes, ' ');
  append_little_endian(before, static_cast<std::uint32_t>(connectivity.triangles.rows()));
  return {
      std::move(before), {}, [triangles = connectivity.triangles](const PositionsView& positions) {
        return triangle_bytes(positions, triangles);
      }};
}

}  // namespace mimetra
