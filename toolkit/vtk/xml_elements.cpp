#include "toolkit/vtk/xml_elements.h"

#include <algorithm>
#include <array>
#include <utility>

#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr std::size_t kDeepestXml = 32;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && ends_word(text.front())) text.remove_prefix(1);
  while (!text.empty() && ends_word(text.back())) text.remove_suffix(1);
  return text;
}

class XmlWalk {
 public:
  XmlWalk(const std::string& path, std::string_view text)
      : path_(path), text_(without_byte_order_mark(text)), skipped_(text.size() - text_.size()) {}

  std::vector<XmlElement> elements() {
    while (next_tag()) {
      if (skip_past("<?", "?>") || skip_past("<!--", "-->")) continue;
      if (text_.substr(at_).starts_with("<!")) fail("declarations such as <!ENTITY> are not read");
      if (text_.substr(at_).starts_with("</")) {
        close();
      } else if (open() == "AppendedData") {
        return std::move(found_);
      }
    }
    if (found_.empty()) fail("expected XML");
    if (!open_.empty()) fail("is truncated: <" + around().name + "> is not closed");
    return std::move(found_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(at_), '\n');
    throw IoError(path_, "line " + std::to_string(line) + ": " + problem);
  }

  /// Innermost element that is not closed yet. \pre there is one
  XmlElement& around() { return found_[open_.back()]; }

  /// Moves to the next tag, and gives the text before it to the element around it.
  bool next_tag() {
    const std::size_t first = at_;
    at_ = std::min(text_.find('<', at_), text_.size());
    const std::string_view text = trimmed(text_.substr(first, at_ - first));
    if (!text.empty() && !open_.empty()) around().text = text;
    return at_ < text_.size();
  }

  bool skip_past(std::string_view start, std::string_view end) {
    if (!text_.substr(at_).starts_with(start)) return false;
    const auto found = text_.find(end, at_ + start.size());
    if (found == std::string_view::npos)
      fail("is truncated: no '" + std::string(end) + "' follows");
    at_ = found + end.size();
    return true;
  }

  char here() const {
    if (at_ >= text_.size()) fail("is truncated in a tag");
    return text_[at_];
  }

  void skip_spaces() {
    while (ends_word(here())) ++at_;
  }

  std::string word() {
    const std::size_t first = at_;
    while (!ends_word(here()) &&
           std::string_view("=/>\"'<").find(here()) == std::string_view::npos) {
      ++at_;
    }
    if (at_ == first) fail("expected a name");
    return std::string(text_.substr(first, at_ - first));
  }

  void close() {
    at_ += 2;
    const std::string name = word();
    skip_spaces();
    if (here() != '>' || open_.empty() || around().name != name)
      fail("</" + name + "> closes nothing");
    ++at_;
    open_.pop_back();
  }

  /// Reads a start tag and returns its name.
  std::string open() {
    ++at_;
    XmlElement element{word(), {}, open_.empty() ? "" : around().name};
    if (open_.empty() && !found_.empty()) fail("expected one element around all others");
    for (skip_spaces(); here() != '>' && here() != '/'; skip_spaces()) add_attribute(element);
    const bool is_empty = here() == '/';
    if (is_empty) ++at_;
    if (here() != '>') fail("expected '>'");
    element.end_of_tag = ++at_ + skipped_;
    if (!is_empty) open_.push_back(found_.size());
    if (open_.size() > kDeepestXml) {
      fail("more than " + std::to_string(kDeepestXml) + " elements inside each other");
    }
    found_.push_back(std::move(element));
    return found_.back().name;
  }

  void add_attribute(XmlElement& element) {
    const std::string key = word();
    skip_spaces();
    if (here() != '=') fail("expected '=' after '" + key + "'");
    ++at_;
    skip_spaces();
    const char mark = here();
    if (mark != '"' && mark != '\'') fail("expected a value of '" + key + "' in quotation marks");
    const auto end = text_.find(mark, at_ + 1);
    if (end == std::string_view::npos) fail("is truncated in a tag");
    const bool is_new =
        element.attributes.emplace(key, plain(text_.substr(at_ + 1, end - at_ - 1))).second;
    if (!is_new) fail("'" + key + "' occurs twice in <" + element.name + ">");
    at_ = end + 1;
  }

  /// Attribute value with XML's five entities and &#39; replaced.
  std::string plain(std::string_view value) const {
    constexpr std::array<std::pair<std::string_view, char>, 6> kEntities = {
        {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}, {"#39", '\''}}};
    std::string text;
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (value[i] == '<') fail("expected no '<' in a value");
      if (value[i] != '&') {
        text += value[i];
        continue;
      }
      const std::string_view name = value.substr(i + 1, value.find(';', i) - i - 1);
      const auto known = std::find_if(kEntities.begin(), kEntities.end(),
                                      [name](const auto& entity) { return entity.first == name; });
      if (known == kEntities.end()) {
        fail("the entity '&" + std::string(name.substr(0, 20)) + "' is not read");
      }
      text += known->second;
      i += name.size() + 1;
    }
    return text;
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t skipped_;
  std::size_t at_ = 0;
  std::vector<std::size_t> open_;  ///< indices of the elements that are not closed yet
  std::vector<XmlElement> found_;
};

}  // namespace

std::string XmlElement::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? "" : found->second;
}

std::vector<XmlElement> xml_elements(const std::string& path, std::string_view text) {
  return XmlWalk(path, text).elements();
}

}  // namespace mimetra
