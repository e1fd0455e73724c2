#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/usd_text.h"

/// What the properties of a layer of USD hold. Internal to the format.
namespace mimetra {

/// Throws IoError with path and line.
[[noreturn]] void usd_fail(const std::string& path, int line, const std::string& message);

/// Null where the prim has none of that name.
const UsdProperty* usd_property(const UsdPrim& prim, const std::string& name);

/// The numbers of a property at a time: the nearest sample's outside of them, and a straight line
/// between two of them. Its own value where it has no samples, or where no time is asked for.
/// Throws IoError with the line where one is not finite, or a sample is None.
std::vector<double> usd_numbers(const std::string& path, const UsdProperty& property,
                                std::optional<double> code = {});

/// Throws IoError with the line of a property of which a number is not finite, or a time sample is
/// None.
void check_numbers(const std::string& path, const UsdProperty& property,
                   const std::vector<double>& numbers);

/// The same as counts and indices. Throws IoError with the line where one is none.
std::vector<int> usd_integers(const std::string& path, const UsdProperty& property,
                              const std::string& name);

/// A property that the prim must have. Throws IoError.
const UsdProperty& usd_needed(const std::string& path, const UsdPrim& prim,
                              const std::string& name);

/// Whether the first word of a property is `word`.
bool usd_is_word(const UsdPrim& prim, const std::string& name, const std::string& word);

}  // namespace mimetra
