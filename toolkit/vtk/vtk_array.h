#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

class vtkDataArray;
template <typename>
class vtkSmartPointer;

/// Arrays in VTK's files: numbers as text, bytes, or base64, whole or in compressed blocks.
/// Internal to the readers and writers.
namespace mimetra {

/// How a file stores the bytes of its arrays.
struct VtkStorage {
  std::size_t word = 4;  ///< bytes of each number before the values: sizes and counts of blocks
  bool big_endian = false;
  std::string compressor = {};  ///< name of a VTK class; empty for none

  bool operator==(const VtkStorage&) const = default;
};

/// An array as it is stored in a file.
struct VtkArray {
  /// `bare` bytes have no size before them, as in legacy files.
  enum class Form { text, base64, raw, bare };

  std::string name = {};
  std::string type = {};  ///< as in XML: "Float32", "Int64", "Bit"
  int components = 1;
  Form form = Form::text;
  std::string_view stored = {};  ///< exactly the array's bytes in the file
};

/// Throws IoError that says what is wrong with an array.
using ArrayFailure = std::function<void(const std::string& problem)>;

/// Bytes of a number of a type; 1 for Bit, which is decoded to bytes; 0 for other types.
std::size_t bytes_of_number(std::string_view type);

/// Cuts what follows the array off `array.stored`, which may continue with other arrays. Returns
/// the number of bytes that decoding needs. Calls `fail` for sizes that cannot be true, and for
/// missing bytes.
std::uint64_t find_end(VtkArray& array, const VtkStorage& storage, const ArrayFailure& fail);

/// Values of an array after find_end(). Calls `fail` if their number is not a multiple of the
/// components, or if bytes or words are malformed.
vtkSmartPointer<vtkDataArray> decoded(const VtkArray& array, const VtkStorage& storage,
                                      const ArrayFailure& fail);

/// Element DataArray with the values compressed by a VTK class in base64, for the byte order of
/// this machine and words of 4 bytes.
std::string data_array_element(vtkDataArray& array, const std::string& compressor);

}  // namespace mimetra
