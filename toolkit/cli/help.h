#pragma once

#include <string>

#include "toolkit/cli/command.h"

namespace mimetra::cli {

enum class HelpLength {
  brief,  ///< one screen: options under headings by name, but for the usual ones
  all     ///< every option explained
};

/// What --help says of a command, in lines of 80 characters but for its examples.
std::string help_page(const Command& command, HelpLength length);

}  // namespace mimetra::cli
