#include "toolkit/operations/option_file.h"

#include <nlohmann/json.hpp>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/json.h"

namespace mimetra {

void set_from_file(const std::string& path, Parameters& parameters) {
  Json options;
  try {
    options = Json::parse(read_file(path));
  } catch (const Json::exception& error) {
    throw IoError(path, std::string("expected JSON: ") + error.what());
  }
  if (!options.is_object()) throw IoError(path, "expected an object of option names and values");
  for (const auto& [name, value] : options.items()) {
    const Parameter* parameter = parameters.find(name);
    if (!parameter) {
      throw UsageError(path + ": '" + name +
                       "' is no parameter of the operation; `mimetra operations` lists them, all "
                       "else is said on the command line");
    }
    std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (value.is_array()) text = text.substr(1, text.size() - 2);  // [10,30] as people type it
    try {
      parameters.set(name, parse_value(*parameter, text));
    } catch (const UsageError& error) {
      throw UsageError(path + ": " + error.what());
    }
  }
}

}  // namespace mimetra
