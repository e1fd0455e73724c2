#pragma once

#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra::cli {

/// An option as it is typed, whatever it is for.
struct CommandOption {
  /// The heading of those that every command has.
  static constexpr const char* kCommon = "Common";

  std::string name;                ///< "radius"
  std::vector<std::string> forms;  ///< "--radius"; "-o" and "--out"
  std::string value;               ///< "LENGTH"; empty for a flag
  std::string help;                ///< with unit, choices and default
  std::vector<std::string> choices = {};
  bool takes_file = false;
  /// What the names of its files end in, ".json"; none where folders and others are taken too.
  std::vector<std::string> endings = {};
  bool required = false;
  /// Heading under which help lists it; none for what the command is about.
  std::string group = "";
  /// What the short help says: that without kinds of files; empty where it tells the name only.
  std::string brief = "";

  bool is_common() const { return group == kCommon; }

  bool is_flag() const { return value.empty(); }
};

/// What a command takes, in the order of its help: what parser, completion and manual are made of.
struct Command {
  const Operation* operation;
  std::vector<Parameter> parameters;
  std::vector<Input> positionals;
  std::vector<CommandOption> options;
};

/// Headings of its options in their order, "" for what the command is about at first.
std::vector<std::string> headings_of(const Command& command);
/// An option as it is typed: "-o, --out OUT".
std::string forms_of(const CommandOption& option);
/// "mimetra transfer [OPTIONS] -o OUT SOURCE TARGET..."
std::string synopsis(const Command& command);

/// Every operation of a table as a command.
std::vector<Command> commands_of(const OperationTable& table);
/// The one of a name; null where there is none.
const Command* find_command(const std::vector<Command>& commands, const std::string& name);

enum class HelpLength {
  brief,  ///< one screen: options under headings by name, but for the usual ones
  all     ///< every option explained
};

/// What --help says of a command, in lines of 80 characters but for its examples.
std::string help_page(const Command& command, HelpLength length);

}  // namespace mimetra::cli
