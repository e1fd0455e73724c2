#include "toolkit/operations/option_file.h"

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/operations/json.h"

namespace mimetra {

namespace {

/// A value as people type it.
std::string typed(const Json& value) {
  return value.is_string() ? value.get<std::string>() : json_text(value);
}

/// [10, 30] and ["a.txt", "b.txt"] likewise.
std::string listed_values(const Json& values) {
  std::string text;
  for (const Json& value : values) text += (text.empty() ? "" : ",") + typed(value);
  return text;
}

}  // namespace

void set_from_file(const std::string& path, Parameters& parameters) {
  const Json options = read_json(path);
  if (!options.is_object()) throw IoError(path, "expected an object of option names and values");
  for (const auto& [name, value] : options.items()) {
    const Parameter* parameter = parameters.find(name);
    if (!parameter) {
      throw UsageError(path + ": '" + name +
                       "' is no parameter of the operation; `mimetra operations` lists them, all "
                       "else is said on the command line");
    }
    const std::string text = value.is_array() ? listed_values(value) : typed(value);
    try {
      parameters.set(name, parse_value(*parameter, text));
    } catch (const UsageError& error) {
      throw UsageError(path + ": " + error.what());
    }
  }
}

}  // namespace mimetra
