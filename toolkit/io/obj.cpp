#include <algorithm>
#include <climits>

#include "toolkit/io/mesh_content.h"
#include "toolkit/io/text_cursor.h"

namespace mimetra {
namespace {

/// 0-based index of a number that counts from 1, or from the end if it is negative.
int resolved(const TextCursor& cursor, std::string_view digits, std::size_t so_far,
             const char* what) {
  const long long index = cursor.integer(digits, what);
  if (index == 0) cursor.fail(std::string("index 0 for ") + what + ", expected 1 or more");
  const long long from_zero = index > 0 ? index - 1 : static_cast<long long>(so_far) + index;
  // An index of INT_MAX would overflow in messages, which count from 1.
  if (from_zero < 0 || from_zero >= INT_MAX) {
    cursor.fail("index " + std::to_string(index) + " for " + what + ", found " +
                std::to_string(so_far) + " of them so far");
  }
  return static_cast<int>(from_zero);
}

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view bytes)
      : cursor_(path, without_byte_order_mark(bytes), {.comments = true, .continuations = true}) {
    content_.first_index = 1;
  }

  MeshContent read(const Context& context) {
    const std::size_t size = cursor_.left();
    for (std::size_t line = 0; !cursor_.at_end(); cursor_.next_line()) {
      report_element(context, line++, cursor_.left(), size);
      const std::string_view keyword = cursor_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "vt") {
        read_texture_coordinates();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "g" || keyword == "o" || keyword == "usemtl" || keyword == "s") {
        read_group(keyword);
      } else if (keyword == "mtllib") {
        read_library();
      } else {
        check_keyword(keyword);
      }
    }
    check_texture();
    return std::move(content_);
  }

 private:
  /// Ignores statements that are not about a mesh. Fails on lines that are not statements.
  void check_keyword(std::string_view keyword) const {
    const char first = keyword.empty() ? 'v' : keyword[0];
    const bool is_name = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z');
    if (!is_name) cursor_.fail_expected("a statement such as v or f", keyword);
  }

  void read_vertex() {
    for (int axis = 0; axis < 3; ++axis) {
      content_.coordinates.push_back(cursor_.number(cursor_.word(), "a vertex coordinate"));
    }
  }

  void read_texture_coordinates() {
    const double u = cursor_.number(cursor_.word(), "a texture coordinate");
    const std::string_view second = cursor_.word();
    const double v = second.empty() ? 0 : cursor_.number(second, "a texture coordinate");
    content_.texture.coordinates.emplace_back(u, v);
  }

  /// Corners are v, v/vt, v//vn or v/vt/vn.
  void read_face() {
    content_.face_lines.push_back(cursor_.line());
    auto& corners = content_.polygons.corners;
    auto& texture = content_.texture.corners;
    for (std::string_view corner = cursor_.word(); !corner.empty(); corner = cursor_.word()) {
      const std::size_t slash = corner.find('/');
      corners.push_back(
          resolved(cursor_, corner.substr(0, slash), content_.coordinates.size() / 3, "a vertex"));
      const std::string_view rest =
          slash == std::string_view::npos ? std::string_view() : corner.substr(slash + 1);
      const std::string_view vt = rest.substr(0, rest.find('/'));
      texture.push_back(vt.empty() ? -1
                                   : resolved(cursor_, vt, content_.texture.coordinates.size(),
                                              "a texture coordinate"));
    }
    content_.polygons.offsets.push_back(static_cast<int>(corners.size()));
  }

  void read_group(std::string_view keyword) {
    std::string statement(keyword);
    for (std::string_view name = cursor_.word(); !name.empty(); name = cursor_.word()) {
      statement.append(" ").append(name);
    }
    content_.groups.push_back({content_.polygons.size(), std::move(statement)});
  }

  void read_library() {
    std::string names;
    for (std::string_view name = cursor_.word(); !name.empty(); name = cursor_.word()) {
      names.append(names.empty() ? "" : " ").append(name);
    }
    if (!names.empty()) content_.libraries.push_back(std::move(names));
  }

  /// Texture indices may point forward, so their upper bound is known only at the end.
  void check_texture() const {
    const auto count = static_cast<int>(content_.texture.coordinates.size());
    std::size_t corner = 0;
    for (int face = 0; face < content_.polygons.size(); ++face) {
      for (; static_cast<int>(corner) < content_.polygons.offsets[face + 1]; ++corner) {
        if (content_.texture.corners[corner] < count) continue;
        cursor_.fail("the face of line " + std::to_string(content_.face_lines[face]) +
                     " uses texture coordinate " +
                     std::to_string(content_.texture.corners[corner] + 1) + ", expected 1 to " +
                     std::to_string(count));
      }
    }
  }

  TextCursor cursor_;
  MeshContent content_;
};

void append_face(std::string& text, const Connectivity& connectivity, int face) {
  const Polygons& polygons = connectivity.polygons;
  const bool textured = !connectivity.texture.corners.empty();
  text += 'f';
  for (int corner = polygons.offsets[face]; corner < polygons.offsets[face + 1]; ++corner) {
    text += ' ';
    append_integer(text, polygons.corners[corner] + 1);
    if (!textured || connectivity.texture.corners[corner] < 0) continue;
    text += '/';
    append_integer(text, connectivity.texture.corners[corner] + 1);
  }
  text += '\n';
}

/// True for line ends of the classic Mac OS.
bool ends_lines_in_cr(std::string_view text) {
  return text.find('\n') == text.npos && text.find('\r') != text.npos;
}

}  // namespace

MeshContent read_obj(const std::string& path, std::string_view bytes, const Context& context) {
  constexpr char kEndOfDosFile = '\x1a';
  bytes = without_padding(bytes);
  if (bytes.ends_with(kEndOfDosFile)) bytes.remove_suffix(1);
  if (!ends_lines_in_cr(bytes)) return ObjReader(path, bytes).read(context);
  std::string lines(bytes);
  std::ranges::replace(lines, '\r', '\n');
  return ObjReader(path, lines).read(context);
}

MeshFrame obj_frame(const Connectivity& connectivity, const std::vector<Field>&,
                    bool double_precision, const Context& context) {
  double_precision = double_precision || !fits_single_precision(connectivity.texture);
  std::string after;
  for (const Eigen::Vector2d& uv : connectivity.texture.coordinates) {
    after += "vt ";
    append_number(after, uv.x(), double_precision);
    after += ' ';
    append_number(after, uv.y(), double_precision);
    after += '\n';
  }
  auto group = connectivity.groups.begin();
  const int faces = connectivity.polygons.size();
  for (int face = 0; face <= faces; ++face) {
    report_element(context, face, faces - face, faces);
    for (; group != connectivity.groups.end() && group->first_face <= face; ++group) {
      after.append(group->statement).append("\n");
    }
    if (face < faces) append_face(after, connectivity, face);
  }
  return {{}, std::move(after), [double_precision](const PositionsView& positions) {
            return position_lines("v ", positions, double_precision);
          }};
}

}  // namespace mimetra
