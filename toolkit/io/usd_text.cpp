#include "toolkit/io/usd_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

constexpr int kDeepestPrim = 100, kDeepestValue = 16;

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool starts_number(char c) {
  return is_digit(c) || c == '-' || c == '+' || c == '.';
}

/// Whether this brings in, or chooses among, what stands elsewhere.
bool composes(std::string_view name) {
  static const std::vector<std::string_view> names = {
      "references", "payload",   "inherits", "specializes", "variantSets", "variantSet",
      "variants",   "subLayers", "clips",    "clipSets",    "relocates",   "instanceable"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

class UsdParser {
 public:
  UsdParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  UsdLayer layer() {
    if (!text_.starts_with("#usda 1.")) fail("expected '#usda 1.0' or a later 1.x");
    UsdLayer layer;
    if (peek() == '(') layer.metadata = metadata();
    while (peek() != '\0') layer.prims.push_back(prim(word("def, over or class"), 0));
    return layer;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_at(line_, message); }
  [[noreturn]] void fail_at(int line, const std::string& message) const {
    throw IoError(path_, "line " + std::to_string(line) + ": " + message);
  }
  [[noreturn]] void fail_expected(const std::string& what) {
    const char c = peek();
    fail("expected " + what +
         (c == '\0' ? ", found the end of the file" : ", found '" + std::string(1, c) + "'"));
  }
  [[noreturn]] void refuse_composition(const std::string& name, int line) const {
    fail_at(
        line,
        "'" + name +
            "' is not read; write the stage flattened, without references, payloads, variants and "
            "instances (usdcat --flatten)");
  }

  /// The next character that means something; '\0' at the end.
  char peek() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      } else if (c == '\n') {
        ++line_;
        ++at_;
      } else if (c == ' ' || c == '\t' || c == '\r' || c == ';') {
        ++at_;
      } else if (c == '\0') {
        fail("a zero byte");
      } else {
        return c;
      }
    }
    return '\0';
  }
  bool skip(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!skip(c)) fail_expected(std::string("'") + c + "'");
  }

  std::string word(const char* what) {
    const char first = peek();
    if (first == '\0' || !is_word_character(first) || is_digit(first)) fail_expected(what);
    const std::size_t start = at_;
    while (at_ < text_.size() && is_word_character(text_[at_])) ++at_;
    return std::string(text_.substr(start, at_ - start));
  }

  /// "text", 'text' or either in three quotes.
  std::string quoted() {
    const char quote = peek();
    if (quote != '"' && quote != '\'') fail_expected("text in quotes");
    const std::string three(3, quote);
    const bool is_long = text_.substr(at_).starts_with(three);
    const int first_line = line_;
    at_ += is_long ? 3 : 1;
    std::string text;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (is_long ? text_.substr(at_).starts_with(three) : c == quote) {
        at_ += is_long ? 3 : 1;
        return text;
      }
      if (c == '\n' && !is_long) break;
      if (c == '\n') ++line_;
      if (c == '\\' && at_ + 1 < text_.size()) ++at_;
      text += text_[at_];
    }
    fail_at(first_line, "text in quotes has no end");
  }

  /// What stands between `open` and `close` on a line.
  std::string enclosed(std::string_view open, std::string_view close) {
    at_ += open.size();
    const std::size_t end = text_.find(close, at_);
    const std::size_t line_end = text_.find('\n', at_);
    if (end == std::string_view::npos || end > line_end) {
      fail("'" + std::string(open) + "' has no end");
    }
    std::string text(text_.substr(at_, end - at_));
    at_ = end + close.size();
    return text;
  }

  /// Also one that is not finite: only what is used of a layer is refused for it.
  double literal() {
    const char first = peek();
    if (first == '+') ++at_;
    const std::string_view rest = text_.substr(at_);
    double value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc() || end == rest.data()) fail_expected("a number");
    at_ += static_cast<std::size_t>(end - rest.data());
    return value;
  }

  double number() {
    const double value = literal();
    if (!std::isfinite(value)) fail("a number that is not finite");
    return value;
  }

  void value_into(UsdValue& value, int depth) {
    if (depth > kDeepestValue) {
      fail("nested deeper than " + std::to_string(kDeepestValue) + " levels");
    }
    const char first = peek();
    if (first == '[' || first == '(') {
      ++at_;
      const char close = first == '[' ? ']' : ')';
      while (!skip(close)) {
        value_into(value, depth + 1);
        if (!skip(',') && peek() != close) fail_expected(std::string("',' or '") + close + "'");
      }
    } else if (first == '{') {
      dictionary(depth + 1);
    } else if (first == '"' || first == '\'') {
      value.words.push_back(quoted());
    } else if (first == '@') {
      // Three around paths with a '@' in them.
      const std::string_view mark = text_.substr(at_).starts_with("@@@") ? "@@@" : "@";
      value.words.push_back(enclosed(mark, mark));
    } else if (first == '<') {
      value.words.push_back(enclosed("<", ">"));
    } else if (first != '\0' && starts_number(first)) {
      value.numbers.push_back(literal());
    } else {
      std::string given = word("a value");
      if (given == "nan" || given == "inf") {
        value.numbers.push_back(std::numeric_limits<double>::quiet_NaN());
      } else {
        value.words.push_back(std::move(given));
      }
    }
  }
  UsdValue value(int depth = 0) {
    UsdValue read;
    value_into(read, depth);
    return read;
  }

  /// `{ string name = "a" }`: nothing of it is about shapes.
  void dictionary(int depth) {
    if (depth > kDeepestValue) {
      fail("nested deeper than " + std::to_string(kDeepestValue) + " levels");
    }
    expect('{');
    while (!skip('}')) {
      while (peek() != '=') {
        const char c = peek();
        if (c == '"' || c == '\'') {
          quoted();
        } else if (c == '[') {
          ++at_;
          expect(']');
        } else if (c != '\0' && is_digit(c)) {
          number();
        } else {
          word("a name");
        }
        if (peek() == ':') ++at_;
      }
      expect('=');
      value(depth);
      skip(',');
    }
  }

  /// An empty list, None, false or 0.
  static bool is_nothing(const UsdValue& value) {
    if (value.words.empty())
      return std::ranges::all_of(value.numbers, [](double n) { return n == 0; });
    return value.words.front() == "None" || value.words.front() == "false";
  }

  static bool is_none(const UsdValue& value) {
    return value.words.size() == 1 && value.words.front() == "None";
  }

  static bool edits_list(const std::string& name) {
    return name == "prepend" || name == "append" || name == "add" || name == "delete" ||
           name == "reorder";
  }

  std::map<std::string, UsdValue> metadata() {
    std::map<std::string, UsdValue> all;
    expect('(');
    while (!skip(')')) {
      if (peek() == '"' || peek() == '\'') {
        quoted();
        continue;
      }
      std::string name = word("the name of a setting");
      if (edits_list(name)) name = word("the name of a setting");
      const int line = line_;
      expect('=');
      const bool is_dictionary = peek() == '{';
      UsdValue given = value();
      if (composes(name) && (is_dictionary || !is_nothing(given))) refuse_composition(name, line);
      all[name] = std::move(given);
      skip(',');
    }
    return all;
  }

  UsdPrim prim(const std::string& specifier, int depth) {
    if (specifier != "def" && specifier != "over" && specifier != "class") {
      fail("expected def, over or class, found '" + specifier + "'");
    }
    if (depth > kDeepestPrim) {
      fail("prims nest deeper than " + std::to_string(kDeepestPrim) + " levels");
    }
    UsdPrim prim;
    prim.specifier = specifier;
    if (peek() != '"' && peek() != '\'') prim.type = word("a type or a name");
    prim.line = line_;
    prim.name = quoted();
    if (peek() == '(') prim.metadata = metadata();
    expect('{');
    while (!skip('}')) statement(prim, depth);
    return prim;
  }

  void statement(UsdPrim& prim, int depth) {
    std::string first = word("a property or a prim");
    if (first == "def" || first == "over" || first == "class") {
      prim.children.push_back(this->prim(first, depth + 1));
      return;
    }
    if (composes(first)) refuse_composition(first, line_);
    if (first == "reorder") {
      word("what is put in order");
      expect('=');
      value();
      return;
    }
    while (first == "custom" || first == "uniform" || first == "varying" || first == "config" ||
           edits_list(first)) {
      first = word("a type");
    }
    property(prim, std::move(first));
  }

  void property(UsdPrim& prim, std::string type) {
    if (skip('[')) {
      expect(']');
      type += "[]";
    }
    peek();
    const int line = line_;
    const std::string name = word("a property's name");
    UsdProperty& property = prim.properties[name];
    property.line = line;
    property.type = std::move(type);
    std::string part;
    if (at_ < text_.size() && text_[at_] == '.') {
      ++at_;
      part = word("timeSamples or connect");
    }
    if (part == "timeSamples") {
      expect('=');
      samples(property);
    } else if (skip('=')) {
      UsdValue given = value();
      if (part.empty() && !is_none(given)) {
        property.value = std::move(given);
        property.has_value = true;
      }
    }
    if (peek() != '(') return;
    const auto settings = metadata();
    const auto found = settings.find("interpolation");
    if (found != settings.end() && !found->second.words.empty()) {
      property.interpolation = found->second.words.front();
    }
  }

  void samples(UsdProperty& property) {
    property.samples.clear();
    expect('{');
    while (!skip('}')) {
      const double time = number();
      expect(':');
      UsdValue given = value();
      if (is_none(given)) {
        property.blocked_line = line_;
      } else {
        property.samples.emplace_back(time, std::move(given));
      }
      if (!skip(',') && peek() != '}') fail_expected("',' or '}'");
    }
    std::ranges::stable_sort(property.samples, {}, &std::pair<double, UsdValue>::first);
    const auto same =
        std::ranges::adjacent_find(property.samples, {}, &std::pair<double, UsdValue>::first);
    if (same != property.samples.end()) {
      fail_at(property.line, "two time samples at " + readable(same->first, 8));
    }
    if (property.samples.empty() && property.blocked_line == 0)
      fail_at(property.line, "time samples without any");
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

UsdLayer parse_usd(const std::string& path, std::string_view text) {
  return UsdParser(path, text).layer();
}

namespace {

std::vector<double> numbers_at(const UsdProperty& property, std::optional<double> code) {
  const auto& samples = property.samples;
  if (samples.empty() || (!code && property.has_value)) return property.value.numbers;
  if (!code) return samples.front().second.numbers;
  const auto after =
      std::ranges::upper_bound(samples, *code, {}, &std::pair<double, UsdValue>::first);
  if (after == samples.begin()) return after->second.numbers;
  const auto& [from, start] = *std::prev(after);
  if (after == samples.end() || from == *code ||
      after->second.numbers.size() != start.numbers.size()) {
    return start.numbers;
  }
  const double share = (*code - from) / (after->first - from);
  std::vector<double> between = start.numbers;
  for (std::size_t i = 0; i < between.size(); ++i) {
    between[i] += share * (after->second.numbers[i] - between[i]);
  }
  return between;
}

}  // namespace

void usd_fail(const std::string& path, int line, const std::string& message) {
  throw IoError(path, "line " + std::to_string(line) + ": " + message);
}

const UsdProperty* usd_property(const UsdPrim& prim, const std::string& name) {
  const auto found = prim.properties.find(name);
  return found == prim.properties.end() ? nullptr : &found->second;
}

void check_numbers(const std::string& path, const UsdProperty& property,
                   const std::vector<double>& numbers) {
  if (property.blocked_line > 0) {
    usd_fail(path, property.blocked_line, "a time sample of nothing is not read");
  }
  const bool sound = std::ranges::all_of(numbers, [](double n) { return std::isfinite(n); });
  if (!sound) usd_fail(path, property.line, "holds a number that is not finite");
}

std::vector<double> usd_numbers(const std::string& path, const UsdProperty& property,
                                std::optional<double> code) {
  const std::vector<double> numbers = numbers_at(property, code);
  check_numbers(path, property, numbers);
  return numbers;
}

std::vector<int> usd_integers(const std::string& path, const UsdProperty& property,
                              const std::string& name) {
  std::vector<int> values;
  for (const double number : usd_numbers(path, property)) {
    if (number != std::floor(number) || number < 0 || number > std::numeric_limits<int>::max()) {
      usd_fail(path, property.line, name + ": " + readable(number, 12) + " is no count");
    }
    values.push_back(static_cast<int>(number));
  }
  return values;
}

const UsdProperty& usd_needed(const std::string& path, const UsdPrim& prim,
                              const std::string& name) {
  const UsdProperty* property = usd_property(prim, name);
  if (!property) usd_fail(path, prim.line, prim.type + " '" + prim.name + "' has no " + name);
  return *property;
}

bool usd_is_word(const UsdPrim& prim, const std::string& name, const std::string& word) {
  const UsdProperty* property = usd_property(prim, name);
  return property && !property->value.words.empty() && property->value.words.front() == word;
}

}  // namespace mimetra
