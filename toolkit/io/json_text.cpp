#include "toolkit/io/json_text.h"

#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr std::size_t kLongestJson = std::size_t{512} << 20;
/// Limits the recursion of the functions that copy and write values.
constexpr std::size_t kDeepestJson = 100;
/// ordered_json compares each key with all keys before it.
constexpr std::size_t kMostKeys = 10000;
constexpr std::size_t kLongestMessage = 160;

/// Checks the text before a value is made. Throws std::runtime_error for content that the parser
/// would accept. (The parser's own callback searches the whole list for every object in it.)
class Guard : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool string(string_t& text) override {
    check_text(text);
    return true;
  }
  bool key(string_t& name) override {
    check_text(name);
    add_key(name);
    return true;
  }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  /// The parser reports the error later.
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  bool open() {
    keys_.emplace_back();
    if (keys_.size() <= kDeepestJson) return true;
    throw std::runtime_error("nested deeper than " + std::to_string(kDeepestJson) + " levels");
  }

  bool close() {
    keys_.pop_back();
    return true;
  }

  static void check_text(const std::string& text) {
    const auto zero = text.find('\0');
    if (zero == std::string::npos) return;
    throw std::runtime_error("'" + text.substr(0, zero) + "' goes on with a zero byte");
  }

  void add_key(const std::string& key) {
    std::set<std::string>& keys = keys_.back();
    if (!keys.insert(key).second) {
      throw std::runtime_error("the key '" + key + "' occurs twice in an object");
    }
    if (keys.size() > kMostKeys) {
      throw std::runtime_error("an object has more than " + std::to_string(kMostKeys) + " keys");
    }
  }

  std::vector<std::set<std::string>> keys_;
};

}  // namespace

std::string json_reason(const std::exception& error) {
  const std::string message = error.what();
  const auto line = message.find("line ");
  const auto bracket = message.find("] ");
  if (line != std::string::npos) return message.substr(line, kLongestMessage);
  return message.substr(bracket == std::string::npos ? 0 : bracket + 2, kLongestMessage);
}

Json parse_json(const std::string& path, std::string_view text, const std::string& expected) {
  const auto fail = [&](const std::string& found) -> Json {
    throw IoError(path, "expected " + expected + ": " + found);
  };
  check_encoding(path, text);
  if (text.size() > kLongestJson) {
    return fail("is longer than " + std::to_string(kLongestJson >> 20) + " MB");
  }
  try {
    const std::string_view json = without_byte_order_mark(text);
    Guard guard;
    Json::sax_parse(json, &guard);
    return Json::parse(json);
  } catch (const Json::exception& error) {
    return fail(json_reason(error));
  } catch (const std::runtime_error& error) {
    return fail(error.what());
  }
}

Json read_json(const std::filesystem::path& path, const std::string& expected) {
  return parse_json(path.string(), read_file(path), expected);
}

std::optional<Json> read_json_if_any(const std::filesystem::path& path) {
  try {
    return read_json(path);
  } catch (const IoError&) {
    return {};
  }
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string short_text(const Json& json) {
  constexpr std::size_t kLongest = 40;
  if (json.is_structured()) return json.is_array() ? "a list" : "an object";
  const std::string text = json_text(json);
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

}  // namespace mimetra
