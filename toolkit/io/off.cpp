#include <algorithm>
#include <climits>

#include "toolkit/io/mesh_content.h"
#include "toolkit/io/text_cursor.h"

namespace mimetra {
namespace {

/// Accepts OFF with any prefix that only adds columns after a position: ST (texture), C (colour), N
/// (normal).
void read_keyword(TextCursor& cursor) {
  const std::string_view keyword = cursor.word_anywhere();
  const bool known =
      keyword.size() >= 3 && keyword.substr(keyword.size() - 3) == "OFF" &&
      keyword.substr(0, keyword.size() - 3).find_first_not_of("STCN") == std::string_view::npos;
  if (!known) cursor.fail_expected("OFF, COFF or NOFF", keyword);
}

/// Reads a count, and fails if the rest of the file is too short for it. Each element takes at
/// least `bytes_each`.
int read_count(TextCursor& cursor, const char* what, std::size_t bytes_each) {
  const long long count = cursor.integer(cursor.word_anywhere(), what);
  const std::size_t room = cursor.left() / bytes_each + 1;
  if (count < 0 || count > INT_MAX || static_cast<std::size_t>(count) > room) {
    cursor.fail(std::string(what) + " is " + std::to_string(count) + ", but only " +
                std::to_string(cursor.left()) + " bytes follow");
  }
  return static_cast<int>(count);
}

void read_face(TextCursor& cursor, MeshContent& content) {
  const long long corners = cursor.integer(cursor.word_anywhere(), "a face's corner count");
  content.face_lines.push_back(cursor.line());
  for (long long corner = 0; corner < corners; ++corner) {
    const long long vertex = cursor.integer(cursor.word(), "a face's vertex");
    // Indices beyond int are out of range in any case.
    content.polygons.corners.push_back(
        static_cast<int>(std::clamp<long long>(vertex, INT_MIN, INT_MAX)));
  }
  content.polygons.offsets.push_back(static_cast<int>(content.polygons.corners.size()));
}

}  // namespace

MeshContent read_off(const std::string& path, std::string_view bytes, const Context& context) {
  TextCursor cursor(path, without_padding(without_byte_order_mark(bytes)), {.comments = true});
  read_keyword(cursor);
  constexpr std::size_t kVertexBytes = 6;  // "0 0 0" and the line's end
  constexpr std::size_t kFaceBytes = 2;    // "0" and the line's end
  const int vertices = read_count(cursor, "the number of vertices", kVertexBytes);
  const int faces = read_count(cursor, "the number of faces", kFaceBytes);
  cursor.next_line();  // the number of edges, which is not used and may be missing

  MeshContent content;
  content.coordinates.reserve(3 * static_cast<std::size_t>(vertices));
  for (int vertex = 0; vertex < vertices; ++vertex) {
    report_element(context, vertex, cursor.left(), bytes.size());
    content.coordinates.push_back(cursor.number(cursor.word_anywhere(), "a vertex coordinate"));
    content.coordinates.push_back(cursor.number(cursor.word(), "a vertex coordinate"));
    content.coordinates.push_back(cursor.number(cursor.word(), "a vertex coordinate"));
    cursor.next_line();
  }
  for (int face = 0; face < faces; ++face) {
    report_element(context, face, cursor.left(), bytes.size());
    read_face(cursor, content);
    cursor.next_line();  // a colour may follow
  }
  cursor.expect_end();
  return content;
}

MeshFrame off_frame(const Connectivity& connectivity, const std::vector<Field>&,
                    bool double_precision, const Context& context) {
  const Polygons& polygons = connectivity.polygons;
  std::string after;
  for (int face = 0; face < polygons.size(); ++face) {
    report_element(context, face, polygons.size() - face, polygons.size());
    append_integer(after, polygons.offsets[face + 1] - polygons.offsets[face]);
    for (int corner = polygons.offsets[face]; corner < polygons.offsets[face + 1]; ++corner) {
      after += ' ';
      append_integer(after, polygons.corners[corner]);
    }
    after += '\n';
  }
  return {"OFF\n" + std::to_string(connectivity.vertices) + " " + std::to_string(polygons.size()) +
              " 0\n",
          std::move(after), [double_precision](const PositionsView& positions) {
            return position_lines("", positions, double_precision);
          }};
}

}  // namespace mimetra
