#pragma once

#include <string>
#include <vector>

#include "toolkit/cli/command.h"

namespace mimetra::cli {

/// Scripts that let a shell complete commands, options, their choices and files.
std::string bash_completion(const std::vector<Command>& commands);
std::string zsh_completion(const std::vector<Command>& commands);
std::string fish_completion(const std::vector<Command>& commands);

/// Adds the operation `completion`, which prints them. The table must outlive the call.
void add_completion(OperationTable& table);

}  // namespace mimetra::cli
