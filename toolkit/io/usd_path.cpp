#include "toolkit/io/usd_path.h"

#include <algorithm>

namespace mimetra {

UsdStack usd_stack_at(const UsdLayer& layer, const std::string& path, const UsdStack& from) {
  const bool is_absolute = path.starts_with('/');
  UsdStack found = is_absolute ? UsdStack() : from;
  for (std::size_t at = is_absolute ? 1 : 0; at <= path.size();) {
    const std::size_t slash = std::min(path.find('/', at), path.size());
    const std::string name = path.substr(at, slash - at);
    at = slash + 1;
    if (name == "..") {
      if (found.empty()) return {};
      found.pop_back();
      continue;
    }
    const std::vector<UsdPrim>& children = found.empty() ? layer.prims : found.back()->children;
    const auto child = std::ranges::find(children, name, &UsdPrim::name);
    if (child == children.end()) return {};
    found.push_back(&*child);
  }
  return found;
}

UsdOwned usd_inherited(const UsdStack& stack, const std::string& name) {
  for (UsdStack owner = stack; !owner.empty(); owner.pop_back()) {
    const UsdProperty* property = usd_property(*owner.back(), name);
    if (property) return {owner, property};
  }
  return {};
}

}  // namespace mimetra
