#pragma once

#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra::cli {

/// An option of a command line, for an input, an output, a parameter or the program itself.
struct CommandOption {
  /// Heading of the options of every command.
  static constexpr const char* kCommon = "Common";

  std::string name;                ///< "radius"
  std::vector<std::string> forms;  ///< "--radius"; "-o" and "--out"
  std::string value;               ///< "LENGTH"; empty for a flag
  std::string help;                ///< with unit, choices and default
  std::vector<std::string> choices = {};
  bool takes_file = false;
  /// Endings of its files' names, such as ".json"; empty if folders or other files are allowed.
  std::vector<std::string> endings = {};
  bool required = false;
  /// Heading in the help; empty for the command's own subject.
  std::string group = "";
  /// Text of the short help, without kinds of files. If it is empty, the short help shows only the
  /// name.
  std::string brief = "";

  bool is_common() const { return group == kCommon; }

  bool is_flag() const { return value.empty(); }
};

/// The arguments of a command, in the order of its help. Parser, completion and manual use them.
struct Command {
  const Operation* operation;
  std::vector<Parameter> parameters;
  std::vector<Input> positionals;
  std::vector<CommandOption> options;
};

/// Headings of the options in their order. The first is "", for the command's own subject.
std::vector<std::string> headings_of(const Command& command);
/// Spelling of an option: "-o, --out OUT".
std::string forms_of(const CommandOption& option);
/// Usage of a command: "mimetra transfer [OPTIONS] -o OUT SOURCE TARGET..."
std::string synopsis(const Command& command);

/// Returns every operation of a table as a command.
std::vector<Command> commands_of(const OperationTable& table);
/// Returns the command of a name; null if there is none.
const Command* find_command(const std::vector<Command>& commands, const std::string& name);

enum class HelpLength {
  brief,  ///< one screen: usual options explained, others by name under headings
  all     ///< every option explained
};

/// Text of --help for a command, in lines of 80 characters except its examples.
std::string help_page(const Command& command, HelpLength length);

}  // namespace mimetra::cli
