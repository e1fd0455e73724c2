#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/usd_text.h"

/// What stands where in a layer of USD, and when. Internal to the format.
namespace mimetra {

/// A prim and those that it stands in, the innermost last.
using UsdStack = std::vector<const UsdPrim*>;

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

/// From a prim to the world, at a time code. Throws IoError with the line of what is no transform.
Eigen::Matrix4d usd_world(const std::string& path, const UsdStack& stack,
                          std::optional<double> code = {});

}  // namespace mimetra
