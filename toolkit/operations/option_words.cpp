#include "toolkit/operations/option_words.h"

#include <string_view>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

constexpr std::string_view kQuoted = "option '";
/// What somebody typed follows it, which stays as it is.
constexpr std::string_view kUnknown = "unknown option ";

bool is_of_a_name(char c) {
  return (c >= 'a' && c <= 'z') || c == '-';
}

/// What follows these may be an option's dashes.
bool parts_words(char c) {
  return std::string_view(" (,;:'").find(c) != std::string_view::npos;
}

struct Mention {
  std::size_t begin, end;
  std::string name;
};

std::size_t end_of_name(const std::string& text, std::size_t begin) {
  std::size_t at = begin;
  while (at < text.size() && (is_of_a_name(text[at]) || (at > begin && is_digit(text[at])))) ++at;
  return at;
}

/// An option that `text` names at `begin`; an empty name for none.
Mention mention_at(const std::string& text, std::size_t begin) {
  if (text.compare(begin, kQuoted.size(), kQuoted) == 0) {
    const std::size_t name = begin + kQuoted.size();
    const std::size_t end = end_of_name(text, name);
    if (end > name && end < text.size() && text[end] == '\'') {
      return {begin, end + 1, text.substr(name, end - name)};
    }
  }
  if (text[begin] != '-' || (begin > 0 && !parts_words(text[begin - 1]))) return {begin, begin, ""};
  const bool is_long = text.compare(begin, 2, "--") == 0;
  const std::size_t name = begin + (is_long ? 2 : 1);
  const std::size_t end = end_of_name(text, name);
  const bool is_named = end > name && text[name] != '-' && (is_long || end == name + 1);
  return {begin, end, is_named ? text.substr(name, end - name) : ""};
}

}  // namespace

std::string with_options_spelled(const std::string& message,
                                 const std::function<std::string(const std::string&)>& spelled) {
  std::string text;
  for (std::size_t at = 0; at < message.size();) {
    const Mention mention = mention_at(message, at);
    if (mention.name.empty() || text.ends_with(kUnknown)) {
      text += message[at++];
    } else {
      text += spelled(mention.name == "force" ? "overwrite" : mention.name);
      at = mention.end;
    }
  }
  return text;
}

std::string spelled_for_command(const std::string& option) {
  if (option == "overwrite") return "--force";
  return (option.size() == 1 ? "-" : "--") + option;
}

std::string spelled_for_library(const std::string& option) {
  return std::string(kQuoted) + (option == "o" ? "out" : option) + "'";
}

}  // namespace mimetra
