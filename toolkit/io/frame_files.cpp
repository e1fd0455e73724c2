#include "toolkit/io/frame_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include <glob.h>

#include "toolkit/io/file_numbers.h"
#include "toolkit/io/format.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Position and width of `%d`, `%4d` or `%04d` in a file's name.
struct NumberField {
  std::size_t begin;
  std::size_t end;
  std::size_t width;
};

std::optional<NumberField> number_field(const std::string& name) {
  const std::size_t begin = name.find('%');
  if (begin == std::string::npos) return std::nullopt;
  std::size_t at = begin + 1;
  std::size_t width = 0;
  // File names have at most 255 characters.
  for (; at < name.size() && is_digit(name[at]) && width < 256; ++at) {
    width = 10 * width + static_cast<std::size_t>(name[at] - '0');
  }
  if (at >= name.size() || name[at] != 'd') return std::nullopt;
  return NumberField{begin, at + 1, width};
}

/// Returns the digits between `before` and `after` in a name, without a '-' that is a sign
/// (file_numbers.h). Returns "" if anything else is between them.
std::string digits_between(const std::string& name, const std::string& before,
                           const std::string& after) {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) ||
      !name.ends_with(after)) {
    return {};
  }
  std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
  if (minus_is_sign(before) && digits.starts_with('-')) digits.erase(0, 1);
  return std::ranges::all_of(digits, is_digit) ? digits : std::string();
}

/// True if printf would write `name` for some number.
bool matches(const std::string& name, const std::string& pattern, const NumberField& field) {
  const std::string digits =
      digits_between(name, pattern.substr(0, field.begin), pattern.substr(field.end));
  if (digits.empty()) return false;
  const bool padded = digits.size() > 1 && digits[0] == '0';
  // printf includes the sign in the width; other programs do not.
  const std::size_t width = name.size() + field.end - field.begin - pattern.size();
  return padded ? digits.size() == field.width || width == field.width : width >= field.width;
}

/// Dangling links were meant as files, so they are kept; the reader reports them.
bool is_file_or_dangling(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) ||
         (fs::is_symlink(path, error) && !fs::exists(path, error));
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (!hidden && is_file_or_dangling(entry->path())) {
      files.push_back(folder / entry->path().filename());
    }
  }
  if (error) throw IoError(folder.string(), "cannot be read: " + error.message());
  return files;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

std::vector<fs::path> files_of_printf(const fs::path& pattern, const NumberField& field) {
  std::vector<fs::path> files;
  std::error_code missing;
  if (!fs::is_directory(folder_of(pattern), missing)) return files;
  for (const fs::path& file : files_in(pattern.parent_path())) {
    if (matches(file.filename().string(), pattern.filename().string(), field)) {
      files.push_back(file);
    }
  }
  return files;
}

/// Files that match a glob. Brackets are literal: people use them in names, but not for character
/// classes.
std::vector<fs::path> files_of_glob(const std::string& pattern) {
  std::string escaped;
  for (const char c : pattern) escaped += c == '[' ? "[[]" : std::string(1, c);
  std::vector<fs::path> files;
  glob_t found = {};
  if (glob(escaped.c_str(), GLOB_NOSORT | GLOB_NOESCAPE, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      if (is_file_or_dangling(found.gl_pathv[i])) files.emplace_back(found.gl_pathv[i]);
    }
  }
  globfree(&found);
  return files;
}

/// Number field of a printf pattern. Returns none for globs: `*` or `?` in the file name, or in the
/// name of a folder that does not exist.
std::optional<NumberField> printf_field(const fs::path& pattern) {
  constexpr const char* kGlob = "*?";
  const std::string name = pattern.filename().string();
  std::error_code missing;
  const bool is_glob = name.find_first_of(kGlob) != std::string::npos ||
                       (pattern.string().find_first_of(kGlob) != std::string::npos &&
                        !fs::is_directory(folder_of(pattern), missing));
  return is_glob ? std::nullopt : number_field(name);
}

std::vector<fs::path> files_of_pattern(const std::string& pattern) {
  const auto field = printf_field(pattern);
  return field ? files_of_printf(pattern, *field) : files_of_glob(pattern);
}

/// Returns "matches no OBJ or PLY file".
std::string nothing_of(const std::string& verb, const std::vector<std::string>& extensions) {
  std::vector<std::string> names;
  names.reserve(extensions.size());
  for (const std::string& extension : extensions) names.push_back(upper_case(extension.substr(1)));
  return verb + " no " + joined(names, ", ", " or ") + " file";
}

/// Keeps files with the extensions, in natural order. Throws IoError if there are none.
std::vector<fs::path> mesh_files(std::vector<fs::path> files, const std::string& name,
                                 const std::vector<std::string>& extensions,
                                 const std::string& nothing) {
  std::erase_if(files, [&](const fs::path& file) {
    return std::ranges::find(extensions, lower_extension(file)) == extensions.end() ||
           (is_companion(file) && !is_companion(name));
  });
  if (files.empty()) throw IoError(name, nothing);
  sort_by_numbers(files);
  return files;
}

void check_one_format(const std::vector<fs::path>& files, const std::string& name,
                      const std::string& where) {
  for (const fs::path& file : files) {
    if (lower_extension(file) == lower_extension(files[0])) continue;
    throw IoError(name, where + " files of several formats, " + files[0].filename().string() +
                            " and " + file.filename().string() +
                            "; choose one with a pattern such as '*" +
                            files[0].extension().string() + "'");
  }
}

/// Files that a printf pattern would match with any number of digits, in natural order.
std::vector<fs::path> files_of_any_digits(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const auto field = printf_field(pattern);
  std::error_code missing;
  if (!field || !fs::is_directory(folder_of(pattern), missing)) return {};
  std::vector<fs::path> files = files_in(pattern.parent_path());
  std::erase_if(files, [&](const fs::path& file) {
    return digits_between(file.filename().string(), name.substr(0, field->begin),
                          name.substr(field->end))
        .empty();
  });
  sort_by_numbers(files);
  return files;
}

/// Pattern that matches all `files`, whatever their number of digits: a printf pattern, or a glob
/// if no printf pattern does.
std::string fitting_pattern(const fs::path& pattern, const std::vector<fs::path>& files) {
  const std::string name = pattern.filename().string();
  const NumberField field = *number_field(name);
  const std::string before = name.substr(0, field.begin), after = name.substr(field.end);
  std::size_t least = std::string::npos;
  for (const fs::path& file : files) {
    least = std::min(least, digits_between(file.filename().string(), before, after).size());
  }
  for (const std::string& digits : {std::string("%d"), "%0" + std::to_string(least) + "d"}) {
    const std::string fitting = before + digits + after;
    const auto matched = [&](const fs::path& file) {
      return matches(file.filename().string(), fitting, *number_field(fitting));
    };
    if (std::ranges::all_of(files, matched)) return (pattern.parent_path() / fitting).string();
  }
  return (pattern.parent_path() / (before + '*' + after)).string();
}

struct FrameRange {
  std::optional<int> first;
  std::optional<int> last;
  std::optional<int> step;
};

[[noreturn]] void throw_bad_range(const std::string& text) {
  throw std::invalid_argument("frames '" + text +
                              "': expected A:B:STEP with 0 <= A < B and STEP >= 1, such as 0:100, "
                              "50: or ::2");
}

FrameRange parsed_range(const std::string& text) {
  FrameRange range;
  const std::array<std::optional<int>*, 3> parts = {&range.first, &range.last, &range.step};
  std::size_t part = 0;
  for (std::size_t at = 0; at <= text.size(); ++part) {
    if (part == parts.size()) throw_bad_range(text);
    const std::size_t colon = std::min(text.find(':', at), text.size());
    if (colon > at) {
      int value = 0;
      const char* end = text.data() + colon;
      const auto [last, error] = std::from_chars(text.data() + at, end, value);
      if (error != std::errc() || last != end || value < 0) throw_bad_range(text);
      *parts[part] = value;
    }
    at = colon + 1;
  }
  const bool empty = range.last && range.first.value_or(0) >= *range.last;
  if (part < 2 || empty || range.step.value_or(1) < 1) throw_bad_range(text);
  return range;
}

}  // namespace

bool has_companions(const fs::path& path) {
  return std::ranges::find(kExtensionsWithCompanions, lower_extension(path)) !=
         kExtensionsWithCompanions.end();
}

bool is_companion(const fs::path& file) {
  const std::string name = file.string();
  return name.ends_with(kRestSuffix) || name.ends_with(kTopologySuffix);
}

bool is_frame_pattern(const std::string& text) {
  return text.find_first_of("*?") != std::string::npos ||
         number_field(fs::path(text).filename().string()).has_value();
}

std::vector<fs::path> files_named(const std::string& text) {
  std::error_code unreadable;
  std::vector<fs::path> files =
      fs::is_directory(text, unreadable) ? files_in(text) : files_of_pattern(text);
  sort_by_numbers(files);
  return files;
}

std::set<std::string> extensions_named(const std::string& text) {
  std::set<std::string> extensions;
  for (const fs::path& file : files_named(text)) extensions.insert(lower_extension(file));
  return extensions;
}

std::string note_on_digits(const std::string& pattern) {
  const std::vector<fs::path> all = files_of_any_digits(pattern);
  if (all.empty()) return "";
  const std::string name = fs::path(pattern).filename().string();
  const NumberField field = *number_field(name);
  std::vector<std::string> others;
  for (const fs::path& file : all) {
    const std::string other = file.filename().string();
    if (!matches(other, name, field)) others.push_back(other);
  }
  if (others.empty() || others.size() == all.size()) return "";
  return pattern + ": " + listed(others, 4) + (others.size() == 1 ? " is" : " are") +
         " left out of the " + std::to_string(all.size()) +
         " files that differ in their digits; write '" + fitting_pattern(pattern, all) +
         "' to take all";
}

FrameSeries frames_of_pattern(const std::string& pattern,
                              const std::vector<std::string>& extensions) {
  std::vector<fs::path> files = files_of_pattern(pattern);
  std::string nothing = nothing_of("matches", extensions);
  if (files.empty()) {
    if (const std::vector<fs::path> near = files_of_any_digits(pattern); !near.empty()) {
      throw IoError(pattern, "matches no file; '" + fitting_pattern(pattern, near) + "' matches " +
                                 near.front().filename().string() + " to " +
                                 near.back().filename().string());
    }
    const bool is_both =
        !printf_field(pattern) && number_field(fs::path(pattern).filename().string());
    if (is_both) nothing += "; beside '*' or '?' write '*' in the place of the number, too";
  }
  FrameSeries found = series_of_pattern(mesh_files(std::move(files), pattern, extensions, nothing),
                                        pattern, printf_field(pattern).has_value());
  check_one_format(found.frames, pattern, "matches");
  if (std::string note = note_on_digits(pattern); !note.empty()) {
    found.notes.push_back(std::move(note));
  }
  return found;
}

FrameSeries frames_of_folder(const fs::path& folder, const std::vector<std::string>& extensions) {
  const std::string name = folder.string();
  FrameSeries found = series_in_folder(
      mesh_files(files_in(folder), name, extensions, nothing_of("holds", extensions)), folder);
  check_one_format(found.frames, name, "holds");
  check_one_series(found.frames, folder);
  check_are_numbered(found.frames, folder);
  return found;
}

std::vector<fs::path> frames_of_format(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files = files_in(folder);
  std::erase_if(files, [&](const fs::path& file) {
    return lower_extension(file) != lower_case(extension) || is_companion(file);
  });
  sort_by_numbers(files);
  return frames_among(std::move(files)).frames;
}

std::vector<int> selected_frames(const std::optional<std::string>& range, int frames) {
  const FrameRange asked = range ? parsed_range(*range) : FrameRange{};
  const int first = asked.first.value_or(0), last = asked.last.value_or(frames);
  if (last > frames || first >= frames) {
    throw MismatchError("frames '" + range.value_or("") + "': the sequence has " +
                        std::to_string(frames) + (frames == 1 ? " frame" : " frames"));
  }
  std::vector<int> selected;
  const int step = asked.step.value_or(1);
  for (long long frame = first; frame < last; frame += step) {
    selected.push_back(static_cast<int>(frame));
  }
  return selected;
}

std::optional<int> end_of_frames(const std::optional<std::string>& range) {
  return range ? parsed_range(*range).last : std::nullopt;
}

fs::path beside(const fs::path& sequence, const std::string& suffix) {
  fs::path name = without_trailing_slash(sequence);
  if (name.filename() == "." || name.filename() == "..") {
    name = without_trailing_slash(fs::absolute(name));
  }
  if (has_companions(name)) name.replace_extension();
  return name += suffix;
}

fs::path name_with(const fs::path& sequence, const std::string& suffix) {
  std::error_code missing;
  if (fs::exists(beside(sequence, suffix), missing)) return sequence;
  const fs::path led_to = fs::canonical(sequence, missing);
  return !missing && fs::exists(beside(led_to, suffix), missing) ? led_to : sequence;
}

std::string frame_name(int frame, int frames, const std::string& extension) {
  constexpr std::size_t kLeastDigits = 4;
  const std::size_t digits = std::max(kLeastDigits, std::to_string(frames - 1).size());
  const std::string number = std::to_string(frame);
  return "frame_" + std::string(digits - number.size(), '0') + number + extension;
}

}  // namespace mimetra
