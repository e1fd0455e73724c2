#include "toolkit/formats/hdf5/hdf5_fields.h"

#include <algorithm>
#include <iterator>

#include "toolkit/formats/hdf5/hdf5_parts.h"
#include "toolkit/io/bytes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using Links = std::map<std::string, std::optional<std::uint64_t>>;

/// One run of messages of an object's header.
struct HeaderBlock {
  std::uint64_t address;
  std::uint64_t bytes;
};

HeaderBlock continuation_of(const Hdf5Bytes& file, std::string_view body) {
  Hdf5Fields fields(file, body);
  const auto address = fields.address();
  return {address, fields.address()};
}

/// Messages of an object in the format that HDF5 writes by default.
std::vector<Hdf5Message> messages_of_version_1(const Hdf5Bytes& file, std::uint64_t address) {
  Hdf5Parts parts(file);
  const std::string prefix = parts.at(address, 16);
  Hdf5Fields head(file, prefix);
  head.skip(2);
  const auto count = head.number(2);
  head.skip(4);
  std::vector<HeaderBlock> blocks = {{address + 16, head.number(4)}};
  std::vector<Hdf5Message> messages;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const std::string bytes = parts.at(blocks[block].address, blocks[block].bytes);
    Hdf5Fields fields(file, bytes);
    while (fields.left() >= 8 && messages.size() < count) {
      Hdf5Message message;
      message.type = static_cast<unsigned>(fields.number(2));
      const auto size = fields.number(2);
      message.is_shared = (fields.byte() & 2) != 0;
      fields.skip(3);
      message.body = fields.take(size);
      if (message.type == Hdf5Message::continuation) {
        blocks.push_back(continuation_of(file, message.body));
      }
      messages.push_back(std::move(message));
    }
  }
  return messages;
}

void take_messages_of_version_2(const Hdf5Bytes& file, Hdf5Fields fields, bool ordered,
                                std::vector<Hdf5Message>& messages,
                                std::vector<HeaderBlock>& blocks) {
  const std::size_t head = ordered ? 6 : 4;
  while (fields.left() >= head) {
    Hdf5Message message;
    message.type = static_cast<unsigned>(fields.byte());
    const auto size = fields.number(2);
    message.is_shared = (fields.byte() & 2) != 0;
    if (ordered) fields.skip(2);
    message.body = fields.take(size);
    if (message.type == Hdf5Message::continuation) {
      blocks.push_back(continuation_of(file, message.body));
    }
    messages.push_back(std::move(message));
  }
}

std::vector<Hdf5Message> messages_of_version_2(const Hdf5Bytes& file, std::uint64_t address) {
  constexpr std::uint64_t kChecksum = 4, kMagic = 4, kMostPrefix = 34;
  Hdf5Parts parts(file);
  const std::string prefix = file.at(address, std::min(kMostPrefix, file.size() - address));
  Hdf5Fields head(file, prefix);
  head.skip(kMagic + 1);
  const auto flags = head.byte();
  if (flags & 0x20) head.skip(16);
  if (flags & 0x10) head.skip(4);
  const auto bytes = head.number(std::size_t{1} << (flags & 3));
  const std::uint64_t prefix_bytes = prefix.size() - head.left();
  if (bytes > file.size()) file.fail_damaged("a part of it lies outside of it");
  std::vector<HeaderBlock> blocks = {{address, prefix_bytes + bytes + kChecksum}};
  std::vector<Hdf5Message> messages;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const std::string run =
        parts.sealed(blocks[block].address, blocks[block].bytes, block == 0 ? "OHDR" : "OCHK");
    Hdf5Fields fields(file, run);
    fields.skip(block == 0 ? prefix_bytes : kMagic);
    take_messages_of_version_2(file, fields, (flags & 4) != 0, messages, blocks);
  }
  return messages;
}

/// Reads the heap that contains the names of a group in the old format.
std::string heap_of(const Hdf5Bytes& file, Hdf5Parts& parts, std::uint64_t address) {
  const std::string head = parts.at(address, 32);
  if (!head.starts_with("HEAP")) file.fail_damaged("a group's names are not where it says");
  Hdf5Fields fields(file, head);
  fields.skip(8);
  const auto bytes = fields.address();
  fields.skip(8);
  return parts.at(fields.address(), bytes);
}

Links links_of_symbol_table(const Hdf5Bytes& file, std::string_view message) {
  constexpr std::size_t kEntry = 40;
  constexpr std::uint64_t kSoftLink = 2;
  Hdf5Fields fields(file, message);
  const auto tree = fields.address();
  Hdf5Parts parts(file);
  const std::string heap = heap_of(file, parts, fields.address());
  Links links;
  for (const Hdf5Leaf& leaf : hdf5_leaves(file, tree, 0, 8)) {
    const std::string head = parts.at(leaf.address, 8);
    if (!head.starts_with("SNOD")) file.fail_damaged("a group's entries are not where it says");
    const std::uint64_t count = Hdf5Fields(file, std::string_view(head).substr(6)).number(2);
    const std::string entries = parts.at(leaf.address + 8, count * kEntry);
    Hdf5Fields entry(file, entries);
    while (entry.left() >= kEntry) {
      const auto name = entry.address(), address = entry.address(), kind = entry.number(4);
      entry.skip(20);
      if (name >= heap.size()) file.fail_damaged("a name is not where its group says");
      const std::string text = heap.c_str() + name;
      links[text] = kind == kSoftLink ? std::nullopt : std::optional(address);
    }
  }
  return links;
}

void add_link(const Hdf5Bytes& file, std::string_view message, Links& links) {
  Hdf5Fields fields(file, message);
  fields.skip(1);
  const auto flags = fields.byte();
  constexpr std::uint64_t kHardLink = 0;
  const auto kind = flags & 8 ? fields.byte() : kHardLink;
  if (flags & 4) fields.skip(8);
  if (flags & 16) fields.skip(1);
  const std::string name(fields.take(fields.number(std::size_t{1} << (flags & 3))));
  links[name] = kind == kHardLink ? std::optional(fields.address()) : std::nullopt;
}

/// Links or attributes that a group stores in a heap, as messages. Groups of the latest format do
/// so if they have more than a few.
std::vector<Hdf5Message> messages_in_heap(const Hdf5Bytes& file, const Hdf5Message& info) {
  enum : unsigned { kLinksByName = 5, kAttributesByName = 8 };
  const bool of_links = info.type == Hdf5Message::link_info;
  Hdf5Fields fields(file, info.body);
  fields.skip(1);
  if (fields.byte() & 1) fields.skip(of_links ? 8 : 2);
  const auto heap_at = fields.address();
  if (heap_at == kNowhere) return {};
  Hdf5Heap heap(file, heap_at);
  std::vector<Hdf5Message> messages;
  for (const std::string& record :
       hdf5_records(file, fields.address(), of_links ? kLinksByName : kAttributesByName)) {
    Hdf5Fields named(file, record);
    if (of_links) named.skip(4);
    const std::string_view id = named.take(of_links ? 7 : 8);
    const bool is_shared = !of_links && (named.byte() & 2) != 0;
    auto body = heap.object(id);
    // Objects outside of the heap are too large for a single number or a usual name.
    if (!body) continue;
    messages.push_back(
        {of_links ? Hdf5Message::link : Hdf5Message::attribute, is_shared, std::move(*body)});
  }
  return messages;
}

}  // namespace

std::uint64_t hdf5_root(const Hdf5Bytes& file) {
  constexpr std::uint64_t kMostBytes = 128;
  const std::string bytes = file.at(0, std::min(kMostBytes, file.size()));
  Hdf5Fields fields(file, bytes);
  fields.skip(8);
  const auto version = fields.byte();
  if (version > 3)
    file.fail("has version " + std::to_string(version) + " of HDF5, expected 0 to 3");
  if (version < 2) fields.skip(4);
  const auto address_bytes = fields.byte(), length_bytes = fields.byte();
  if (address_bytes != 8 || length_bytes != 8) {
    file.fail("has addresses of " + std::to_string(address_bytes) + " and lengths of " +
              std::to_string(length_bytes) + " bytes, expected 8");
  }
  if (version < 2) {
    fields.skip(version == 0 ? 9 : 13);
  } else {
    fields.skip(1);
  }
  fields.skip(16);
  const auto end = fields.address();
  // Older versions store the root as a link without a name.
  if (version < 2) fields.skip(16);
  const auto root = fields.address();
  if (version >= 2) {
    const std::size_t sealed = bytes.size() - fields.left();
    if (fields.number(4) != hdf5_checksum(std::string_view(bytes).substr(0, sealed))) {
      file.fail_damaged("a checksum is wrong");
    }
  }
  if (end > file.size()) {
    file.fail("is truncated: " + std::to_string(file.size()) + " bytes, expected " +
              std::to_string(end));
  }
  return root;
}

std::vector<Hdf5Message> hdf5_messages(const Hdf5Bytes& file, std::uint64_t address) {
  const std::string head = file.at(address, 4);
  if (head == "OHDR") return messages_of_version_2(file, address);
  if (head[0] != 1) file.fail_damaged("an object is not where it says");
  return messages_of_version_1(file, address);
}

std::vector<Hdf5Message> hdf5_group(const Hdf5Bytes& file, std::uint64_t address) {
  auto messages = hdf5_messages(file, address);
  for (std::size_t i = 0, count = messages.size(); i < count; ++i) {
    const auto type = messages[i].type;
    if (type != Hdf5Message::link_info && type != Hdf5Message::attribute_info) continue;
    std::ranges::move(messages_in_heap(file, messages[i]), std::back_inserter(messages));
  }
  return messages;
}

std::map<std::string, std::optional<std::uint64_t>> hdf5_links(
    const Hdf5Bytes& file, const std::vector<Hdf5Message>& messages) {
  Links links;
  for (const Hdf5Message& message : messages) {
    if (message.type == Hdf5Message::symbol_table) {
      links.merge(links_of_symbol_table(file, message.body));
    } else if (message.type == Hdf5Message::link) {
      add_link(file, message.body, links);
    }
  }
  return links;
}

Hdf5Shape hdf5_shape(const Hdf5Bytes& file, std::string_view message) {
  Hdf5Fields fields(file, message);
  const auto version = fields.byte();
  const auto rank = fields.byte();
  const bool has_most = (fields.byte() & 1) != 0;
  constexpr std::uint64_t kNull = 2;
  const auto kind = fields.byte();
  if (version == 1) fields.skip(4);
  if (version == 2 && kind == kNull) return {{0}, {0}};
  Hdf5Shape shape;
  for (std::uint64_t d = 0; d < rank; ++d) shape.sizes.push_back(fields.address());
  for (const std::uint64_t size : shape.sizes) {
    shape.most.push_back(has_most ? fields.address() : size);
    if (shape.most.back() < size) file.fail_damaged("a dataset is larger than it may become");
  }
  return shape;
}

std::optional<Hdf5Type> hdf5_type(const Hdf5Bytes& file, std::string_view message) {
  Hdf5Fields fields(file, message);
  const auto kind = fields.byte() & 15;
  const auto bits = fields.number(3);
  const auto bytes = fields.number(4);
  constexpr std::uint64_t kInteger = 0, kReal = 1;
  if (kind != kInteger && kind != kReal) return std::nullopt;
  const bool known = kind == kInteger ? bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8
                                      : bytes == 4 || bytes == 8;
  const auto offset = fields.number(2), precision = fields.number(2);
  if (!known || offset != 0 || precision != 8 * bytes) return std::nullopt;
  Hdf5Type type{kind == kReal, (bits & 8) != 0, bytes,
                bits & 1 ? std::endian::big : std::endian::little};
  if (kind == kInteger) return type;
  constexpr std::uint64_t kVax = 0x40;
  const std::vector<std::uint64_t> found = {fields.byte(), fields.byte(), fields.byte(),
                                            fields.byte(), fields.number(4)};
  const auto single = std::vector<std::uint64_t>{23, 8, 0, 23, 127};
  const auto twice = std::vector<std::uint64_t>{52, 11, 0, 52, 1023};
  if (bits & kVax || found != (bytes == 4 ? single : twice)) return std::nullopt;
  return type;
}

void decode_hdf5(const Hdf5Type& type, const char* stored, std::span<double> values) {
  const auto decode = [&]<typename Number>(Number) {
    decode_numbers<Number>(stored, type.order, values);
  };
  if (type.is_real) {
    type.bytes == 4 ? decode(float{}) : decode(double{});
  } else if (type.bytes == 1) {
    type.is_signed ? decode(std::int8_t{}) : decode(std::uint8_t{});
  } else if (type.bytes == 2) {
    type.is_signed ? decode(std::int16_t{}) : decode(std::uint16_t{});
  } else if (type.bytes == 4) {
    type.is_signed ? decode(std::int32_t{}) : decode(std::uint32_t{});
  } else {
    type.is_signed ? decode(std::int64_t{}) : decode(std::uint64_t{});
  }
}

}  // namespace mimetra
