#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mimetra {

struct NpyHeader;

/// An array of any shape, in C order.
struct NumericArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// The values of an array in C order, from all bytes of its file. Throws IoError.
NumericArray npy_values(const std::string& path, std::string_view bytes, const NpyHeader& header);

}  // namespace mimetra
