#include "toolkit/cli/terminal_text.h"

#include "toolkit/mesh/text.h"

namespace mimetra::cli {

std::string terminal_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const char first = text.front();
    const std::size_t size = first == '\n' || first == '\t' ? 1 : printable_bytes(text);
    if (size > 0) {
      result += text.substr(0, size);
    } else {
      const auto byte = static_cast<unsigned char>(text.front());
      result += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xfU]};
    }
    text.remove_prefix(size > 0 ? size : 1);
  }
  return result;
}

}  // namespace mimetra::cli
