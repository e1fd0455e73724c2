#pragma once

#include <string>
#include <vector>

#include "toolkit/io/usd_values.h"

/// What prims of a layer of USD refer to. Internal to the format.
namespace mimetra {

/// A prim and those that it stands in, the innermost last.
using UsdStack = std::vector<const UsdPrim*>;

/// The prim of a path: from the root of the layer or, without a slash before it, from the prim of
/// `from`, with `..` for what that one stands in. Empty where there is none.
UsdStack usd_stack_at(const UsdLayer& layer, const std::string& path, const UsdStack& from);

/// A property, and the prim that has it.
struct UsdOwned {
  UsdStack owner = {};
  const UsdProperty* property = nullptr;
};

/// A property of a prim or, where it has none, of the nearest prim that it stands in; null where
/// none of them has it.
UsdOwned usd_inherited(const UsdStack& stack, const std::string& name);

}  // namespace mimetra
