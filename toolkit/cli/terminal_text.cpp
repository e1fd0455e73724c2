#include "toolkit/cli/terminal_text.h"

#include <cstdint>

namespace mimetra::cli {

namespace {

/// Bytes of the printable character that `text` begins with; 0 where it begins with none.
std::size_t printable_bytes(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return (first >= 0x20 && first != 0x7f) || first == '\n' || first == '\t';
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_character =
      code >= kLeast[size] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  // A second set of controls, and what turns the direction of writing.
  const bool is_control =
      code < 0xa0 || (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_character && !is_control ? size : 0;
}

}  // namespace

std::string terminal_text(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    const std::size_t size = printable_bytes(text);
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
