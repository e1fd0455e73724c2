#pragma once

#include <string>
#include <vector>

#include "toolkit/cli/command.h"

namespace mimetra::cli {

/// What is wrong with a line that the parser has `refused` with these words, and what to write
/// instead.
std::string explained(const std::vector<Command>& commands,
                      const std::vector<std::string>& arguments, const std::string& refused);

/// What is wrong with an option whose second hyphen is missing, "-out" for "--out", which the
/// parser takes for "-o ut"; "" where there is none.
std::string lost_hyphen(const Command& command, const std::vector<std::string>& arguments);

/// What is wrong with many files of one kind in one folder, which a shell has put in place of a
/// pattern without quotes; "" where there are fewer than three, or, unless the line was `refused`,
/// they are not of one series with the first input.
std::string unquoted_pattern(const std::vector<std::string>& arguments, bool refused);

}  // namespace mimetra::cli
