#include "toolkit/cli/command_line.h"

#include <algorithm>
#include <list>

#include <CLI/CLI.hpp>

#include "toolkit/cli/command.h"
#include "toolkit/cli/libraries.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/suggestion.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_file.h"

namespace mimetra::cli {

namespace {

/// What CLI11 writes into while it parses one command, by name of input or option.
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
    app.add_option(input.name, slots.inputs[input.name], input.help)
        ->type_name(upper(input.name))
        ->expected(1, input.repeated ? CLI::detail::expected_max_vector_size : 1)
        ->allow_extra_args(input.repeated)
        ->required(!input.optional);
  }
  for (const CommandOption& option : command.options) {
    const std::string forms = joined(option.forms, ",");
    CLI::Option* declared = option.is_flag()
                                ? app.add_flag(forms, slots.flags[option.name], option.help)
                                : app.add_option(forms, slots.values[option.name], option.help)
                                      ->type_name(option.value)
                                      ->required(option.required);
    if (option.common) declared->group("Common options");
  }
  std::string examples = "Examples:";
  for (const std::string& example : command.operation->examples) {
    examples += "\n  mimetra " + example;
  }
  app.footer(examples);
}

/// An empty name is a mistake, mostly of a script whose variable is not set.
void refuse_empty(const CLI::App& app, const Command& command, const Slots& slots) {
  for (const auto& [name, texts] : slots.inputs) {
    if (std::ranges::find(texts, "") != texts.end()) throw UsageError(name + ": is empty");
  }
  for (const CommandOption& option : command.options) {
    if (option.is_flag() || app.count(option.forms.back()) == 0) continue;
    if (slots.values.at(option.name).empty()) throw UsageError(option.forms.back() + ": is empty");
  }
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
    if (const auto text = slots.value(output.name)) request.outputs[output.name] = *text;
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

/// Every option of a command as it is typed.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// What is wrong with many files of one kind in one folder, which a shell has put in place of a
/// pattern without quotes; "" where there are fewer than three, or, unless the line was `refused`,
/// they are not of one series with the first input.
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
         "quotes; "
         "write '" +
         pattern.string() + "' in quotes, or name the folder";
}

/// The message for what CLI11 refuses, with a suggestion for an unknown word.
std::string explained(const CLI::App& app, const std::vector<std::string>& arguments,
                      const CLI::ParseError& error) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (arguments.empty()) return "expected a command; mimetra --help lists them";
  const std::string& first = arguments.front();
  if (std::ranges::find(commands, first) == commands.end()) {
    const std::string nearest = nearest_word(first, commands);
    return "no command '" + first + "'" +
           (nearest.empty() ? "; mimetra --help lists them" : "; did you mean '" + nearest + "'?");
  }
  const std::vector<std::string> known = option_names(*app.get_subcommand(first));
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (!name.starts_with("--") || std::ranges::find(known, name) != known.end()) continue;
    const std::string nearest = nearest_word(name, known);
    return first + ": unknown option " + name +
           (nearest.empty() ? "; mimetra " + first + " --help lists them"
                            : "; did you mean '" + nearest + "'?");
  }
  if (const std::string mistake = unquoted_pattern(arguments, true); !mistake.empty()) {
    return first + ": " + mistake;
  }
  return first + ": " + error.what();
}

}  // namespace

ParsedLine parse_command_line(const OperationTable& table,
                              const std::vector<std::string>& arguments) {
  CLI::App app("Transfers the deformation of one animated mesh to another, by regions.", "mimetra");
  app.require_subcommand(1);
  app.set_version_flag("--version", "mimetra " MIMETRA_VERSION "\n" + std::string(libraries()));
  app.footer("`mimetra COMMAND --help` lists a command's options, with two examples.");
  const std::vector<Command> commands = commands_of(table);
  std::list<Slots> all_slots;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.operation->name, command.operation->summary);
    declare(*sub, command, all_slots.emplace_back());
  }
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    return {{}, app.help()};
  } catch (const CLI::CallForVersion&) {
    return {{}, app.version()};
  } catch (const CLI::ParseError& error) {
    throw UsageError(explained(app, arguments, error));
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
