#include "plugins/c/utf8.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace mimetra {

namespace {

bool is_utf8(std::string_view text) {
  try {
    // Serialising is what refuses text that is not UTF-8.
    return !nlohmann::json(text).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

bool is_control(unsigned char c) {
  return c < 0x20 || c == 0x7f;
}

}  // namespace

bool is_line(std::string_view text) {
  return std::ranges::none_of(text, is_control) && is_utf8(text);
}

bool is_text(std::string_view text) {
  const auto is_odd = [](unsigned char c) { return is_control(c) && c != '\n' && c != '\t'; };
  return std::ranges::none_of(text, is_odd) && is_utf8(text);
}

std::string printable(const std::string& text) {
  if (is_text(text)) return text;
  std::string ascii = text;
  const auto is_odd = [](unsigned char c) { return (is_control(c) && c != '\n') || c > 0x7e; };
  std::ranges::replace_if(ascii, is_odd, '?');
  return ascii;
}

}  // namespace mimetra
