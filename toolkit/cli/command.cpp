#include "toolkit/cli/command.h"

#include <algorithm>

#include "toolkit/mesh/text.h"

namespace mimetra::cli {

namespace {

/// Adds unit, choices and default to `text`.
std::string described(const Parameter& parameter, std::string text) {
  if (!parameter.unit.empty()) text += " [" + parameter.unit + "]";
  if (!parameter.choices.empty()) {
    text += " {" + joined(parameter.choices, ",");
    text += parameter.kind == ParameterKind::file ? ",FILE}" : "}";
  }
  const std::string fallback = to_text(parameter.fallback);
  if (!fallback.empty() && parameter.kind != ParameterKind::flag) {
    text += " (default " + fallback + ")";
  }
  return text;
}

/// Text of the short help; empty for the name alone.
std::string in_brief(const Parameter& parameter) {
  if (parameter.brief.empty()) {
    return parameter.group.empty() ? described(parameter, parameter.help) : "";
  }
  return parameter.kind == ParameterKind::file ? parameter.brief
                                               : described(parameter, parameter.brief);
}

std::string value_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::flag:
      return "";
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
    case ParameterKind::text:
      return "TEXT";
  }
  return "";
}

/// Endings of file names; empty if a path may have any ending.
std::vector<std::string> endings_of(std::vector<std::string> extensions) {
  const auto is_ending = [](const std::string& extension) { return extension.starts_with('.'); };
  return std::ranges::all_of(extensions, is_ending) ? extensions : std::vector<std::string>();
}

CommandOption option_of(const OperationTable& table, const Input& input) {
  CommandOption option{input.name, {"--" + input.name}, "FILE", table.help(input), {}, true};
  option.brief = input.help;
  option.endings = endings_of(table.extensions(input));
  option.required = !input.optional;
  return option;
}

CommandOption option_of(const OperationTable& table, const Output& output) {
  CommandOption option{output.name, {"--" + output.name}, "FILE", table.help(output), {}, true};
  option.brief = output.help;
  option.endings = endings_of(table.extensions(output));
  if (output.name == "out") {
    option.forms.insert(option.forms.begin(), "-o");
    option.value = "OUT";
  }
  option.required = !output.optional;
  return option;
}

CommandOption option_of(const Parameter& parameter) {
  CommandOption option{parameter.name,
                       {parameter.option()},
                       value_name(parameter.kind),
                       described(parameter, parameter.help),
                       parameter.choices,
                       parameter.kind == ParameterKind::file};
  option.group = parameter.group;
  option.brief = in_brief(parameter);
  return option;
}

std::vector<CommandOption> common_options(const Operation& operation) {
  std::vector<CommandOption> options = {
      {"json", {"--json"}, "", "print the result as JSON"},
      {"quiet", {"-q", "--quiet"}, "", "print errors only"},
      {"verbose", {"-v", "--verbose"}, "", "say more on the way"},
      {"progress",
       {"--progress"},
       "CHOICE",
       "progress bar {auto,always,never} (default auto)",
       {"auto", "always", "never"}},
      {"threads", {"--threads"}, "N", "threads to compute with (default all)"},
      {"config", {"--config"}, "FILE", "JSON file with values of options", {}, true}};
  if (!operation.outputs.empty()) {
    options.push_back({"force", {"--force"}, "", "replace what an earlier run wrote"});
    options.push_back({"dry-run", {"--dry-run"}, "", "tell the plan and the memory, and stop"});
  }
  for (CommandOption& option : options) option.group = CommandOption::kCommon;
  return options;
}

}  // namespace

std::vector<std::string> headings_of(const Command& command) {
  std::vector<std::string> found = {""};
  for (const CommandOption& option : command.options) {
    if (std::ranges::find(found, option.group) == found.end()) found.push_back(option.group);
  }
  return found;
}

std::string synopsis(const Command& command) {
  std::string text = "mimetra " + command.operation->name + " [OPTIONS]";
  for (const CommandOption& option : command.options) {
    if (option.required) text += " " + option.forms.front() + " " + option.value;
  }
  for (const Input& input : command.positionals) {
    const std::string name = upper_case(input.name) + (input.repeated ? "..." : "");
    text += input.optional ? " [" + name + "]" : " " + name;
  }
  return text;
}

std::string forms_of(const CommandOption& option) {
  const std::string forms = joined(option.forms, ", ");
  return option.is_flag() ? forms : forms + " " + option.value;
}

std::vector<Command> commands_of(const OperationTable& table) {
  std::vector<Command> commands;
  for (const Operation& operation : table.operations()) {
    Command command{&operation, table.parameters_of(operation), {}, {}};
    for (const Output& output : operation.outputs) {
      command.options.push_back(option_of(table, output));
    }
    for (Input input : operation.inputs) {
      if (input.is_option()) {
        command.options.push_back(option_of(table, input));
        continue;
      }
      input.help = table.help(input);
      command.positionals.push_back(std::move(input));
    }
    for (const Parameter& parameter : command.parameters) {
      command.options.push_back(option_of(parameter));
    }
    for (CommandOption& option : common_options(operation)) {
      command.options.push_back(std::move(option));
    }
    commands.push_back(std::move(command));
  }
  return commands;
}

const Command* find_command(const std::vector<Command>& commands, const std::string& name) {
  const auto found = std::ranges::find_if(
      commands, [&name](const Command& each) { return each.operation->name == name; });
  return found == commands.end() ? nullptr : &*found;
}

namespace {

constexpr std::size_t kWidth = 80;
/// Column where explanations begin.
constexpr std::size_t kColumn = 25;

/// Wraps `text` into lines. The first line begins at `column`, the others are indented by `indent`.
std::string wrapped(const std::string& text, std::size_t column, std::size_t indent) {
  std::string result;
  bool begins_line = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find(' ', i), text.size());
    if (!begins_line && column + 1 + (end - i) > kWidth) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
      begins_line = true;
    }
    if (!begins_line) {
      result += ' ';
      ++column;
    }
    result.append(text, i, end - i);
    column += end - i;
    begins_line = false;
    i = end + 1;
  }
  return result;
}

/// A name and its explanation, side by side if there is room.
std::string entry(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  const bool has_room = line.size() + 2 <= kColumn;
  line += has_room ? std::string(kColumn - line.size(), ' ') : '\n' + std::string(kColumn, ' ');
  return line + wrapped(text, kColumn, kColumn) + '\n';
}

/// The options under a heading. Options without a text in the short help follow by name, on the
/// heading's line if all options lack one.
std::string section(const Command& command, const std::string& heading, HelpLength length) {
  std::string entries;
  std::vector<std::string> names;
  for (const CommandOption& option : command.options) {
    if (option.group != heading) continue;
    const std::string& text = length == HelpLength::all ? option.help : option.brief;
    if (text.empty()) {
      names.push_back(option.forms.back());
    } else {
      entries += entry(forms_of(option), text);
    }
  }
  const std::string title = (heading.empty() ? "Options" : heading) + ':';
  const std::string list = joined(names, " ");
  if (entries.empty()) {
    return names.empty() ? "" : wrapped(title + ' ' + list, 0, 2) + '\n';
  }
  return title + '\n' + entries + (names.empty() ? "" : "  " + wrapped(list, 2, 2) + '\n');
}

}  // namespace

std::string help_page(const Command& command, HelpLength length) {
  const Operation& operation = *command.operation;
  std::string text =
      wrapped(operation.summary + '.', 0, 0) + "\n\n  " + wrapped(synopsis(command), 2, 6) + "\n\n";
  for (const Input& input : command.positionals) {
    const auto own = std::ranges::find(operation.inputs, input.name, &Input::name);
    text += entry(upper_case(input.name) + (input.repeated ? "..." : ""),
                  length == HelpLength::all ? input.help : own->help);
  }
  for (const std::string& heading : headings_of(command)) text += section(command, heading, length);
  if (length == HelpLength::all && !operation.measures.empty()) {
    text += "\nPrints:\n";
    for (const Measure& measure : operation.measures) text += entry(measure.name, measure.meaning);
  }
  text += "\nExamples:\n";
  for (const std::string& example : operation.examples) text += "  mimetra " + example + '\n';
  if (length == HelpLength::brief) {
    text += "`mimetra " + operation.name + " --help all` explains every option.\n";
  }
  return text;
}

}  // namespace mimetra::cli
