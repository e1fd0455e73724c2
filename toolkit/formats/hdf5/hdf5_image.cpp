#include "toolkit/formats/hdf5/hdf5_image.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "toolkit/formats/hdf5/hdf5_fields.h"
#include "toolkit/io/bytes.h"

namespace mimetra {
namespace {

/// Half of the most children of an index node, as in HDF5 itself.
constexpr std::uint16_t kInternalK = 16;
constexpr std::size_t kSuperblockBytes = 96;
constexpr std::size_t kEntryBytes = 40;

/// Appends integers, least significant byte first.
class Bytes {
 public:
  Bytes& u8(unsigned value) { return add(static_cast<std::uint8_t>(value)); }
  Bytes& u16(std::size_t value) { return add(static_cast<std::uint16_t>(value)); }
  Bytes& u32(std::size_t value) { return add(static_cast<std::uint32_t>(value)); }
  Bytes& u64(std::uint64_t value) { return add(value); }
  Bytes& text(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  /// Appends zeros up to `size` bytes.
  Bytes& up_to(std::size_t size) {
    bytes_.resize(size, '\0');
    return *this;
  }
  Bytes& padded() { return up_to((bytes_.size() + 7) / 8 * 8); }
  std::size_t size() const { return bytes_.size(); }

  operator const std::string&() const { return bytes_; }

 private:
  template <typename Number>
  Bytes& add(Number value) {
    append_little_endian(bytes_, value);
    return *this;
  }

  std::string bytes_;
};

std::size_t bytes_of(const Hdf5Array& array) {
  switch (array.type) {
    case Hdf5Array::Type::int64:
    case Hdf5Array::Type::float64:
      return 8;
    case Hdf5Array::Type::int32:
    case Hdf5Array::Type::float32:
      return 4;
    case Hdf5Array::Type::text:
      return std::max<std::size_t>(array.bytes.size(), 1);
  }
  return 0;
}

std::uint64_t size_of(const Hdf5Array& array) {
  return std::accumulate(array.shape.begin(), array.shape.end(), std::uint64_t{1},
                         std::multiplies<>());
}

std::string type_message(const Hdf5Array& array) {
  enum : unsigned { kInteger = 0x10, kReal = 0x11, kText = 0x13 };
  const std::size_t bytes = bytes_of(array);
  switch (array.type) {
    case Hdf5Array::Type::int64:
    case Hdf5Array::Type::int32:
      return Bytes().u8(kInteger).u8(8).u16(0).u32(bytes).u16(0).u16(8 * bytes);
    case Hdf5Array::Type::float64:
      return Bytes()
          .u8(kReal)
          .u8(0x20)
          .u8(63)
          .u8(0)
          .u32(bytes)
          .u16(0)
          .u16(64)
          .u8(52)
          .u8(11)
          .u8(0)
          .u8(52)
          .u32(1023);
    case Hdf5Array::Type::float32:
      return Bytes()
          .u8(kReal)
          .u8(0x20)
          .u8(31)
          .u8(0)
          .u32(bytes)
          .u16(0)
          .u16(32)
          .u8(23)
          .u8(8)
          .u8(0)
          .u8(23)
          .u32(127);
    case Hdf5Array::Type::text: {
      constexpr unsigned kPaddedByZeros = 1;
      return Bytes().u8(kText).u8(kPaddedByZeros).u16(0).u32(bytes);
    }
  }
  return {};
}

std::string space_message(const Hdf5Array& array) {
  Bytes message;
  message.u8(1).u8(static_cast<unsigned>(array.shape.size())).up_to(8);
  for (const std::uint64_t size : array.shape) message.u64(size);
  return message;
}

/// Message without a fill value, because no numbers are missing.
std::string fill_message() {
  constexpr unsigned kAllocatedLate = 2, kWhenSet = 2, kDefined = 1;
  return Bytes().u8(2).u8(kAllocatedLate).u8(kWhenSet).u8(kDefined).u32(0);
}

std::string layout_message(std::uint64_t place, std::uint64_t bytes) {
  constexpr unsigned kContiguous = 1;
  return Bytes().u8(3).u8(kContiguous).u64(bytes > 0 ? place : kNowhere).u64(bytes);
}

std::string attribute_message(const std::string& name, const Hdf5Array& value) {
  const std::string type = type_message(value), space = space_message(value);
  std::string content = value.bytes;
  if (content.empty()) content.resize(bytes_of(value) * size_of(value), '\0');
  return Bytes()
      .u8(1)
      .u8(0)
      .u16(name.size() + 1)
      .u16(type.size())
      .u16(space.size())
      .text(name)
      .u8(0)
      .padded()
      .text(type)
      .padded()
      .text(space)
      .padded()
      .text(content);
}

std::string message(std::size_t type, const std::string& content) {
  const std::string padded = Bytes().text(content).padded();
  // The format stores the size of a message in 16 bits.
  if (padded.size() > 0xffff) throw std::length_error("an HDF5 attribute is too long");
  return Bytes().u16(type).u16(padded.size()).u32(0).text(padded);
}

template <typename Number>
std::string little_endian(std::span<const Number> values) {
  if constexpr (std::endian::native == std::endian::little) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
  }
  std::string bytes;
  for (const Number value : values) append_little_endian(bytes, value);
  return bytes;
}

template <typename Matrix>
Hdf5Array array_of(Hdf5Array::Type type, const Matrix& matrix) {
  using Scalar = typename Matrix::Scalar;
  const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  const auto count = [](Eigen::Index size) { return static_cast<std::uint64_t>(size); };
  return {type,
          {count(rows.rows()), count(rows.cols())},
          little_endian(std::span<const Scalar>(rows.data(), count(rows.size())))};
}

}  // namespace

Hdf5Array Hdf5Array::of(double value) {
  return {Type::float64, {}, little_endian(std::span<const double>(&value, 1))};
}

Hdf5Array Hdf5Array::of(std::string_view text) {
  return {Type::text, {}, std::string(text)};
}

Hdf5Array Hdf5Array::of(std::span<const double> values) {
  return {Type::float64, {values.size()}, little_endian(values)};
}

Hdf5Array Hdf5Array::of(std::span<const int> values) {
  return {Type::int32, {values.size()}, little_endian(values)};
}

Hdf5Array Hdf5Array::of(std::span<const std::int64_t> values, std::vector<std::uint64_t> shape) {
  return {Type::int64, std::move(shape), little_endian(values)};
}

Hdf5Array Hdf5Array::of(const Doubles& matrix) {
  return array_of(Type::float64, matrix);
}

Hdf5Array Hdf5Array::of(const Integers& matrix) {
  return array_of(Type::int32, matrix);
}

void Hdf5Image::add(const std::string& path, Hdf5Array array) {
  add_node(path, {.is_group = false, .array = std::move(array)});
}

void Hdf5Image::reserve(const std::string& path, Hdf5Array::Type type,
                        std::vector<std::uint64_t> shape) {
  add_node(path, {.is_group = false, .is_reserved = true, .array = {type, std::move(shape), {}}});
}

void Hdf5Image::add_attribute(const std::string& path, const std::string& name, Hdf5Array value) {
  const auto found = nodes_.find(path);
  Node& node = found == nodes_.end() ? add_node(path, {}) : found->second;
  node.attributes.emplace(name, std::move(value));
}

std::string Hdf5Image::image() {
  // The first pass finds the size of everything.
  write_all();
  std::uint64_t end = bytes_.size();
  for (auto& [path, node] : nodes_) {
    if (!node.is_reserved) continue;
    node.place = end;
    end += (size_of(node.array) * bytes_of(node.array) + 7) / 8 * 8;
  }
  write_all();
  return std::exchange(bytes_, {});
}

Hdf5Image::Node& Hdf5Image::add_node(const std::string& path, Node node) {
  const auto slash = path.rfind('/');
  if (slash != std::string::npos && !nodes_.contains(path.substr(0, slash))) {
    add_node(path.substr(0, slash), {});
  }
  return nodes_[path] = std::move(node);
}

void Hdf5Image::write_all() {
  bytes_.assign(kSuperblockBytes, '\0');
  const std::uint64_t root = write_object("");
  append("");
  std::uint64_t end = bytes_.size();
  for (const auto& [path, node] : nodes_) {
    if (!node.is_reserved) continue;
    end = std::max(end, node.place + size_of(node.array) * bytes_of(node.array));
  }
  // A group's links fill one leaf of its index. A leaf contains twice this many.
  const std::size_t leaf_k = std::max<std::size_t>(4, (most_links() + 1) / 2);
  const std::string superblock = Bytes()
                                     .text({"\x89HDF\r\n\x1a\n", 8})
                                     .u32(0)
                                     .u8(0)
                                     .u8(8)
                                     .u8(8)
                                     .u8(0)
                                     .u16(leaf_k)
                                     .u16(kInternalK)
                                     .u32(0)
                                     .u64(0)
                                     .u64(kNowhere)
                                     .u64(end)
                                     .u64(kNowhere)
                                     .u64(0)
                                     .u64(root)
                                     .u32(0)
                                     .u32(0)
                                     .up_to(kSuperblockBytes);
  bytes_.replace(0, kSuperblockBytes, superblock);
}

std::uint64_t Hdf5Image::write_object(const std::string& path) {
  Node& node = nodes_.at(path);
  std::vector<std::string> messages;
  if (node.is_group) {
    messages.push_back(message(Hdf5Message::symbol_table, links_of_group(path)));
  } else {
    if (!node.is_reserved) node.place = append(node.array.bytes);
    messages.push_back(message(Hdf5Message::dataspace, space_message(node.array)));
    messages.push_back(message(Hdf5Message::datatype, type_message(node.array)));
    messages.push_back(message(Hdf5Message::fill_value, fill_message()));
    messages.push_back(
        message(Hdf5Message::layout,
                layout_message(node.place, size_of(node.array) * bytes_of(node.array))));
  }
  for (const auto& [name, value] : node.attributes) {
    messages.push_back(message(Hdf5Message::attribute, attribute_message(name, value)));
  }
  const std::string all = std::accumulate(messages.begin(), messages.end(), std::string());
  return append(Bytes().u8(1).u8(0).u16(messages.size()).u32(1).u32(all.size()).u32(0).text(all));
}

std::string Hdf5Image::links_of_group(const std::string& path) {
  const std::string before = path.empty() ? "" : path + '/';
  // The names begin with an empty name, which nothing has.
  Bytes names;
  names.u64(0);
  std::string entries;
  std::size_t count = 0, last = 0;
  for (const auto& [of_node, node] : nodes_) {
    const bool is_member = of_node.size() > before.size() && of_node.starts_with(before) &&
                           of_node.find('/', before.size()) == std::string::npos;
    if (!is_member) continue;
    last = names.size();
    names.text(of_node.substr(before.size())).u8(0).padded();
    entries += Bytes().u64(last).u64(write_object(of_node)).up_to(kEntryBytes);
    ++count;
  }
  constexpr std::uint64_t kNothingFree = 1;
  const std::string heap = names;
  const auto heap_data = append(heap);
  const auto heap_at =
      append(Bytes().text("HEAP").u32(0).u64(heap.size()).u64(kNothingFree).u64(heap_data));
  // All leaves have the same size, full or not.
  const std::size_t leaf_entries = 2 * std::max<std::size_t>(4, (most_links() + 1) / 2);
  const auto leaf = append(Bytes().text("SNOD").u8(1).u8(0).u16(count).text(entries).up_to(
      8 + leaf_entries * kEntryBytes));
  constexpr std::size_t kTreeBytes = 24 + (4 * kInternalK + 1) * 8;
  const auto tree = append(Bytes()
                               .text("TREE")
                               .u8(0)
                               .u8(0)
                               .u16(count > 0 ? 1 : 0)
                               .u64(kNowhere)
                               .u64(kNowhere)
                               .u64(0)
                               .u64(leaf)
                               .u64(last)
                               .up_to(kTreeBytes));
  return Bytes().u64(tree).u64(heap_at);
}

std::uint64_t Hdf5Image::append(const std::string& bytes) {
  bytes_.resize((bytes_.size() + 7) / 8 * 8, '\0');
  const std::uint64_t place = bytes_.size();
  bytes_ += bytes;
  return place;
}

std::size_t Hdf5Image::most_links() const {
  std::map<std::string, std::size_t> links;
  std::size_t most = 0;
  for (const auto& [path, node] : nodes_) {
    if (path.empty()) continue;
    const auto slash = path.rfind('/');
    most = std::max(most, ++links[slash == std::string::npos ? "" : path.substr(0, slash)]);
  }
  return most;
}

}  // namespace mimetra
