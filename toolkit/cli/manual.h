#pragma once

#include <string>
#include <vector>

#include "toolkit/cli/command.h"

namespace mimetra::cli {

/// The manual page mimetra(1), in roff.
std::string man_page(const std::vector<Command>& commands);

/// The reference of all commands, in Markdown.
std::string reference_page(const std::vector<Command>& commands);

/// Adds the operation `manual`, which prints them. The table must outlive the call.
void add_manual(OperationTable& table);

}  // namespace mimetra::cli
