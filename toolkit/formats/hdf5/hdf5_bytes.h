#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "toolkit/io/binary_file.h"

/// Bytes of HDF5 files. Internal to the readers and writers of HDF5.
namespace mimetra {

class Hdf5Bytes {
 public:
  /// Throws IoError if the file cannot be read or is not an HDF5 file.
  explicit Hdf5Bytes(const std::filesystem::path& path);

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return file_.size(); }
  bool holds(std::uint64_t address, std::uint64_t bytes) const {
    return address <= size() && bytes <= size() - address;
  }
  /// Throw IoError if the bytes are not within the file.
  void read(std::uint64_t address, char* to, std::size_t bytes) const;
  std::string at(std::uint64_t address, std::uint64_t bytes) const;

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_damaged(const std::string& what) const;

 private:
  std::string path_;
  InputFile file_;
};

/// Address that HDF5 writes for missing data, and size of dimensions without limit.
constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

/// Walks through a run of bytes. Throws IoError if it ends too early.
class Hdf5Fields {
 public:
  /// Keeps references: `file` and `bytes` must outlive it.
  Hdf5Fields(const Hdf5Bytes& file, std::string_view bytes) : file_(file), left_(bytes) {}

  std::size_t left() const { return left_.size(); }
  std::string_view take(std::uint64_t bytes);
  void skip(std::uint64_t bytes) { take(bytes); }
  /// An unsigned integer of 1 to 8 bytes.
  std::uint64_t number(std::size_t bytes);
  std::uint64_t byte() { return number(1); }
  /// An address or a length.
  std::uint64_t address() { return number(8); }

 private:
  const Hdf5Bytes& file_;
  std::string_view left_;
};

}  // namespace mimetra
