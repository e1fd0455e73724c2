#pragma once

#include <nlohmann/json_fwd.hpp>

namespace mimetra {

/// JSON with its keys in the order they were added.
using Json = nlohmann::ordered_json;

}  // namespace mimetra
