#pragma once

#include <string>
#include <string_view>

namespace mimetra {

/// True for UTF-8 in one line: what stands in messages, names and JSON.
bool is_line(std::string_view text);

/// True for lines of UTF-8, in which tabs may stand too.
bool is_text(std::string_view text);

/// `text` where it is lines of UTF-8; otherwise with '?' for each byte that is not printable ASCII.
std::string printable(const std::string& text);

}  // namespace mimetra
