#include "toolkit/io/marker_file.h"

#include <limits>

#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

struct NumberLine {
  int line;
  std::string name;  ///< name before the numbers
  std::vector<long long> numbers;
};

bool is_name(std::string_view word) {
  return word == "-" || (word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z');
}

std::vector<NumberLine> number_lines(const std::string& path, std::string_view text) {
  std::string spaced;
  for (const char c : text) {
    const bool parts = std::string_view(",;:[](){}\"'").find(c) != std::string_view::npos;
    if (parts || c == '#') spaced += ' ';
    if (!parts) spaced += c;
  }
  TextCursor cursor(path, without_byte_order_mark(spaced), {.comments = true});
  std::vector<NumberLine> lines;
  for (; !cursor.at_end(); cursor.next_line()) {
    NumberLine found{cursor.line(), "", {}};
    std::string_view word = cursor.word();
    for (; !word.empty() && is_name(word) && found.numbers.empty(); word = cursor.word()) {
      if (word != "-") found.name = lower_case(std::string(word));
    }
    for (; !word.empty(); word = cursor.word()) {
      found.numbers.push_back(cursor.integer(word, "a vertex"));
    }
    if (!found.numbers.empty()) lines.push_back(std::move(found));
  }
  return lines;
}

[[noreturn]] void fail(const std::string& path, int line, const std::string& message) {
  throw IoError(path, "line " + std::to_string(line) + ": " + message);
}

VertexIndex vertex_of_file(const std::string& path, int line, long long number, int base) {
  if (number < base || number > std::numeric_limits<VertexIndex>::max()) {
    fail(path, line,
         "vertex " + std::to_string(number) + ", expected one from " + std::to_string(base) +
             " on, where the file's count begins");
  }
  return static_cast<VertexIndex>(number - base);
}

bool are_two_lists(const std::vector<NumberLine>& lines) {
  return lines.size() == 2 && lines[0].numbers.size() > 2 &&
         lines[0].numbers.size() == lines[1].numbers.size();
}

MarkerFile markers_of_lists(const std::string& path, const std::vector<NumberLine>& lines,
                            int base) {
  const bool target_first = lines[0].name == "target" || lines[1].name == "source";
  for (const NumberLine& list : lines) {
    const bool is_target = target_first == (&list == &lines[0]);
    if (list.name.empty() || list.name == (is_target ? "target" : "source")) continue;
    fail(path, list.line,
         "a list of vertices named '" + list.name + "', expected one 'source' and one 'target'");
  }
  const NumberLine &source = lines[target_first ? 1 : 0], &target = lines[target_first ? 0 : 1];
  MarkerFile found;
  for (std::size_t i = 0; i < source.numbers.size(); ++i) {
    found.markers.push_back({vertex_of_file(path, source.line, source.numbers[i], base),
                             vertex_of_file(path, target.line, target.numbers[i], base)});
    found.lines.push_back(source.line);
  }
  return found;
}

MarkerFile markers_of_pairs(const std::string& path, const std::vector<NumberLine>& lines,
                            int base) {
  const bool counted = !lines.empty() && lines.front().numbers.size() == 1;
  MarkerFile found;
  for (std::size_t i = counted ? 1 : 0; i < lines.size(); ++i) {
    const NumberLine& pair = lines[i];
    if (pair.numbers.size() != 2) {
      fail(path, pair.line,
           "expected two vertices, of the source and of the target, found " +
               std::to_string(pair.numbers.size()));
    }
    found.markers.push_back({vertex_of_file(path, pair.line, pair.numbers[0], base),
                             vertex_of_file(path, pair.line, pair.numbers[1], base)});
    found.lines.push_back(pair.line);
  }
  if (counted && lines.front().numbers[0] != static_cast<long long>(found.markers.size())) {
    fail(path, lines.front().line,
         "announces " + std::to_string(lines.front().numbers[0]) + " markers, found " +
             std::to_string(found.markers.size()));
  }
  return found;
}

}  // namespace

MarkerFile read_marker_file(const std::filesystem::path& path, int index_base) {
  const std::string name = path.string();
  const std::vector<NumberLine> lines = number_lines(name, read_file(path));
  MarkerFile found = are_two_lists(lines) ? markers_of_lists(name, lines, index_base)
                                          : markers_of_pairs(name, lines, index_base);
  if (found.markers.empty()) throw IoError(name, "holds no marker");
  return found;
}

std::vector<Marker> read_markers(const std::filesystem::path& path, int index_base) {
  return read_marker_file(path, index_base).markers;
}

std::string marker_text(const std::vector<Marker>& markers,
                        const std::vector<std::string>& comments,
                        const std::vector<std::string>& header) {
  std::string text;
  for (const std::string& line : header) text += "# " + line + '\n';
  for (std::size_t i = 0; i < markers.size(); ++i) {
    text += std::to_string(markers[i].source) + ' ' + std::to_string(markers[i].target);
    if (!comments.empty()) text += "  # " + comments.at(i);
    text += '\n';
  }
  return text;
}

}  // namespace mimetra
