#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"

namespace mimetra {

/// The fields in a mesh file.
struct FieldsRead {
  std::vector<Field> fields = {};
  /// What of it is no field, for notes: names of properties.
  std::vector<std::string> left_out = {};
};

}  // namespace mimetra
