#include "toolkit/cli/command_line.h"

#include <algorithm>
#include <filesystem>
#include <list>

#include <CLI/CLI.hpp>

#include "toolkit/cli/command.h"
#include "toolkit/cli/help.h"
#include "toolkit/cli/libraries.h"
#include "toolkit/cli/mistakes.h"
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

/// Quoted, ~ comes here as it is, and would become a folder of that name.
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

/// Help where the line asks for that of a command: "transfer --help", "transfer --help all",
/// "help transfer".
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

/// As CLI11 takes them, which knows -k 5 and -k5, but not -k=5.
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
    // Of a command among other letters, "-qh".
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
