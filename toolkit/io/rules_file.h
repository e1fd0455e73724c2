#pragma once

#include <filesystem>
#include <optional>

#include "toolkit/model/weight_rules.h"

namespace mimetra {

/// Reads rules of a model's expressions:
///   {"pairs": [["browUpLeft", "browUpRight"]],
///    "exclusive": [["lookUp", "lookDown"]],
///    "expressions": {"jawOpen": {"minimum": 0, "maximum": 0.8, "gain": 1.2, "offset": 0}}}
/// in which each part may be missing. Throws IoError that names the element: for what is no such
/// JSON, an unknown key, a number that is not finite, a name twice in a pair or group, limits that
/// cross, a gain that is not above 0, and limits without 0 of an expression in a group.
WeightRules read_rules(const std::filesystem::path& path);

/// `rules.json` in the folder of a model; none where there is none, or the model is one file.
std::optional<std::filesystem::path> rules_beside(const std::filesystem::path& model);

}  // namespace mimetra
