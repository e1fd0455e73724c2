#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "toolkit/formats/hdf5/hdf5_bytes.h"

/// Parts that HDF5 files consist of, and the trees and heaps that connect them. Internal to the
/// readers of HDF5.
namespace mimetra {

/// Checksum at the end of parts of HDF5's latest format.
///
/// [Jenkins. Hash functions for hash table lookup, lookup3, 2006]
std::uint32_t hdf5_checksum(std::string_view bytes);

/// Reads parts that must not overlap. Together they must not exceed the file, so that reading ends
/// even if parts refer to each other in a circle.
class Hdf5Parts {
 public:
  /// Keeps a reference to the file.
  explicit Hdf5Parts(const Hdf5Bytes& file) : file_(file), left_(file.size()) {}

  std::string at(std::uint64_t address, std::uint64_t bytes);
  /// Part that starts with a signature and ends with its checksum. Throws IoError if these are
  /// wrong.
  std::string sealed(std::uint64_t address, std::uint64_t bytes, std::string_view signature);
  /// A sealed part, which is read once and kept. The reference stays valid.
  const std::string& kept(std::uint64_t address, std::uint64_t bytes, std::string_view signature);

 private:
  const Hdf5Bytes& file_;
  std::uint64_t left_;
  std::unordered_map<std::uint64_t, std::string> kept_;
};

/// Leaves of a B-tree of version 1, each with the key before it (`key_bytes`).
struct Hdf5Leaf {
  std::string key;
  std::uint64_t address;
};
std::vector<Hdf5Leaf> hdf5_leaves(const Hdf5Bytes& file, std::uint64_t root, unsigned tree_type,
                                  std::size_t key_bytes);

/// Records of a B-tree of version 2.
std::vector<std::string> hdf5_records(const Hdf5Bytes& file, std::uint64_t tree,
                                      unsigned record_type);

/// Fractal heap, which contains the links or attributes of a group that has more than a few.
class Hdf5Heap {
 public:
  Hdf5Heap(const Hdf5Bytes& file, std::uint64_t address);

  /// Returns the bytes of an object. Returns none if it has more than 4 kB, because the file stores
  /// it outside of the heap.
  std::optional<std::string> object(std::string_view id);

 private:
  /// Block of objects. Offsets count the bytes of all blocks of the heap.
  struct Block {
    std::uint64_t first = 0, address = 0, bytes = 0;
  };
  Block block_of(std::uint64_t offset);
  const std::string& content_of(const Block& block);

  const Hdf5Bytes& file_;
  Hdf5Parts parts_;
  std::size_t offset_bytes_;
  /// Shape of the table of blocks. The blocks of the first two rows have `first_bytes_`. From then
  /// on, each row has blocks twice as large as the row before.
  std::uint64_t columns_, first_bytes_, most_bytes_;
  std::uint64_t root_, rows_;
  std::uint64_t left_;  ///< bytes that all further objects may have together
  std::unordered_map<std::uint64_t, std::string> blocks_;
};

}  // namespace mimetra
