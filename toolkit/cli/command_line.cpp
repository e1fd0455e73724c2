#include "toolkit/cli/command_line.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <list>

#include <CLI/CLI.hpp>

#include "toolkit/cli/command.h"
#include "toolkit/io/format.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/parameter_files.h"

namespace mimetra::cli {

namespace {

/// All spellings of a command's options.
std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names = {"--help"};
  for (const CommandOption& option : command.options) {
    names.insert(names.end(), option.forms.begin(), option.forms.end());
  }
  return names;
}

/// Name of the option in "--name=value", "-n5" or "-n"; "" if the argument is not an option.
/// "-name" counts as a long option without a hyphen if there is no "-n", or if there is "--name".
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

/// Returns the option that the user probably meant: the nearest, or one with the same beginning.
std::string meant(const std::string& name, const std::vector<std::string>& known) {
  if (name.size() == 2) {
    // A single letter is equally near to all others, so only its case may differ.
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

/// Explains the mistake in "-k 5 10" for a list "5,10"; "" if there is none.
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

/// Explains the mistake in "-k 5 -k 6"; "" if no option with a value is given twice.
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

/// Explains a lost hyphen, such as "-out" for "--out", which the parser reads as "-o ut"; "" if
/// there is none.
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

/// Explains many files of one kind in one folder, which a shell has substituted for an unquoted
/// pattern. Returns "" for fewer than three files. Unless the line was `refused`, also returns ""
/// if the files do not form one series with the first input.
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

/// Explains why the parser refused a line, and what to write instead. `refused` is the parser's
/// message.
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

/// Storage into which CLI11 parses one command, by name of input or option.
struct Slots {
  std::map<std::string, std::vector<std::string>> inputs;
  std::map<std::string, std::string> values;
  std::map<std::string, bool> flags;

  std::optional<std::string> value(const std::string& name) const {
    const auto found = values.find(name);
    if (found == values.end() || found->second.empty()) return {};
    return found->second;
  }
  bool flag(const std::string& name) const {
    const auto found = flags.find(name);
    return found != flags.end() && found->second;
  }
};

void declare(CLI::App& app, const Command& command, Slots& slots) {
  for (const Input& input : command.positionals) {
    app.add_option(input.name, slots.inputs[input.name])
        ->expected(1, input.repeated ? CLI::detail::expected_max_vector_size : 1)
        ->allow_extra_args(input.repeated)
        ->required(!input.optional);
  }
  for (const CommandOption& option : command.options) {
    const std::string forms = joined(option.forms, ",");
    if (option.is_flag()) {
      app.add_flag(forms, slots.flags[option.name]);
    } else {
      app.add_option(forms, slots.values[option.name])
          ->type_name(option.value)
          ->required(option.required);
    }
  }
}

/// Refuses empty names. Most come from a script with an unset variable.
void refuse_empty(const CLI::App& app, const Command& command, const Slots& slots) {
  for (const auto& [name, texts] : slots.inputs) {
    if (std::ranges::find(texts, "") != texts.end()) throw UsageError(name + ": is empty");
  }
  for (const CommandOption& option : command.options) {
    if (option.is_flag() || app.count(option.forms.back()) == 0) continue;
    if (slots.values.at(option.name).empty()) throw UsageError(option.forms.back() + ": is empty");
  }
}

/// Refuses a quoted ~, which the shell does not expand and which would become a folder.
void refuse_tilde(const std::string& output) {
  std::error_code unreadable;
  const std::filesystem::path path = output;
  if (*path.begin() != "~" || std::filesystem::exists("~", unreadable)) return;
  throw UsageError("output '" + output +
                   "': a shell puts your home folder in place of ~ only without quotes, and at a "
                   "word's beginning; write $HOME (`./~` is a folder of that name)");
}

Parameters parameters_of(const CLI::App& app, const Command& command, const Slots& slots) {
  Parameters parameters(command.parameters);
  if (const auto config = slots.value("config")) set_from_file(*config, parameters);
  for (const Parameter& parameter : command.parameters) {
    if (app.count(parameter.option()) == 0) continue;
    if (parameter.kind == ParameterKind::flag)
      parameters.set(parameter.name, slots.flag(parameter.name));
    else
      parameters.set(parameter.name, parse_value(parameter, slots.values.at(parameter.name)));
  }
  return parameters;
}

ProgressBar progress_bar(const std::string& text) {
  Parameters parameters({choice_parameter("progress", ProgressBar::automatic, "")});
  parameters.set("progress", text);
  return parameters.choice<ProgressBar>("progress");
}

int thread_count(const std::string& text) {
  const Parameter parameter{"threads", ParameterKind::integer, {}, "", "", 1, kMostThreads};
  return static_cast<int>(std::get<std::int64_t>(parse_value(parameter, text)));
}

Request request_of(const CLI::App& app, const Command& command, const Slots& slots) {
  refuse_empty(app, command, slots);
  Request request;
  request.operation = command.operation;
  request.parameters = parameters_of(app, command, slots);
  request.inputs = slots.inputs;
  for (const Input& input : command.operation->inputs) {
    if (const auto text = slots.value(input.name); input.is_option() && text) {
      request.inputs[input.name] = {*text};
    } else if (input.positional && request.inputs[input.name].empty()) {
      request.inputs.erase(input.name);
    }
  }
  for (const Output& output : command.operation->outputs) {
    const auto text = slots.value(output.name);
    if (!text) continue;
    refuse_tilde(*text);
    request.outputs[output.name] = *text;
  }
  if (const auto config = slots.value("config")) request.files.push_back(*config);
  if (const auto progress = slots.value("progress")) request.progress = progress_bar(*progress);
  if (const auto threads = slots.value("threads")) request.threads = thread_count(*threads);
  request.json = slots.flag("json");
  request.quiet = slots.flag("quiet");
  request.verbose = slots.flag("verbose");
  request.force = slots.flag("force");
  request.dry_run = slots.flag("dry-run");
  return request;
}

/// Help for a command if the line requests it: "transfer --help", "transfer --help all", "help
/// transfer".
std::optional<std::string> asked_help(const std::vector<Command>& commands,
                                      const std::vector<std::string>& arguments) {
  const auto asks = [](const std::string& argument) {
    return argument == "-h" || argument == "--help" || argument.starts_with("--help=");
  };
  const bool asks_first =
      !arguments.empty() && (arguments.front() == "help" || asks(arguments.front()));
  if (arguments.size() < (asks_first ? 2 : 1)) return {};
  const Command* command = find_command(commands, arguments[asks_first ? 1 : 0]);
  const auto asked = asks_first ? arguments.begin() : std::ranges::find_if(arguments, asks);
  if (!command || asked == arguments.end()) return {};
  const bool all =
      *asked == "--help=all" || std::ranges::find(asked, arguments.end(), "all") != arguments.end();
  return help_page(*command, all ? HelpLength::all : HelpLength::brief);
}

/// Reverses the arguments for CLI11. Turns -k=5, which CLI11 does not know, into -k5.
std::vector<std::string> last_first(const std::vector<std::string>& arguments) {
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  for (std::string& argument : reversed) {
    const bool is_short = argument.size() > 3 && argument[0] == '-' && argument[1] != '-';
    if (is_short && argument[2] == '=') argument.erase(2, 1);
  }
  return reversed;
}

}  // namespace

ParsedLine parse_command_line(const OperationTable& table,
                              const std::vector<std::string>& arguments) {
  CLI::App app("Transfers the deformation of one animated mesh to another, by regions.", "mimetra");
  app.require_subcommand(1);
  app.set_version_flag("--version", "mimetra " MIMETRA_VERSION "\n" + std::string(libraries()));
  app.footer(
      "`mimetra COMMAND --help` shows what a command takes, `--help all` explains every option.");
  const std::vector<Command> commands = commands_of(table);
  if (auto text = asked_help(commands, arguments)) return {{}, std::move(*text)};
  std::list<Slots> all_slots;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.operation->name, command.operation->summary);
    declare(*sub, command, all_slots.emplace_back());
  }
  if (arguments == std::vector<std::string>{"help"}) return {{}, app.help()};
  const Command* first = arguments.empty() ? nullptr : find_command(commands, arguments.front());
  if (const std::string mistake = first ? lost_hyphen(*first, arguments) : ""; !mistake.empty()) {
    throw UsageError(mistake);
  }
  try {
    app.parse(last_first(arguments));
  } catch (const CLI::CallForHelp&) {
    // Help for a command among other letters, "-qh".
    return {{}, first ? help_page(*first, HelpLength::brief) : app.help()};
  } catch (const CLI::CallForVersion&) {
    return {{}, app.version()};
  } catch (const CLI::ParseError& error) {
    throw UsageError(explained(commands, arguments, error.what()));
  }
  auto slots = all_slots.begin();
  for (const Command& command : commands) {
    const CLI::App* sub = app.get_subcommand(command.operation->name);
    if (sub->parsed()) {
      ParsedLine line;
      line.request = request_of(*sub, command, *slots);
      line.request->arguments = arguments;
      if (const std::string mistake = unquoted_pattern(arguments, false); !mistake.empty()) {
        throw UsageError(command.operation->name + ": " + mistake);
      }
      return line;
    }
    ++slots;
  }
  throw UsageError("expected a command; mimetra --help lists them");
}

}  // namespace mimetra::cli
