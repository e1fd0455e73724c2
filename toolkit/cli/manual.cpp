#include "toolkit/cli/manual.h"

#include <nlohmann/json.hpp>

#include "toolkit/cli/command.h"
#include "toolkit/cli/exit_code.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/text.h"

namespace mimetra::cli {

namespace {

/// Escapes text for roff: hyphens become minus signs, a leading dot is not a request.
std::string roff(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '-' || c == '\\') result += '\\';
    result += c == '\\' ? 'e' : c;
  }
  return result;
}

/// Escapes text for a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') result += '\\';
    result += c;
  }
  return result;
}

std::string command_section(const Command& command) {
  std::string text =
      ".SS " + roff(synopsis(command)) + "\n" + roff(command.operation->summary) + ".\n";
  for (const Input& input : command.positionals) {
    text += ".TP\n.I " + roff(upper_case(input.name)) + "\n" + roff(input.help) + "\n";
  }
  for (const std::string& heading : headings_of(command)) {
    if (heading == CommandOption::kCommon) continue;
    if (!heading.empty()) text += ".PP\n" + roff(heading) + ":\n";
    for (const CommandOption& option : command.options) {
      if (option.group != heading) continue;
      text += ".TP\n.B " + roff(forms_of(option)) + "\n" + roff(option.help) + "\n";
    }
  }
  if (!command.operation->measures.empty()) text += ".PP\nPrints:\n";
  for (const Measure& measure : command.operation->measures) {
    text += ".TP\n.I " + roff(measure.name) + "\n" + roff(measure.meaning) + "\n";
  }
  for (const std::string& example : command.operation->examples) {
    text += ".PP\n.nf\n  mimetra " + roff(example) + "\n.fi\n";
  }
  return text;
}

/// Options of every command, from the command with the most of them.
std::vector<CommandOption> common_options(const std::vector<Command>& commands) {
  std::vector<CommandOption> common;
  for (const Command& command : commands) {
    std::vector<CommandOption> own;
    for (const CommandOption& option : command.options) {
      if (option.is_common()) own.push_back(option);
    }
    if (own.size() > common.size()) common = std::move(own);
  }
  return common;
}

/// The manual page mimetra(1), in roff.
std::string man_page(const std::vector<Command>& commands) {
  std::string text =
      ".TH MIMETRA 1 \"\" \"mimetra " MIMETRA_VERSION
      "\" \"User Commands\"\n"
      ".SH NAME\nmimetra \\- region\\-based deformation transfer for mesh sequences\n"
      ".SH SYNOPSIS\n.B mimetra\n.I COMMAND\n[\\fIOPTIONS\\fR] [\\fIINPUTS\\fR]\n"
      ".SH COMMANDS\n";
  for (const Command& command : commands) text += command_section(command);
  text += ".SH COMMON OPTIONS\n";
  for (const CommandOption& option : common_options(commands)) {
    text += ".TP\n.B " + roff(forms_of(option)) + "\n" + roff(option.help) + "\n";
  }
  text += ".SH EXIT STATUS\n";
  for (const ExitMeaning& exit : kExitMeanings) {
    text += ".TP\n.B " + std::to_string(exit.code) + "\n" + roff(exit.meaning) + "\n";
  }
  return text;
}

/// The reference of all commands, in Markdown.
std::string reference_page(const std::vector<Command>& commands) {
  std::string text =
      "# Commands\n\nMade by `mimetra manual --format markdown` from the table of operations.\n";
  const auto table_of = [](const std::vector<CommandOption>& options, const std::string& heading) {
    std::string rows;
    for (const CommandOption& option : options) {
      if (option.group != heading) continue;
      rows += "| `" + forms_of(option) + "` | " + cell(option.help) + " |\n";
    }
    if (rows.empty()) return rows;
    const bool has_own = !heading.empty() && heading != CommandOption::kCommon;
    return "\n| " + (has_own ? heading : "option") + " | |\n| --- | --- |\n" + rows;
  };
  for (const Command& command : commands) {
    text += "\n## " + command.operation->name + "\n\n" + command.operation->summary + ".\n\n```\n" +
            synopsis(command) + "\n```\n";
    for (const Input& input : command.positionals) {
      text += "\n`" + upper_case(input.name) + "`: " + input.help + "\n";
    }
    for (const std::string& heading : headings_of(command)) {
      if (heading != CommandOption::kCommon) text += table_of(command.options, heading);
    }
    if (!command.operation->measures.empty()) {
      text += "\n| [prints](glossary.md) | |\n| --- | --- |\n";
      for (const Measure& measure : command.operation->measures) {
        text += "| " + cell(measure.name) + " | " + cell(measure.meaning) + " |\n";
      }
    }
    text += "\n```\n";
    for (const std::string& example : command.operation->examples) {
      text += "mimetra " + example + "\n";
    }
    text += "```\n";
  }
  text += "\n## Common options\n" + table_of(common_options(commands), CommandOption::kCommon);
  text += "\n## Formats\n\n[formats.md](formats.md) lists all that is read and written.\n";
  text += "\n## Exit codes\n\n| code | |\n| --- | --- |\n";
  for (const ExitMeaning& exit : kExitMeanings) {
    text += "| " + std::to_string(exit.code) + " | " + exit.meaning + " |\n";
  }
  return text;
}

enum class ManualFormat { man, markdown };

constexpr std::string_view choice_name(ManualFormat value) {
  switch (value) {
    case ManualFormat::man:
      return "man";
    case ManualFormat::markdown:
      return "markdown";
  }
  return {};
}

std::string page_in(ManualFormat format, const std::vector<Command>& commands) {
  switch (format) {
    case ManualFormat::man:
      return man_page(commands);
    case ManualFormat::markdown:
      return reference_page(commands);
  }
  return {};
}

Operation manual_operation(const OperationTable& table) {
  Operation operation;
  operation.name = "manual";
  operation.summary = "Print the manual of all commands";
  operation.parameters = {choice_parameter(
      "format", ManualFormat::man, "man: for the program man; markdown: the reference page")};
  operation.examples = {"manual > /usr/local/share/man/man1/mimetra.1",
                        "manual --format markdown > reference.md"};
  operation.run = [&table](const Invocation& invocation) {
    const std::string page =
        page_in(invocation.parameters.choice<ManualFormat>("format"), commands_of(table));
    return Outcome{{}, json_text(Json{{"page", page}}), page};
  };
  return operation;
}

}  // namespace

void add_manual(OperationTable& table) {
  table.add(manual_operation(table));
}

}  // namespace mimetra::cli
