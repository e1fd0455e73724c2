#include "fitting/landmark_mapping.h"

#include <algorithm>
#include <limits>
#include <set>

#include "fitting/landmark_formats.h"
#include "fitting/mediapipe.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

int vertex(const TextCursor& text, std::string_view word) {
  const long long value = text.integer(word, "a vertex");
  if (value < 0 || value > std::numeric_limits<int>::max()) {
    text.fail("vertex " + std::to_string(value) + " is out of range; vertices are 0-based");
  }
  return static_cast<int>(value);
}

/// Moves behind a line that is done. Throws IoError where it is not.
void finish_line(TextCursor& text) {
  const std::string_view found = text.word();
  if (!found.empty()) text.fail_expected("the end of the line", found);
  text.next_line();
}

/// The part of TOML that eos uses.
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
    const int index = vertex(text, text.word());
    mapping.emplace_back(std::move(name), index);
    finish_line(text);
  }
  return mapping;
}

LandmarkMapping read_list(TextCursor& text) {
  LandmarkMapping mapping;
  for (std::string_view word = text.word_anywhere(); !word.empty(); word = text.word_anywhere()) {
    mapping.emplace_back(std::to_string(mapping.size() + 1), vertex(text, word));
    finish_line(text);
  }
  return mapping;
}

std::vector<Eigen::Index> outline_columns(const LandmarkTrack& track,
                                          const LandmarkMapping& mapping) {
  constexpr int kAll = 68, kJaw = 17;
  std::vector<Eigen::Index> columns;
  if (track.names != numbered_names(kAll)) return columns;
  for (Eigen::Index i = 0; i < kJaw; ++i) {
    const std::string& name = track.names[static_cast<std::size_t>(i)];
    const bool known =
        std::ranges::any_of(mapping, [&](const auto& each) { return each.first == name; });
    if (!known) columns.insert(columns.end(), {2 * i, 2 * i + 1});
  }
  return columns;
}

/// Numbered landmarks are those of a scheme, which has as many as its largest number.
void check_scheme(const std::string& name, const LandmarkTrack& track) {
  if (track.names != numbered_names(track.names.size())) return;
  throw MismatchError("the mapping has a landmark '" + name + "', but there are only 1 to " +
                      std::to_string(track.landmarks()) + "; is it for another set of landmarks?");
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

fs::path find_landmark_mapping(const fs::path& model) {
  const fs::path folder = fs::is_directory(model) ? model : model.parent_path();
  std::vector<fs::path> found;
  std::error_code missing;  // then nothing is found, which is reported below
  for (const fs::path& file : fs::directory_iterator(folder.empty() ? "." : folder, missing)) {
    const std::string name = file.filename().string();
    if (name == "landmarks68.txt" || (name.starts_with("ibug_to_") && name.ends_with(".txt"))) {
      found.push_back(file);
    }
  }
  if (found.size() == 1) return found.front();
  std::ranges::sort(found);
  throw IoError(folder.empty() ? "." : folder.string(),
                found.empty()
                    ? "holds no landmark mapping; expected ibug_to_*.txt or "
                      "landmarks68.txt, or name a mapping with option 'mapping'"
                    : "holds several landmark mappings, such as " + found[0].filename().string() +
                          " and " + found[1].filename().string() +
                          "; name one with option 'mapping'");
}

MappedLandmarks map_landmarks(const LandmarkTrack& track, const LandmarkMapping& mapping) {
  std::vector<Eigen::Index> columns;
  MappedLandmarks mapped;
  for (const auto& [name, index] : mapping) {
    const std::string known = is_mediapipe(track) ? mediapipe_name(name).value_or(name) : name;
    const auto found = std::ranges::find(track.names, known);
    if (found == track.names.end()) {
      check_scheme(name, track);
      continue;
    }
    const auto landmark = found - track.names.begin();
    columns.insert(columns.end(), {2 * landmark, 2 * landmark + 1});
    mapped.vertices.push_back(index);
  }
  if (columns.empty()) {
    throw MismatchError("none of the " + std::to_string(track.landmarks()) +
                        " landmarks is in the mapping; the first is '" +
                        (track.names.empty() ? "" : track.names.front()) +
                        "', the mapping's first '" +
                        (mapping.empty() ? "" : mapping.front().first) + "'");
  }
  mapped.points = track.points(Eigen::all, columns);
  mapped.outline = track.points(Eigen::all, outline_columns(track, mapping));
  return mapped;
}

}  // namespace mimetra
