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

/// NumPy arrays: headers, values, and point caches. Internal to their readers and writers.
namespace mimetra {

/// Header of an .npy file.
struct NpyHeader {
  std::endian order = std::endian::little;
  char kind = 'f';  ///< f, i, u or b
  std::size_t item_bytes = 8;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data = 0;  ///< offset of the values, in bytes
};

/// Shape as text, such as "4 x 5 x 3".
std::string shape_text(const std::vector<std::size_t>& shape);
/// Parses the first bytes of a file. Throws IoError with `path`.
NpyHeader read_npy_header(const std::string& path, std::string_view bytes);
/// Number of values. Throws IoError, before any memory is allocated, unless the file holds exactly
/// as many.
std::size_t checked_count(const std::string& path, std::size_t file_bytes, const NpyHeader& header);
/// Reads a file's header, from at most its first 128 kB, and checks that the file's size fits it.
/// Throws IoError.
NpyHeader read_npy_header(const std::string& path, const InputBytes& file);
/// Throws IoError unless the array is F x N x 3, N x 3 or F x 3N, floating point and not empty.
void check_frames_header(const std::string& path, const NpyHeader& header);
/// Header for numbers of a type ("<f8") in C order. As in NumPy, it has version 1 and padding, so
/// that the values start at a multiple of 64 bytes.
std::string npy_header_bytes(std::string_view type, const std::vector<std::size_t>& shape);

struct NumericArray;

/// Values of an array in C order, from all bytes of its file. Throws IoError.
NumericArray npy_values(const std::string& path, std::string_view bytes, const NpyHeader& header);

/// Opens an array of F x N x 3, N x 3 (one frame), or F x 3N (x y z x y z ...), in float32 or
/// float64 and either byte order. C order is read frame by frame. Fortran order and pipes are read
/// whole. Throws IoError.
std::unique_ptr<const PointCache> open_npy_cache(const std::filesystem::path& path);
/// Opens bytes as an array; messages call them `name`.
std::unique_ptr<const PointCache> open_npy_cache(const std::string& name,
                                                 std::unique_ptr<const InputBytes> bytes);

/// Begins an .npy file of frames x vertices x 3. Throws OutputError.
PointCacheTarget begin_npy_cache(const std::filesystem::path& path, std::size_t frames,
                                 std::size_t vertices, bool single_precision);

}  // namespace mimetra
