#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/hdf5_bytes.h"

/// The parts that HDF5 files are made of. Internal to their reader.
namespace mimetra {

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

/// Reads parts that must not overlap: together no more than the file holds, so that a file whose
/// parts refer to one another in a circle comes to an end.
class Hdf5Parts {
 public:
  explicit Hdf5Parts(const Hdf5Bytes& file) : file_(file), left_(file.size()) {}

  std::string at(std::uint64_t address, std::uint64_t bytes);

 private:
  const Hdf5Bytes& file_;
  std::uint64_t left_;
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
