#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/binary_file.h"

/// The bytes of HDF5 files, and the parts that they are made of. Internal to what reads and writes
/// them.
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
    fill_value = 0x5,
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

/// What HDF5 writes in place of an address where there is nothing.
constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

/// Walks through a run of bytes. Throws IoError where it ends early.
class Hdf5Fields {
 public:
  /// Keeps references: both must outlive it.
  Hdf5Fields(const Hdf5Bytes& file, std::string_view bytes) : file_(file), left_(bytes) {}

  std::size_t left() const { return left_.size(); }
  std::string_view take(std::uint64_t bytes);
  void skip(std::uint64_t bytes) { take(bytes); }
  /// An unsigned integer of 1 to 8 bytes.
  std::uint64_t number(std::size_t bytes);
  std::uint64_t byte() { return number(1); }
  /// Addresses and lengths.
  std::uint64_t address() { return number(8); }

 private:
  const Hdf5Bytes& file_;
  std::string_view left_;
};

/// Where the header of the top group is.
std::uint64_t hdf5_root(const Hdf5Bytes& file);

/// All messages of the object whose header is at an address.
std::vector<Hdf5Message> hdf5_messages(const Hdf5Bytes& file, std::uint64_t address);

/// The links of a group: the address of each object's header, none for links to elsewhere.
std::map<std::string, std::optional<std::uint64_t>> hdf5_links(
    const Hdf5Bytes& file, const std::vector<Hdf5Message>& messages);

/// The leaves of a B-tree of version 1, each with the key before it (`key_bytes`).
struct Hdf5Leaf {
  std::string key;
  std::uint64_t address;
};
std::vector<Hdf5Leaf> hdf5_leaves(const Hdf5Bytes& file, std::uint64_t root, unsigned tree_type,
                                  std::size_t key_bytes);

/// Sizes of the dimensions of a dataspace message.
std::vector<std::uint64_t> hdf5_shape(const Hdf5Bytes& file, std::string_view message);

/// None for what is not a number that processors know.
std::optional<Hdf5Type> hdf5_type(const Hdf5Bytes& file, std::string_view message);

/// Stored numbers as doubles. \pre as many are there as `values` has place for
void decode_hdf5(const Hdf5Type& type, const char* stored, std::span<double> values);

}  // namespace mimetra
