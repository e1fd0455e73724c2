#pragma once

#include <filesystem>
#include <memory>

#include "toolkit/io/point_cache.h"

/// NumPy's arrays as point caches. Internal to their readers and writers.
namespace mimetra {

/// F x N x 3, N x 3 (one frame), or F x 3N (x y z x y z ...), float32 or float64, either byte
/// order; in C order it is read frame by frame, in Fortran's, and from a pipe, whole. Throws
/// IoError.
std::unique_ptr<const PointCache> open_npy_cache(const std::filesystem::path& path);
/// The same of bytes that messages call `name`.
std::unique_ptr<const PointCache> open_npy_cache(const std::string& name,
                                                 std::unique_ptr<const InputBytes> bytes);

/// Throws OutputError.
PointCacheTarget begin_npy_cache(const std::filesystem::path& path, std::size_t frames,
                                 std::size_t vertices, bool single_precision);

}  // namespace mimetra
