#include "toolkit/cli/help.h"

#include <algorithm>

#include "toolkit/mesh/text.h"

namespace mimetra::cli {

namespace {

constexpr std::size_t kWidth = 80;
/// Where explanations begin.
constexpr std::size_t kColumn = 25;

/// `text` in lines, of which the first begins at `column` already and the others at `indent`.
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

/// A name and what it means, beside it where there is room.
std::string entry(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  const bool has_room = line.size() + 2 <= kColumn;
  line += has_room ? std::string(kColumn - line.size(), ' ') : '\n' + std::string(kColumn, ' ');
  return line + wrapped(text, kColumn, kColumn) + '\n';
}

/// The options under a heading; those of which brief help tells the names only stand at the end,
/// or beside a heading without others.
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
    text += entry(upper(input.name) + (input.repeated ? "..." : ""),
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
