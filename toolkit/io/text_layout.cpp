#include <charconv>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "toolkit/io/mesh_content.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

const char* skipped_blanks(const char* at, const char* end) {
  while (at != end && is_blank(*at)) ++at;
  return at;
}

/// Start of the next line.
const char* next_line(const char* at, const char* end) {
  const void* found =
      at == end ? nullptr : std::memchr(at, '\n', static_cast<std::size_t>(end - at));
  return found ? static_cast<const char*>(found) + 1 : end;
}

/// True if '\\' may join two lines. Such files are left to the full reader.
bool may_continue(std::string_view text) {
  for (auto at = text.find('\\'); at != text.npos; at = text.find('\\', at + 1)) {
    if (at + 1 == text.size() || ends_word(text[at + 1])) return true;
  }
  return false;
}

bool may_continue(const char* at, const char* end) {
  return may_continue({at, static_cast<std::size_t>(end - at)});
}

/// Reads "x y z" and skips the rest of the line, such as colours. Returns the start of the next
/// line; null for anything unusual.
const char* read_position(const char* at, const char* end, double* position) {
  for (int axis = 0; axis < 3; ++axis) {
    at = skipped_blanks(at, end);
    const auto [last, error] = std::from_chars(at, end, position[axis]);
    if (error != std::errc() || !is_coordinate(position[axis])) return nullptr;
    if (last != end && !ends_word(*last)) return nullptr;
    at = last;
  }
  if (at != end && *at == '\n') return at + 1;
  const char* next = next_line(at, end);
  return may_continue(at, next) ? nullptr : next;
}

/// Effect of an OBJ line on positions and faces.
enum class Line { vertex, counted, passed_over, unknown };

Line kind_of(const char* at, const char* end) {
  at = skipped_blanks(at, end);
  if (at == end || *at == '\n' || *at == '#') return Line::passed_over;
  const char* last = at;
  while (last != end && !ends_word(*last)) ++last;
  const std::string_view keyword(at, static_cast<std::size_t>(last - at));
  if (keyword == "v") return Line::vertex;
  if (keyword == "f" || keyword == "vt") return Line::counted;
  // Groups, materials and normals may change from frame to frame.
  return is_letter(*at) ? Line::passed_over : Line::unknown;
}

/// Runs of f and vt lines. Between them are vertices, and lines that do not affect faces.
class ObjLayout {
 public:
  ObjLayout(std::string first, const Context& context) : first_(std::move(first)) {
    const std::string_view text = without_byte_order_mark(first_);
    const char *at = text.data(), *end = at + text.size();
    std::size_t vertices = 0;
    bool in_run = false;
    for (std::size_t line = 0; at != end; ++line) {
      report_element(context, line, static_cast<std::size_t>(end - at), text.size());
      const Line kind = kind_of(at, end);
      const char* next = next_line(at, end);
      if (kind == Line::vertex) ++vertices;
      if (kind == Line::counted) {
        if (!in_run) runs_.push_back({vertices, std::string_view(at, at)});
        std::string_view& run = runs_.back().text;
        run = {run.data(), static_cast<std::size_t>(next - run.data())};
      }
      in_run = kind == Line::counted;
      at = next;
    }
  }

  bool read(std::string_view bytes, std::span<double> coordinates) const {
    const std::string_view text = without_byte_order_mark(bytes);
    const char *at = text.data(), *end = at + text.size();
    const std::size_t vertices = coordinates.size() / 3;
    std::size_t vertex = 0;
    auto run = runs_.begin();
    while (at && at != end) {
      if (*at == 'v' && at + 1 != end && is_blank(at[1]) && vertex < vertices) {
        at = read_position(at + 1, end, &coordinates[3 * vertex++]);
        continue;
      }
      switch (kind_of(at, end)) {
        case Line::counted:
          if (run == runs_.end() || run->vertices_before != vertex) return false;
          at = behind(run++->text, at, end);
          break;
        case Line::passed_over:
          at = behind_passed_over(at, end);
          break;
        default:
          return false;
      }
    }
    return at && vertex == vertices && run == runs_.end();
  }

 private:
  struct Run {
    std::size_t vertices_before;  ///< negative indices count back from here
    std::string_view text;
  };

  static const char* behind(std::string_view run, const char* at, const char* end) {
    const auto left = static_cast<std::size_t>(end - at);
    if (left < run.size() || std::memcmp(at, run.data(), run.size()) != 0) return nullptr;
    // A run whose last line has no line end could continue.
    return run.back() == '\n' || left == run.size() ? at + run.size() : nullptr;
  }

  static const char* behind_passed_over(const char* at, const char* end) {
    const char* next = next_line(at, end);
    return may_continue(at, next) ? nullptr : next;
  }

  const std::string first_;
  std::vector<Run> runs_;
};

/// Layout from the bytes before and after the lines of the vertices.
class OffLayout {
 public:
  /// `start` is the offset of the vertices' lines.
  OffLayout(std::string first, std::size_t start) : first_(std::move(first)), start_(start) {}

  /// Finds the end of the vertices. Returns false if some are not on lines of their own.
  bool learn(std::span<double> coordinates) {
    const char* end = first_.data() + first_.size();
    const char* behind = read_lines(first_.data() + start_, end, coordinates);
    if (behind) after_ = {behind, static_cast<std::size_t>(end - behind)};
    return behind != nullptr;
  }

  bool read(std::string_view bytes, std::span<double> coordinates) const {
    if (bytes.size() < start_ || std::memcmp(bytes.data(), first_.data(), start_) != 0) {
      return false;
    }
    const char* end = bytes.data() + bytes.size();
    const char* behind = read_lines(bytes.data() + start_, end, coordinates);
    return behind && std::string_view(behind, static_cast<std::size_t>(end - behind)) == after_;
  }

 private:
  static const char* read_lines(const char* at, const char* end, std::span<double> coordinates) {
    for (std::size_t i = 0; at && i < coordinates.size(); i += 3) {
      at = read_position(at, end, &coordinates[i]);
    }
    return at;
  }

  const std::string first_;
  std::size_t start_;
  std::string_view after_;
};

}  // namespace

FurtherReader obj_further_reader(std::string first, std::size_t, const Context& context) {
  if (may_continue(first)) return {};
  return [layout = std::make_shared<const ObjLayout>(std::move(first), context)](
             std::string_view bytes, std::span<double> coordinates) {
    return layout->read(bytes, coordinates);
  };
}

FurtherReader off_further_reader(std::string first, std::size_t vertices, const Context&) {
  // Skip the keyword and the counts, which comments may interrupt, up to the end of their line.
  const std::string unnamed;
  TextCursor cursor(unnamed, without_byte_order_mark(first), {.comments = true});
  for (int word = 0; word < 3; ++word) cursor.word_anywhere();
  cursor.next_line();
  const std::size_t start = first.size() - cursor.left();
  const auto layout = std::make_shared<OffLayout>(std::move(first), start);
  std::vector<double> coordinates(3 * vertices);
  if (!layout->learn(coordinates)) return {};
  return [layout](std::string_view bytes, std::span<double> further) {
    return layout->read(bytes, further);
  };
}

}  // namespace mimetra
