#pragma once

#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra::cli {

/// An option as it is typed, whatever it is for.
struct CommandOption {
  std::string name;                ///< "radius"
  std::vector<std::string> forms;  ///< "--radius"; "-o" and "--out"
  std::string value;               ///< "LENGTH"; empty for a flag
  std::string help;                ///< with unit, choices and default
  std::vector<std::string> choices = {};
  bool takes_file = false;
  /// What the names of its files end in, ".json"; none where folders and others are taken too.
  std::vector<std::string> endings = {};
  bool required = false;
  bool common = false;  ///< every command has it

  bool is_flag() const { return value.empty(); }
};

/// What a command takes, in the order of its help: what parser, completion and manual are made of.
struct Command {
  const Operation* operation;
  std::vector<Parameter> parameters;
  std::vector<Input> positionals;
  std::vector<CommandOption> options;
};

/// What stands for a value in help texts: the name in capitals.
std::string upper(std::string text);

/// Every operation of a table as a command.
std::vector<Command> commands_of(const OperationTable& table);

}  // namespace mimetra::cli
