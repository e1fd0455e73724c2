#include "toolkit/cli/mistakes.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "toolkit/io/frame_series.h"
#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/suggestion.h"
#include "toolkit/mesh/text.h"

namespace mimetra::cli {

namespace {

/// Every option of a command as it is typed.
std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names = {"--help"};
  for (const CommandOption& option : command.options) {
    names.insert(names.end(), option.forms.begin(), option.forms.end());
  }
  return names;
}

/// The name in "--name=value", "-n5" or "-n"; "" of what is no option. "-name" is one with a hyphen
/// too few where there is no "-n", and where there is "--name".
std::string option_of(const std::string& argument, const std::vector<std::string>& known) {
  if (argument.size() < 2 || argument[0] != '-') return "";
  if (argument[1] == '-') return argument.substr(0, argument.find('='));
  if (!std::isalpha(static_cast<unsigned char>(argument[1]))) return "";  // a number
  const std::string letter = argument.substr(0, 2), word = argument.substr(0, argument.find('='));
  const auto is_known = [&known](const std::string& name) {
    return std::ranges::find(known, name) != known.end();
  };
  const bool is_letter = argument.size() == 2 || (is_known(letter) && !is_known('-' + word));
  return is_letter ? letter : word;
}

/// The option that is meant: the nearest, or one that begins as `name` does.
std::string meant(const std::string& name, const std::vector<std::string>& known) {
  if (name.size() == 2) {
    // Any letter is as near as another, but for the same one.
    const std::string small{'-',
                            static_cast<char>(std::tolower(static_cast<unsigned char>(name[1])))};
    return std::ranges::find(known, small) == known.end() ? "" : small;
  }
  const std::string full = name[1] == '-' ? name : '-' + name;
  const std::string nearest = nearest_word(full, known);
  if (!nearest.empty()) return nearest;
  constexpr std::size_t kLetters = 5;
  const auto begins_alike = [&full](const std::string& option) {
    return std::min(full.size(), option.size()) >= kLetters &&
           (full.starts_with(option) || option.starts_with(full));
  };
  const auto found = std::ranges::find_if(known, begins_alike);
  return found == known.end() ? "" : *found;
}

/// What is wrong with "-k 5 10", where a list is "5,10"; "" where there is none.
std::string split_list(const Command& command, const std::vector<std::string>& arguments) {
  for (const CommandOption& option : command.options) {
    if (!option.value.ends_with(",...")) continue;
    const auto typed = std::ranges::find_first_of(arguments, option.forms);
    if (typed == arguments.end()) continue;
    const auto is_word = [](const std::string& argument) {
      return argument.empty() || argument.find_first_not_of("0123456789,") != std::string::npos;
    };
    const std::vector<std::string> numbers(typed + 1,
                                           std::find_if(typed + 1, arguments.end(), is_word));
    if (numbers.size() < 2) continue;
    return *typed + " takes one word: write " + *typed + ' ' + joined(numbers, ",");
  }
  return "";
}

/// What is wrong with "-k 5 -k 6"; "" where no option with a value is given twice.
std::string repeated_option(const Command& command, const std::vector<std::string>& arguments) {
  const std::vector<std::string> known = option_names(command);
  for (const CommandOption& option : command.options) {
    if (option.is_flag()) continue;
    const auto end = std::ranges::find(arguments, "--");
    const auto given = std::count_if(arguments.begin(), end, [&](const std::string& argument) {
      return std::ranges::find(option.forms, option_of(argument, known)) != option.forms.end();
    });
    if (given < 2) continue;
    return joined(option.forms, ", ") + " is given " + std::to_string(given) +
           " times, and takes one value" +
           (option.value.ends_with(",...") ? "; write several as in 5,10" : "");
  }
  return "";
}

}  // namespace

std::string lost_hyphen(const Command& command, const std::vector<std::string>& arguments) {
  const std::vector<std::string> known = option_names(command);
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    const std::string name = option_of(argument, known);
    if (name.size() > 2 && name[1] != '-' && std::ranges::find(known, '-' + name) != known.end()) {
      return command.operation->name + ": unknown option " + name + "; did you mean '-" + name +
             "'?";
    }
  }
  return "";
}

std::string explained(const std::vector<Command>& commands,
                      const std::vector<std::string>& arguments, const std::string& refused) {
  if (arguments.empty()) return "expected a command; mimetra --help lists them";
  const std::string& first = arguments.front();
  const Command* command = find_command(commands, first);
  if (!command) {
    const bool asks = first == "help" && arguments.size() > 1;
    const std::string& word = asks ? arguments[1] : first;
    std::vector<std::string> words = {"--version", "--help"};
    for (const Command& each : commands) words.push_back(each.operation->name);
    const std::string nearest = nearest_word(word, words);
    if (nearest.empty() && word.starts_with('-')) {
      return "expected a command before " + word + "; mimetra --help lists them";
    }
    return "no command '" + word + "'" +
           (nearest.empty() ? "; mimetra --help lists them" : "; did you mean '" + nearest + "'?");
  }
  const std::vector<std::string> known = option_names(*command);
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    const std::string name = option_of(argument, known);
    if (name.empty() || std::ranges::find(known, name) != known.end()) continue;
    const std::string option = meant(name, known);
    return first + ": unknown option " + name +
           (option.empty() ? "; mimetra " + first + " --help lists them"
                           : "; did you mean '" + option + "'?");
  }
  for (const std::string& mistake :
       {split_list(*command, arguments), repeated_option(*command, arguments),
        unquoted_pattern(arguments, true)}) {
    if (!mistake.empty()) return first + ": " + mistake;
  }
  return first + ": " + refused + "; write: " + synopsis(*command);
}

std::string unquoted_pattern(const std::vector<std::string>& arguments, bool refused) {
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::filesystem::path path = arguments[i];
    const bool is_mesh = is_mesh_extension(path.extension().string());
    if (!is_mesh || !std::filesystem::is_regular_file(path, missing)) {
      if (files.empty() && !refused) return {};  // the first input is something else
      continue;
    }
    const bool fits = files.empty() || (path.parent_path() == files.front().parent_path() &&
                                        path.extension() == files.front().extension());
    const bool is_one_series = !series_name(path).empty() &&
                               (files.empty() || series_name(path) == series_name(files.front()));
    if (fits && (refused || is_one_series)) files.push_back(path);
  }
  if (files.size() < 3) return {};
  const auto pattern = files.front().parent_path() / ("*" + files.front().extension().string());
  return "got " + std::to_string(files.size()) + " files, " + files.front().string() + " to " +
         files.back().string() +
         ", where one sequence is expected: a shell puts them in place of a pattern without "
         "quotes; write '" +
         pattern.string() + "' in quotes, or name the folder";
}

}  // namespace mimetra::cli
