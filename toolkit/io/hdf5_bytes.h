#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>

#include "toolkit/io/binary_file.h"

/// What the readers of HDF5 files stand on. Internal to them.
namespace mimetra {

/// The bytes of an HDF5 file.
class Hdf5Bytes {
 public:
  /// Throws IoError for what is no HDF5 file.
  explicit Hdf5Bytes(const std::filesystem::path& path);

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return file_.size(); }
  bool holds(std::uint64_t address, std::uint64_t bytes) const {
    return address <= size() && bytes <= size() - address;
  }
  /// Throw IoError where the file does not hold them.
  void read(std::uint64_t address, char* to, std::size_t bytes) const;
  std::string at(std::uint64_t address, std::uint64_t bytes) const;

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_damaged(const std::string& what) const;

 private:
  std::string path_;
  InputFile file_;
};

/// What an object's header says of it: its shape, its type, an attribute.
struct Hdf5Message {
  enum Type : unsigned {
    dataspace = 0x1,
    link_info = 0x2,
    datatype = 0x3,
    link = 0x6,
    external_files = 0x7,
    layout = 0x8,
    filters = 0xb,
    attribute = 0xc,
    continuation = 0x10,
    symbol_table = 0x11,
    attribute_info = 0x15
  };

  unsigned type = 0;
  /// True where the file has it in another place.
  bool is_shared = false;
  std::string body;
};

/// How a file stores numbers.
struct Hdf5Type {
  bool is_real = true;
  bool is_signed = true;
  std::size_t bytes = 8;
  std::endian order = std::endian::little;
};

}  // namespace mimetra
