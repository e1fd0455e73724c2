#include <mimetra/cli/command_line.h>

#include <algorithm>
#include <list>

#include <CLI/CLI.hpp>

#include <mimetra/cli/suggestion.h>
#include <mimetra/operations/option_file.h>

namespace mimetra::cli {

namespace {

/// What CLI11 writes into while it parses one command.
struct Slots {
  std::map<std::string, std::string> inputs;
  std::map<std::string, std::vector<std::string>> repeated_inputs;
  std::map<std::string, std::string> outputs;
  std::map<std::string, std::string> values;
  std::map<std::string, bool> flags;
  std::string config;
  std::string progress = "auto";
  bool json = false, quiet = false, verbose = false, force = false;
};

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

/// Help, unit, default and choices in one line.
std::string described(const Parameter& parameter) {
  std::string text = parameter.help;
  if (!parameter.unit.empty()) text += " [" + parameter.unit + "]";
  if (!parameter.choices.empty()) {
    text += " {";
    for (const std::string& choice : parameter.choices) {
      text += (choice == parameter.choices.front() ? "" : ",") + choice;
    }
    text += parameter.kind == ParameterKind::file ? ",FILE}" : "}";
  }
  const std::string fallback = to_text(parameter.fallback);
  if (!fallback.empty() && parameter.kind != ParameterKind::flag)
    text += " (default " + fallback + ")";
  return text;
}

std::string value_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::integer:
      return "N";
    case ParameterKind::integer_list:
      return "N,N,...";
    case ParameterKind::number:
      return "X";
    case ParameterKind::length:
      return "LENGTH";
    case ParameterKind::file:
      return "FILE";
    case ParameterKind::choice:
      return "CHOICE";
    default:
      return "TEXT";
  }
}

void add_inputs(CLI::App& command, const Operation& operation, Slots& slots) {
  for (const Input& input : operation.inputs) {
    const std::string name = (input.optional ? "--" : "") + input.name;
    CLI::Option* option =
        input.repeated ? command.add_option(name, slots.repeated_inputs[input.name], input.help)
                       : command.add_option(name, slots.inputs[input.name], input.help);
    option->type_name(input.optional ? "FILE" : upper(input.name))->required(!input.optional);
  }
}

void add_outputs(CLI::App& command, const Operation& operation, Slots& slots) {
  for (const Output& output : operation.outputs) {
    const std::string name = output.name == "out" ? "-o,--out" : "--" + output.name;
    command.add_option(name, slots.outputs[output.name], output.help)
        ->type_name(upper(output.name))
        ->required(!output.optional);
  }
}

void add_parameters(CLI::App& command, const std::vector<Parameter>& parameters, Slots& slots) {
  for (const Parameter& parameter : parameters) {
    if (parameter.kind == ParameterKind::flag) {
      command.add_flag(parameter.option(), slots.flags[parameter.name], described(parameter));
    } else {
      command.add_option(parameter.option(), slots.values[parameter.name], described(parameter))
          ->type_name(value_name(parameter.kind));
    }
  }
}

void add_common(CLI::App& command, const Operation& operation, Slots& slots) {
  constexpr const char* kGroup = "Common options";
  command.add_flag("--json", slots.json, "print the result as JSON")->group(kGroup);
  command.add_flag("-q,--quiet", slots.quiet, "print errors only")->group(kGroup);
  command.add_flag("-v,--verbose", slots.verbose, "say more on the way")->group(kGroup);
  command
      .add_option("--progress", slots.progress, "progress bar {auto,always,never} (default auto)")
      ->type_name("CHOICE")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->group(kGroup);
  command.add_option("--config", slots.config, "JSON file with values of options")
      ->type_name("FILE")
      ->group(kGroup);
  if (!operation.outputs.empty()) {
    command.add_flag("--force", slots.force, "replace what exists")->group(kGroup);
  }
}

Request request_of(const Operation& operation, const std::vector<Parameter>& declared,
                   const CLI::App& command, const Slots& slots) {
  Request request;
  request.operation = &operation;
  request.parameters = Parameters(declared);
  if (!slots.config.empty()) set_from_file(slots.config, request.parameters);
  for (const Parameter& parameter : declared) {
    if (command.count(parameter.option()) == 0) continue;
    if (parameter.kind == ParameterKind::flag)
      request.parameters.set(parameter.name, slots.flags.at(parameter.name));
    else
      request.parameters.set(parameter.name,
                             parse_value(parameter, slots.values.at(parameter.name)));
  }
  const auto given = [&command](const std::string& option, const std::string& text) {
    if (command.count(option) > 0 && text.empty()) throw UsageError(option + ": is empty");
    return !text.empty();
  };
  for (const Input& input : operation.inputs) {
    if (input.repeated) continue;
    const std::string& text = slots.inputs.at(input.name);
    if (given((input.optional ? "--" : "") + input.name, text)) request.inputs[input.name] = {text};
  }
  for (const auto& [name, texts] : slots.repeated_inputs) request.inputs[name] = texts;
  for (const Output& output : operation.outputs) {
    const std::string& text = slots.outputs.at(output.name);
    if (given("--" + output.name, text)) request.outputs[output.name] = text;
  }
  request.files = request.parameters.files();
  if (!slots.config.empty()) request.files.push_back(slots.config);
  request.json = slots.json;
  request.quiet = slots.quiet;
  request.verbose = slots.verbose;
  request.force = slots.force;
  request.progress = slots.progress == "always"  ? ProgressBar::always
                     : slots.progress == "never" ? ProgressBar::never
                                                 : ProgressBar::automatic;
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
    return first + ": no option '" + name + "'" +
           (nearest.empty() ? "; mimetra " + first + " --help lists them"
                            : "; did you mean '" + nearest + "'?");
  }
  return first + ": " + error.what();
}

}  // namespace

ParsedLine parse_command_line(const OperationTable& table,
                              const std::vector<std::string>& arguments) {
  CLI::App app("Transfers the deformation of one animated mesh to another, by regions.", "mimetra");
  app.require_subcommand(1);
  app.set_version_flag("--version", "mimetra " MIMETRA_VERSION);
  app.footer("`mimetra COMMAND --help` tells a command's options and two examples.");
  std::list<Slots> all_slots;
  for (const Operation& operation : table.operations()) {
    CLI::App* command = app.add_subcommand(operation.name, operation.summary);
    Slots& slots = all_slots.emplace_back();
    add_inputs(*command, operation, slots);
    add_outputs(*command, operation, slots);
    add_parameters(*command, table.parameters_of(operation), slots);
    add_common(*command, operation, slots);
    std::string examples = "Examples:";
    for (const std::string& example : operation.examples) examples += "\n  mimetra " + example;
    command->footer(examples);
  }
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    return {{}, app.help()};
  } catch (const CLI::CallForVersion&) {
    return {{}, app.version() + '\n'};
  } catch (const CLI::ParseError& error) {
    throw UsageError(explained(app, arguments, error));
  }
  auto slots = all_slots.begin();
  for (const Operation& operation : table.operations()) {
    const CLI::App* command = app.get_subcommand(operation.name);
    if (command->parsed()) {
      ParsedLine line;
      line.request = request_of(operation, table.parameters_of(operation), *command, *slots);
      line.request->arguments = arguments;
      return line;
    }
    ++slots;
  }
  throw UsageError("expected a command; mimetra --help lists them");
}

}  // namespace mimetra::cli
