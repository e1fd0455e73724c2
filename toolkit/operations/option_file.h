#pragma once

#include <string>

#include "toolkit/operations/parameter.h"

namespace mimetra {

/// Sets parameters from a JSON file, an object of their names and values. Throws IoError where it
/// cannot be read, UsageError for an unknown name or a value out of range.
void set_from_file(const std::string& path, Parameters& parameters);

}  // namespace mimetra
