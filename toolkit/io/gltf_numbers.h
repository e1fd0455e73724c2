#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

/// Internal to the writer of glTF.
namespace mimetra {

/// `count` numbers in single precision.
std::string float_bytes(const double* values, Eigen::Index count);

/// Numbers of which those that are not 0 are stored, at least one.
struct SparseNumbers {
  std::string indices, values;
  std::size_t stored = 0;
};

/// `values` in elements of `size`; elements with `count / 2` or more that are not 0 give nothing.
std::optional<SparseNumbers> sparse_numbers(const double* values, Eigen::Index count, int size);

}  // namespace mimetra
