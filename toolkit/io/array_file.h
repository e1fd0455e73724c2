#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// An array of any shape, in C order.
struct NumericArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// Reads a NumPy array of shape F x N x 3, or N x 3 (one frame), float32 or float64, either byte
/// order and either memory order, as F x 3N. Throws IoError, Cancelled.
Frames read_npy_frames(const std::filesystem::path& path, const Context& context = {});

/// Reads a NumPy array of any shape as its shape and its values in C order; integers become
/// doubles. Throws IoError.
NumericArray read_npy(const std::filesystem::path& path);

/// Writes frames (F x 3N) as F x N x 3, float64, or float32 with `single_precision`. Throws
/// OutputError, Cancelled. Not atomic: see PendingOutput.
void write_npy_frames(const std::filesystem::path& path, const Frames& frames,
                      bool single_precision = false, const Context& context = {});

}  // namespace mimetra
