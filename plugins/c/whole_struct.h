#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace mimetra {

/// A struct of the C interface as it was given: fields past its struct_size, which the giver's
/// header did not have, are zero. No struct ends within a field: of such a size that field is zero.
template <typename Struct>
Struct whole(const Struct& given) {
  static_assert(std::is_trivially_copyable_v<Struct>);
  Struct copy{};
  const std::size_t size = given.struct_size / alignof(Struct) * alignof(Struct);
  std::memcpy(&copy, &given, std::min(size, sizeof copy));
  return copy;
}

}  // namespace mimetra
