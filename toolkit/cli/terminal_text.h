#pragma once

#include <string>
#include <string_view>

namespace mimetra::cli {

/// `text` as a terminal may be given it: names of files and of what files hold can be anything. All
/// but lines, tabs and printable UTF-8 is written as \xHH, so that nothing acts on the terminal.
std::string terminal_text(std::string_view text);

}  // namespace mimetra::cli
