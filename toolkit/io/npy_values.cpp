#include "toolkit/io/npy_values.h"

#include <cstdint>
#include <span>

#include "toolkit/io/bytes.h"
#include "toolkit/io/npy_header.h"

namespace mimetra {
namespace {

/// The values in the file's order.
void decode(const char* bytes, const NpyHeader& header, std::span<double> values) {
  const bool is_signed = header.kind == 'i';
  if (header.kind == 'f') {
    header.item_bytes == 4 ? decode_numbers<float>(bytes, header.order, values)
                           : decode_numbers<double>(bytes, header.order, values);
  } else if (header.item_bytes == 1) {
    is_signed ? decode_numbers<std::int8_t>(bytes, header.order, values)
              : decode_numbers<std::uint8_t>(bytes, header.order, values);
  } else if (header.item_bytes == 2) {
    is_signed ? decode_numbers<std::int16_t>(bytes, header.order, values)
              : decode_numbers<std::uint16_t>(bytes, header.order, values);
  } else if (header.item_bytes == 4) {
    is_signed ? decode_numbers<std::int32_t>(bytes, header.order, values)
              : decode_numbers<std::uint32_t>(bytes, header.order, values);
  } else {
    is_signed ? decode_numbers<std::int64_t>(bytes, header.order, values)
              : decode_numbers<std::uint64_t>(bytes, header.order, values);
  }
}

/// Fortran order has the first index fastest; here the last one is.
std::vector<double> in_c_order(const std::vector<double>& values,
                               const std::vector<std::size_t>& shape) {
  std::vector<double> ordered(values.size());
  std::vector<std::size_t> index(shape.size(), 0);
  for (const double value : values) {
    std::size_t place = 0;
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
      place = place * shape[axis] + index[axis];
    }
    ordered[place] = value;
    for (std::size_t axis = 0; axis < shape.size() && ++index[axis] == shape[axis]; ++axis) {
      index[axis] = 0;
    }
  }
  return ordered;
}

}  // namespace

NumericArray npy_values(const std::string& path, std::string_view bytes, const NpyHeader& header) {
  NumericArray array{header.shape, std::vector<double>(checked_count(path, bytes.size(), header))};
  decode(bytes.data() + header.data, header, array.values);
  if (header.fortran_order) array.values = in_c_order(array.values, array.shape);
  return array;
}

}  // namespace mimetra
