#include "toolkit/io/gltf_numbers.h"

#include <cstdint>

#include "toolkit/io/bytes.h"

namespace mimetra {

std::string float_bytes(const double* values, Eigen::Index count) {
  std::string bytes(static_cast<std::size_t>(count) * sizeof(float), '\0');
  for (Eigen::Index i = 0; i < count; ++i) {
    put_little_endian(bytes.data() + sizeof(float) * static_cast<std::size_t>(i),
                      static_cast<float>(values[i]));
  }
  return bytes;
}

std::optional<SparseNumbers> sparse_numbers(const double* values, Eigen::Index count, int size) {
  SparseNumbers sparse;
  const auto keep = [&](Eigen::Index element) {
    append_little_endian(sparse.indices, static_cast<std::uint32_t>(element));
    sparse.values += float_bytes(values + size * element, size);
    ++sparse.stored;
  };
  for (Eigen::Index element = 0; element < count; ++element) {
    bool is_zero = true;
    for (int c = 0; c < size; ++c) {
      is_zero = is_zero && static_cast<float>(values[size * element + c]) == 0;
    }
    if (!is_zero) keep(element);
    if (2 * sparse.stored > static_cast<std::size_t>(count)) return std::nullopt;
  }
  if (sparse.stored == 0) keep(0);
  return sparse;
}

}  // namespace mimetra
