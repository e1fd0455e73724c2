#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace mimetra {

/// A struct of the C interface as it was given: fields past its struct_size, which the giver's
/// header did not have, are zero.
template <typename Struct>
Struct whole(const Struct& given) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct copy{};
  std::memcpy(&copy, &given, std::min<std::size_t>(given.struct_size, sizeof copy));
  return copy;
}

}  // namespace mimetra
