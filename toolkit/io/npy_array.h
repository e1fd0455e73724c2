#pragma once

#include <bit>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/point_cache.h"

/// NumPy's arrays: headers, values, and point caches. Internal to their readers and writers.
namespace mimetra {

/// What stands before the values.
struct NpyHeader {
  std::endian order = std::endian::little;
  char kind = 'f';  ///< f, i, u or b
  std::size_t item_bytes = 8;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data = 0;  ///< where the values start
};

/// "4 x 5 x 3".
std::string shape_text(const std::vector<std::size_t>& shape);
/// From the first bytes of a file. Throws IoError that names `path`.
NpyHeader read_npy_header(const std::string& path, std::string_view bytes);
/// Number of values, which the file holds exactly: found before memory is asked for. Throws
/// IoError.
std::size_t checked_count(const std::string& path, std::size_t file_bytes, const NpyHeader& header);
/// The header of a whole file, whose size fits it; no more than the first 128 kB are read. Throws
/// IoError.
NpyHeader read_npy_header(const std::string& path, const InputBytes& file);
/// Throws IoError unless the array is F x N x 3, N x 3 or F x 3N, in floating point and not empty.
void check_frames_header(const std::string& path, const NpyHeader& header);
/// What stands before numbers of a type ("<f8") in C order: version 1, padded so that the values
/// start at a multiple of 64 bytes, as NumPy does.
std::string npy_header_bytes(std::string_view type, const std::vector<std::size_t>& shape);

struct NumericArray;

/// The values of an array in C order, from all bytes of its file. Throws IoError.
NumericArray npy_values(const std::string& path, std::string_view bytes, const NpyHeader& header);

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
