#include "toolkit/io/model_spec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

double coefficient_of(const std::string& entry, const std::string& number) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (number.empty() || error != std::errc() || end != number.data() + number.size() ||
      !std::isfinite(value)) {
    throw std::invalid_argument("'" + entry + "': expected NAME=NUMBER as in identity003=1.5");
  }
  return value;
}

/// `at` is the last '@'; the file's folders may hold others.
ModelSpec with_fit(const std::string& text, std::size_t at) {
  std::error_code unreadable;
  for (auto here = text.find('@'); here < at; here = text.find('@', here + 1)) {
    if (fs::exists(text.substr(0, here), unreadable)) at = here;
  }
  const std::string file = text.substr(at + 1);
  return {text.substr(0, at), {}, file, file};
}

ModelSpec parsed_spec(const std::string& text) {
  ModelSpec spec;
  const auto slash = text.find_last_of('/');
  const auto at = text.find_last_of('@');
  std::error_code unreadable;
  if (at != std::string::npos && text.ends_with(".json") && !fs::exists(text, unreadable)) {
    return with_fit(text, at);
  }
  if (at == std::string::npos || (slash != std::string::npos && at < slash) ||
      fs::exists(text, unreadable)) {
    spec.path = text;
    return spec;
  }
  spec.path = text.substr(0, at);
  spec.identity_text = text.substr(at + 1);
  std::string rest = spec.identity_text + ',';
  for (auto comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    const std::string entry = rest.substr(0, comma);
    rest.erase(0, comma + 1);
    const auto equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw std::invalid_argument("'" + entry + "': expected NAME=NUMBER as in identity003=1.5");
    }
    const std::string name = entry.substr(0, equals);
    const auto is_given = [&](const auto& given) { return given.first == name; };
    if (std::ranges::any_of(spec.identity, is_given)) {
      throw std::invalid_argument("'" + text + "': '" + name + "' is given twice");
    }
    spec.identity.emplace_back(name, coefficient_of(entry, entry.substr(equals + 1)));
  }
  return spec;
}

}  // namespace

ModelSpec ModelSpec::parse(const std::string& text) {
  ModelSpec spec = parsed_spec(text);
  if (!spec.path.empty()) return spec;
  throw std::invalid_argument("'" + text + "': names no model");
}

std::vector<std::string> ModelSpec::notes() const {
  // Standard deviations, or shares of an identity.
  constexpr double kMostDeviations = 10;
  std::vector<std::string> notes;
  for (const auto& [identity_name, coefficient] : identity) {
    if (std::abs(coefficient) <= kMostDeviations) continue;
    notes.push_back(path.string() + ": " + identity_name + " is " + readable(coefficient) +
                    ", expected about -3 to 3");
  }
  if (fit && !read_fit(*fit).has_one_identity()) {
    notes.push_back(fit->string() +
                    ": holds an identity for each frame, and the person is their mean; `mimetra "
                    "fit` without `--shape frame` fits one for the clip");
  }
  return notes;
}

std::string ModelSpec::name() const {
  // "." and "ict-face/" are named after their folder too.
  fs::path last = fs::absolute(path).lexically_normal();
  if (!last.has_filename()) last = last.parent_path();
  std::error_code unreadable;
  const std::string stem =
      fs::is_directory(path, unreadable) ? last.filename().string() : last.stem().string();
  if (!fit) return identity_text.empty() ? stem : stem + '@' + identity_text;
  fs::path fitted = fit->stem();
  if (fitted.extension() == ".fit") fitted = fitted.stem();
  return stem + '@' + fitted.string();
}

}  // namespace mimetra
