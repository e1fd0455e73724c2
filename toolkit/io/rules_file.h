#pragma once

#include <filesystem>
#include <optional>

#include "toolkit/model/weight_rules.h"

namespace mimetra {

/// Reads rules for a model's expressions. Each part may be missing:
///   {"pairs": [["browUpLeft", "browUpRight"]],
///    "exclusive": [["lookUp", "lookDown"]],
///    "expressions": {"jawOpen": {"minimum": 0, "maximum": 0.8, "gain": 1.2, "offset": 0}}}
/// Throws IoError with the element if the JSON has another form or an unknown key. Also throws it
/// for a name twice in a pair or group, a number beyond -1000 to 1000, and a gain that is not above
/// 0. A minimum must not exceed its maximum. The limits of an expression in a group must include 0.
WeightRules read_rules(const std::filesystem::path& path);

/// Path of `rules.json` in a model's folder; none if it does not exist or the model is a single
/// file.
std::optional<std::filesystem::path> rules_beside(const std::filesystem::path& model);

}  // namespace mimetra
