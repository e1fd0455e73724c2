#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/formats/hdf5/hdf5_bytes.h"

/// Structures in HDF5 files. Internal to the readers and writers of HDF5.
namespace mimetra {

/// One message of an object's header, such as its shape, its type or an attribute.
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
  /// True if the file stores the message elsewhere.
  bool is_shared = false;
  std::string body;
};

struct Hdf5Type {
  bool is_real = true;
  bool is_signed = true;
  std::size_t bytes = 8;
  std::endian order = std::endian::little;
};

/// Address of the header of the top group.
std::uint64_t hdf5_root(const Hdf5Bytes& file);

/// Reads all messages of the object with the header at `address`.
std::vector<Hdf5Message> hdf5_messages(const Hdf5Bytes& file, std::uint64_t address);

/// Reads all messages of a group, also the links and attributes outside of its header.
std::vector<Hdf5Message> hdf5_group(const Hdf5Bytes& file, std::uint64_t address);

/// Links of a group: the address of each object's header, none for links to elsewhere.
std::map<std::string, std::optional<std::uint64_t>> hdf5_links(
    const Hdf5Bytes& file, const std::vector<Hdf5Message>& messages);

/// Sizes of the dimensions of a dataspace message, and the most that they can be resized to:
/// kNowhere if that is unlimited.
struct Hdf5Shape {
  std::vector<std::uint64_t> sizes, most;
};
Hdf5Shape hdf5_shape(const Hdf5Bytes& file, std::string_view message);

/// Number type of a datatype message; none if the values are not numbers that processors support.
std::optional<Hdf5Type> hdf5_type(const Hdf5Bytes& file, std::string_view message);

/// Decodes stored numbers to doubles. \pre `stored` has values.size() numbers
void decode_hdf5(const Hdf5Type& type, const char* stored, std::span<double> values);

}  // namespace mimetra
