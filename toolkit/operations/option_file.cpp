#include "toolkit/operations/option_file.h"

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/operations/json.h"

namespace mimetra {

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
    std::string text = value.is_string() ? value.get<std::string>() : json_text(value);
    if (value.is_array()) text = text.substr(1, text.size() - 2);  // [10,30] as people type it
    try {
      parameters.set(name, parse_value(*parameter, text));
    } catch (const UsageError& error) {
      throw UsageError(path + ": " + error.what());
    }
  }
}

}  // namespace mimetra
