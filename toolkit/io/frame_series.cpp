#include "toolkit/io/frame_series.h"

#include <algorithm>
#include <map>

#include "toolkit/io/file_numbers.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

std::string folder_text(const fs::path& folder) {
  const std::string text = folder.string();
  return text.empty() || text.back() == '/' ? text : text + '/';
}

/// Returns "f_%04d.obj" for "0012" of the series "f_*.obj".
std::string pattern_of(const NumberedName& name) {
  const std::string digits = name.text.substr(name.text.starts_with('-') ? 1 : 0);
  const bool is_padded = digits.size() > 1 && digits[0] == '0';
  std::string pattern = name.series;
  return pattern.replace(pattern.find('*'), 1,
                         is_padded ? "%0" + std::to_string(digits.size()) + "d" : "%d");
}

/// Throws IoError if two files have one number, such as frame_1.obj and frame_01.obj.
void check_numbers(const std::vector<fs::path>& frames) {
  std::map<std::pair<std::string, long long>, fs::path> known;
  for (const fs::path& frame : frames) {
    const NumberedName name = numbered(frame);
    if (name.series.empty()) continue;
    const auto [first, is_new] = known.try_emplace({name.series, name.number}, frame);
    if (is_new) continue;
    const fs::path folder = first->second.parent_path();
    const std::string has = "has the number of ", number = std::to_string(name.number);
    if (frame.parent_path() != folder) {
      throw IoError(frame.string(), has + first->second.string() + ", " + number +
                                        ", as frames of several takes; name one folder, " +
                                        folder.string() + " or " + frame.parent_path().string());
    }
    throw IoError(frame.string(), has + first->second.filename().string() + ", " + number +
                                      "; name the frames by a pattern, '" +
                                      (folder / pattern_of(numbered(first->second))).string() +
                                      "' or '" + (folder / pattern_of(name)).string() + "'");
  }
}

void check_order(const std::vector<fs::path>& frames) {
  const auto unclear = unclear_order(frames);
  if (!unclear) return;
  const NumberedName name = numbered(unclear->second);
  const fs::path folder = unclear->second.parent_path();
  throw IoError(unclear->second.string(),
                "comes before " + unclear->first.filename().string() +
                    " if their numbers are decimal, and behind it if not; give all names as many "
                    "digits behind the point" +
                    (name.series.empty() ? ""
                                         : ", or name whole numbers by a pattern, '" +
                                               (folder / pattern_of(name)).string() + "'"));
}

/// Returns "7" or "12 to 15".
std::string run_of(long long first, long long last) {
  const std::string text = std::to_string(first);
  return first == last ? text : text + " to " + std::to_string(last);
}

/// Notes that all numbers are negative, because their '-' may not be a sign.
void note_numbers(FrameSeries& found, const std::string& name) {
  const NumberedName first = numbered(found.frames.front());
  const NumberedName last = numbered(found.frames.back());
  if (first.series.empty() || found.frames.size() < 2 || last.series != first.series) return;
  if (last.number >= 0) return;
  found.notes.push_back(name + ": all frames have numbers below 0, " + first.text + " to " +
                        last.text + "; where '-' is no sign, they are in the wrong order");
}

/// True if all numbers are small enough that their differences cannot overflow.
bool are_countable(const std::vector<long long>& numbers) {
  constexpr long long kMost = 1'000'000'000'000;
  return std::ranges::all_of(numbers,
                             [](long long number) { return -kMost < number && number < kMost; });
}

bool rise(const std::vector<long long>& numbers) {
  return std::ranges::adjacent_find(numbers, std::ranges::greater_equal()) == numbers.end();
}

void note_missing(FrameSeries& found, const std::string& name) {
  const std::vector<std::string> missing = missing_numbers(found.frames);
  if (missing.empty()) return;
  found.notes.push_back(name + ": no file has these numbers: " + listed(missing) +
                        "; without times beside them frames follow each other without a pause");
}

/// Number of files in each numbered series of two or more files.
std::map<std::string, std::size_t> numbered_series(const std::vector<fs::path>& files) {
  std::map<std::string, std::size_t> sizes;
  for (const fs::path& file : files) ++sizes[numbered(file).series];
  std::erase_if(sizes, [](const auto& entry) { return entry.first.empty() || entry.second < 2; });
  return sizes;
}

/// Series that more than half of the files belong to; empty if there is none or it has only one
/// file.
std::string main_series(const std::vector<fs::path>& files) {
  for (const auto& [series, size] : numbered_series(files)) {
    if (2 * size > files.size()) return series;
  }
  return {};
}

std::string names_of(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const fs::path& file : files) names.push_back(file.filename().string());
  return listed(names, 4);
}

/// Moves the files that are not of the main series out of `files`. Files of another format stay,
/// because they make the choice ambiguous.
std::vector<fs::path> strangers_in(std::vector<fs::path>& files) {
  std::vector<fs::path> strangers;
  const std::string series = main_series(files);
  if (series.empty()) return strangers;
  const std::string extension = lower_extension(series);
  std::erase_if(files, [&](const fs::path& file) {
    if (numbered(file).series == series || lower_extension(file) != extension) return false;
    strangers.push_back(file);
    return true;
  });
  return strangers;
}

/// Returns "t_*.*.obj" for the series "t_0.*.obj", whose number follows a point; "" for others.
std::string across_point(const std::string& series) {
  const std::size_t star = series.find('*');
  if (star == std::string::npos || star < 2 || series[star - 1] != '.') return {};
  std::size_t first = star - 1;
  while (first > 0 && is_digit(series[first - 1])) --first;
  return first == star - 1 ? "" : series.substr(0, first) + '*' + series.substr(star - 1);
}

/// Throws IoError if strangers continue the series behind another number before the point, as
/// t_1.00.obj continues t_0.96.obj.
void check_points(const FrameSeries& found, const std::vector<fs::path>& strangers,
                  const fs::path& folder) {
  if (found.frames.empty()) return;
  const std::string series = numbered(found.frames.front()).series;
  const std::string across = across_point(series);
  const auto stranger = std::ranges::find_if(strangers, [&across](const fs::path& file) {
    return !across.empty() && across_point(numbered(file).series) == across;
  });
  if (stranger == strangers.end()) return;
  throw IoError(stranger->string(), "may continue " + series + "; name all frames by '" +
                                        folder_text(folder) + across + "', or some by '" +
                                        folder_text(folder) + series + "'");
}

struct SplitFiles {
  FrameSeries series;
  std::vector<fs::path> strangers;
};

SplitFiles split(std::vector<fs::path> files) {
  FrameSeries found;
  if (std::ranges::count_if(files, is_neutral) == 1 && files.size() > 1) {
    const auto neutral = std::ranges::find_if(files, is_neutral);
    found.rest = *neutral;
    files.erase(neutral);
  }
  std::vector<fs::path> strangers = strangers_in(files);
  found.frames = std::move(files);
  return {std::move(found), std::move(strangers)};
}

}  // namespace

bool is_neutral(const fs::path& file) {
  return lower_case(file.stem().string()) == "neutral";
}

FrameSeries frames_among(std::vector<fs::path> files) {
  return split(std::move(files)).series;
}

FrameSeries series_in_folder(std::vector<fs::path> files, const fs::path& folder) {
  auto [found, strangers] = split(std::move(files));
  if (!strangers.empty()) {
    found.notes.push_back(folder_text(folder) + ": " + names_of(strangers) +
                          (strangers.size() == 1 ? " is" : " are") + " left out of the " +
                          std::to_string(found.frames.size()) + " frames " +
                          numbered(found.frames.front()).series +
                          "; name files by a pattern to take them");
  }
  if (found.rest) {
    found.notes.push_back(found.rest->string() + ": is taken for the rest pose of the other " +
                          std::to_string(found.frames.size()) +
                          " files, and is no frame; name files by a pattern to take it for one");
  }
  check_points(found, strangers, folder);
  check_links(found.frames);
  check_numbers(found.frames);
  check_order(found.frames);
  note_numbers(found, folder_text(folder));
  note_missing(found, folder_text(folder));
  return found;
}

void check_one_series(const std::vector<fs::path>& files, const fs::path& folder) {
  const std::map<std::string, std::size_t> all = numbered_series(files);
  if (all.size() < 2 || !main_series(files).empty()) return;
  std::vector<std::string> series, patterns;
  for (const auto& [name, size] : all) {
    series.push_back(std::to_string(size) + " files " + name);
    patterns.push_back("'" + folder_text(folder) + name + "'");
  }
  throw IoError(folder.string(), "holds several takes, " + listed(series, 4) +
                                     "; name one by a pattern, " + listed(patterns, 4) +
                                     ", or all by '" + folder_text(folder) + '*' +
                                     files.front().extension().string() + "'");
}

void check_are_numbered(const std::vector<fs::path>& files, const fs::path& folder) {
  std::size_t numbered = 0;
  for (const auto& [series, size] : numbered_series(files)) numbered += size;
  if (files.size() < 2 || 2 * numbered > files.size()) return;
  throw MismatchError(folder.string() + ": holds " + std::to_string(files.size()) +
                      " meshes without frame numbers (" + names_of(files) +
                      "), which look like named shapes of a model; to read them as frames in this "
                      "order, give the pattern '" +
                      folder_text(folder) + '*' + files.front().extension().string() + "'");
}

FrameSeries series_of_pattern(std::vector<fs::path> files, const std::string& pattern,
                              bool are_whole_numbers) {
  FrameSeries found{std::move(files)};
  check_links(found.frames);
  check_numbers(found.frames);
  if (!are_whole_numbers) check_order(found.frames);
  std::vector<fs::path> numbered_frames = found.frames;
  const std::vector<fs::path> strangers = strangers_in(numbered_frames);
  if (!strangers.empty()) {
    found.notes.push_back(pattern + ": " + names_of(strangers) +
                          (strangers.size() == 1 ? " is a frame" : " are frames") +
                          " too, as the pattern says, beside " +
                          std::to_string(numbered_frames.size()) + " of one series");
  }
  note_numbers(found, pattern);
  note_missing(found, pattern);
  return found;
}

std::vector<std::string> missing_numbers(const std::vector<fs::path>& files) {
  if (files.empty()) return {};
  const std::string series = numbered(files.front()).series;
  if (series.empty()) return {};
  std::vector<long long> numbers;
  for (const fs::path& file : files) {
    const NumberedName name = numbered(file);
    if (name.series != series) return {};
    numbers.push_back(name.number);
  }
  return missing_numbers(std::move(numbers));
}

std::vector<std::string> missing_numbers(std::vector<long long> numbers) {
  std::ranges::sort(numbers);
  if (std::ranges::adjacent_find(numbers) != numbers.end()) return {};
  long long step = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const long long way = numbers[i] - numbers[i - 1];
    step = step == 0 ? way : std::min(step, way);
  }
  std::vector<std::string> missing;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i] - numbers[i - 1] == step) continue;
    missing.push_back(
        run_of(numbers[i - 1] + step, std::max(numbers[i - 1] + step, numbers[i] - step)));
  }
  return missing;
}

bool holds_frame_numbers(const std::string& name) {
  const std::string plain = lower_case(name);
  return plain == "frame" || plain == "frame_index" || plain == "frameindex" ||
         plain == "frame_number" || plain == "framenumber";
}

RowNumbers row_numbers(const std::vector<long long>& numbers) {
  RowNumbers found;
  if (!are_countable(numbers)) return found;
  if (const std::vector<std::string> missing = missing_numbers(numbers); !missing.empty()) {
    found.note = "no row has these frames: " + listed(missing) +
                 "; without times frames follow each other without a pause";
  }
  if (numbers.size() < 2 || !rise(numbers)) return found;
  std::vector<long long> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) steps.push_back(numbers[i] - numbers[i - 1]);
  const long long least = std::ranges::min(steps);
  const auto fits = [least](long long step) { return step % least == 0; };
  if (std::ranges::all_of(steps, fits)) found.step = least;
  return found;
}

Eigen::VectorXd times_at_rate(double fps, Eigen::Index rows,
                              const std::vector<long long>& numbers) {
  Eigen::VectorXd times(rows);
  const bool by_numbers = std::ssize(numbers) == rows && are_countable(numbers) && rise(numbers);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto at = static_cast<std::size_t>(row);
    times[row] = static_cast<double>(by_numbers ? numbers[at] - numbers[0] : row) / fps;
  }
  return times;
}

std::string series_name(const fs::path& file) {
  return numbered(file).series;
}

void check_links(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    std::error_code error;
    if (fs::exists(file, error) || !fs::is_symlink(file, error)) continue;
    throw IoError(file.string(), "is a link that leads nowhere, to " +
                                     fs::read_symlink(file, error).string() +
                                     "; mend it, or remove it where the frame is not meant");
  }
}

}  // namespace mimetra
