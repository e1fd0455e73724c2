#include "toolkit/io/landmark_vertices.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>

#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

int vertex_of_word(const TextCursor& text, std::string_view word) {
  const long long value = text.integer(word, "a vertex");
  if (value < 0 || value > std::numeric_limits<int>::max()) {
    text.fail("vertex " + std::to_string(value) + " is out of range; vertices are 0-based");
  }
  return static_cast<int>(value);
}

/// Moves to the next line. Throws IoError if words are left on this line.
void finish_line(TextCursor& text) {
  const std::string_view found = text.word();
  if (!found.empty()) text.fail_expected("the end of the line", found);
  text.next_line();
}

/// Reads the subset of TOML that eos uses.
LandmarkMapping read_sections(TextCursor& text) {
  LandmarkMapping mapping;
  std::set<std::string> seen;
  bool wanted = false;
  for (std::string_view word = text.word_anywhere(); !word.empty(); word = text.word_anywhere()) {
    if (word.starts_with('[')) {
      wanted = word == "[landmark_mappings]";
      text.next_line();
      continue;
    }
    if (!wanted) {
      text.next_line();
      continue;
    }
    std::string name(word);
    std::erase(name, '"');
    const std::string_view equals = text.word();
    if (equals != "=") text.fail_expected("'=' after the landmark '" + name + "'", equals);
    if (!seen.insert(name).second) text.fail("the landmark '" + name + "' occurs twice");
    const int index = vertex_of_word(text, text.word());
    mapping.emplace_back(std::move(name), index);
    finish_line(text);
  }
  return mapping;
}

LandmarkMapping read_list(TextCursor& text) {
  LandmarkMapping mapping;
  for (std::string_view word = text.word_anywhere(); !word.empty(); word = text.word_anywhere()) {
    mapping.emplace_back(std::to_string(mapping.size() + 1), vertex_of_word(text, word));
    finish_line(text);
  }
  return mapping;
}

}  // namespace

LandmarkMapping read_landmark_mapping(const fs::path& path) {
  const std::string name = path.string(), bytes = read_file(path);
  const std::string_view content = without_byte_order_mark(bytes);
  constexpr TextCursor::Syntax kComments{.comments = true};
  TextCursor first(name, content, kComments), text(name, content, kComments);
  const LandmarkMapping mapping =
      first.word_anywhere().starts_with('[') ? read_sections(text) : read_list(text);
  if (mapping.empty()) {
    throw IoError(name,
                  "maps no landmark; expected [landmark_mappings] with lines 'landmark = vertex', "
                  "or one vertex a line");
  }
  return mapping;
}

std::vector<fs::path> landmark_mappings(const fs::path& model) {
  const fs::path folder = fs::is_directory(model) ? model : model.parent_path();
  std::vector<fs::path> found;
  std::error_code missing;  // a missing folder has no mappings
  for (const fs::path& file : fs::directory_iterator(folder.empty() ? "." : folder, missing)) {
    const std::string name = file.filename().string();
    if (name == "landmarks68.txt" || (name.starts_with("ibug_to_") && name.ends_with(".txt"))) {
      found.push_back(file);
    }
  }
  std::ranges::sort(found);
  return found;
}

fs::path find_landmark_mapping(const fs::path& model) {
  const std::vector<fs::path> found = landmark_mappings(model);
  if (found.size() == 1) return found.front();
  const fs::path folder = fs::is_directory(model) ? model : model.parent_path();
  throw IoError(folder.empty() ? "." : folder.string(),
                found.empty()
                    ? "holds no landmark mapping; expected ibug_to_*.txt or "
                      "landmarks68.txt, or name a mapping with option 'mapping'"
                    : "holds several landmark mappings, such as " + found[0].filename().string() +
                          " and " + found[1].filename().string() +
                          "; name one with option 'mapping'");
}

LandmarkVertices ibug_landmarks(const LandmarkMapping& mapping) {
  LandmarkVertices landmarks;
  for (const auto& [name, vertex] : mapping) {
    int number = 0;
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, number);
    const bool is_number = error == std::errc() && stop == end;
    if (is_number && number >= 1 && number <= kFaceLandmarks) {
      landmarks.emplace_back(number - 1, vertex);
    }
  }
  return landmarks;
}

}  // namespace mimetra
