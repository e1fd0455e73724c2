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

/// Reads a NumPy array of shape F x N x 3, N x 3 (one frame) or F x 3N as F x 3N. The values are
/// float32 or float64, in either byte order and either memory order. Throws IoError, Cancelled.
Frames read_npy_frames(const std::filesystem::path& path, const Context& context = {});

/// Reads a NumPy array of any shape. Integers and Booleans become doubles. Throws IoError.
NumericArray read_npy(const std::filesystem::path& path);

/// Writes frames (F x 3N) as an array of shape F x N x 3, in float64 or, if `single_precision`, in
/// float32. Not atomic: see PendingOutput. Throws OutputError, Cancelled.
void write_npy_frames(const std::filesystem::path& path, const Frames& frames,
                      bool single_precision = false, const Context& context = {});

}  // namespace mimetra
