#include "toolkit/formats/hdf5/hdf5_parts.h"

#include <algorithm>
#include <array>
#include <bit>

#include "toolkit/io/bytes.h"

namespace mimetra {

namespace {

constexpr std::size_t kPartSum = 4, kPartAddress = 8;

/// Size of the integers that count up to `most`.
std::size_t bytes_to_count(std::uint64_t most) {
  return (static_cast<std::size_t>(std::bit_width(most)) + 7) / 8;
}

/// Throws IoError unless the last bytes of a part are the checksum of those before.
void require_checksum(const Hdf5Bytes& file, std::string_view content, std::string_view checksum) {
  if (Hdf5Fields(file, checksum).number(kPartSum) != hdf5_checksum(content)) {
    file.fail_damaged("a checksum is wrong");
  }
}

void require_signature(const Hdf5Bytes& file, std::string_view part, std::string_view signature) {
  if (!part.starts_with(signature)) file.fail_damaged("a part is not where it says");
}

}  // namespace

std::uint32_t hdf5_checksum(std::string_view bytes) {
  constexpr std::size_t kStep = 12;
  const auto start = std::uint32_t{0xdeadbeef} + static_cast<std::uint32_t>(bytes.size());
  std::array<std::uint32_t, 3> sums = {start, start, start};
  const auto add = [&sums](std::string_view next) {
    for (std::size_t i = 0; i < next.size(); ++i) {
      sums[i / 4] += std::uint32_t{static_cast<unsigned char>(next[i])} << (8 * (i % 4));
    }
  };
  for (; bytes.size() > kStep; bytes.remove_prefix(kStep)) {
    add(bytes.substr(0, kStep));
    std::size_t i = 0;
    for (const int turn : {4, 6, 8, 16, 19, 4}) {
      std::uint32_t& sum = sums[i % 3];
      const std::uint32_t last = sums[(i + 2) % 3];
      sum = (sum - last) ^ std::rotl(last, turn);
      sums[(i + 2) % 3] += sums[(i + 1) % 3];
      ++i;
    }
  }
  if (bytes.empty()) return sums[2];
  add(bytes);
  std::size_t i = 2;
  for (const int turn : {14, 11, 25, 16, 4, 14, 24}) {
    const std::uint32_t last = sums[(i + 2) % 3];
    sums[i % 3] = (sums[i % 3] ^ last) - std::rotl(last, turn);
    ++i;
  }
  return sums[2];
}

std::string Hdf5Parts::at(std::uint64_t address, std::uint64_t bytes) {
  // Every part counts one byte more than it has, so that circles of empty parts end as well.
  if (bytes >= left_) file_.fail_damaged("parts of it overlap, or lie outside of it");
  left_ -= bytes + 1;
  return file_.at(address, bytes);
}

std::string Hdf5Parts::sealed(std::uint64_t address, std::uint64_t bytes,
                              std::string_view signature) {
  if (bytes < signature.size() + kPartSum) file_.fail_damaged("a header ends early");
  std::string part = at(address, bytes);
  require_signature(file_, part, signature);
  const std::string_view all = part;
  require_checksum(file_, all.substr(0, bytes - kPartSum), all.substr(bytes - kPartSum));
  part.resize(bytes - kPartSum);
  return part;
}

const std::string& Hdf5Parts::kept(std::uint64_t address, std::uint64_t bytes,
                                   std::string_view signature) {
  const auto found = kept_.find(address);
  if (found == kept_.end()) return kept_[address] = sealed(address, bytes, signature);
  require_signature(file_, found->second, signature);
  return found->second;
}

std::vector<Hdf5Leaf> hdf5_leaves(const Hdf5Bytes& file, std::uint64_t root, unsigned tree_type,
                                  std::size_t key_bytes) {
  Hdf5Parts parts(file);
  std::vector<Hdf5Leaf> leaves;
  std::vector<std::uint64_t> nodes = {root};
  while (!nodes.empty()) {
    const auto node = nodes.back();
    nodes.pop_back();
    const std::string head = parts.at(node, 24);
    Hdf5Fields fields(file, head);
    if (fields.take(4) != "TREE" || fields.byte() != tree_type) {
      file.fail_damaged("an index is not where it says");
    }
    const bool is_leaf = fields.byte() == 0;
    const auto count = fields.number(2);
    const std::string children = parts.at(node + 24, count * (key_bytes + 8));
    Hdf5Fields child(file, children);
    while (child.left() >= key_bytes + 8) {
      std::string key(child.take(key_bytes));
      const auto address = child.address();
      if (is_leaf) {
        leaves.push_back({std::move(key), address});
      } else {
        nodes.push_back(address);
      }
    }
  }
  return leaves;
}

std::vector<std::string> hdf5_records(const Hdf5Bytes& file, std::uint64_t tree,
                                      unsigned record_type) {
  constexpr std::uint64_t kHead = 6, kFixed = kHead + kPartSum;
  Hdf5Parts parts(file);
  const std::string head = parts.sealed(tree, 38, "BTHD");
  Hdf5Fields header(file, head);
  header.skip(5);
  const auto type = header.byte(), node_bytes = header.number(4), record_bytes = header.number(2),
             depth = header.number(2);
  if (type != record_type || record_bytes == 0) file.fail_damaged("an index is of another kind");
  header.skip(2);
  struct Node {
    std::uint64_t address, records, depth;
  };
  const auto root = header.address();
  std::vector<Node> nodes = {{root, header.number(2), depth}};
  if (root == kNowhere) return {};
  // A node refers to a child by its address, the count of the child's records, and the count of all
  // records below it. Sizes of counts follow from the most records that fit.
  std::uint64_t most = 0;
  std::size_t count_bytes = 0, total_bytes = 0;
  std::vector<std::size_t> pointer_bytes;
  for (std::uint64_t d = 0; d <= depth; ++d) {
    pointer_bytes.push_back(d == 0 ? 0 : kPartAddress + count_bytes + total_bytes);
    const std::size_t unused = kFixed + pointer_bytes.back();
    const std::uint64_t fit =
        (std::max(node_bytes, unused) - unused) / (record_bytes + pointer_bytes.back());
    if (fit == 0 || most > (std::uint64_t{1} << 56) / (fit + 1)) {
      file.fail_damaged("an index is of another kind");
    }
    most = most * (fit + 1) + fit;
    (d == 0 ? count_bytes : total_bytes) = bytes_to_count(most);
  }
  std::vector<std::string> records;
  while (!nodes.empty()) {
    const Node node = nodes.back();
    nodes.pop_back();
    const std::uint64_t children = node.depth > 0 ? node.records + 1 : 0;
    const std::string bytes = parts.sealed(
        node.address, kFixed + node.records * record_bytes + children * pointer_bytes[node.depth],
        node.depth > 0 ? "BTIN" : "BTLF");
    Hdf5Fields fields(file, bytes);
    fields.skip(kHead);
    for (std::uint64_t i = 0; i < node.records; ++i)
      records.emplace_back(fields.take(record_bytes));
    for (std::uint64_t i = 0; i < children; ++i) {
      const auto address = fields.address(), count = fields.number(count_bytes);
      nodes.push_back({address, count, node.depth - 1});
      fields.skip(pointer_bytes[node.depth] - kPartAddress - count_bytes);
    }
  }
  return records;
}

Hdf5Heap::Hdf5Heap(const Hdf5Bytes& file, std::uint64_t address)
    : file_(file), parts_(file), left_(file.size()) {
  const std::string start = file.at(address, 10);
  if (Hdf5Fields(file, std::string_view(start).substr(7)).number(2) > 0) {
    file.fail("compresses the names in it, which is not read");
  }
  const std::string head = parts_.sealed(address, 146, "FRHP");
  Hdf5Fields fields(file, head);
  fields.skip(110);
  columns_ = fields.number(2);
  first_bytes_ = fields.address();
  most_bytes_ = fields.address();
  offset_bytes_ = (fields.number(2) + 7) / 8;
  fields.skip(2);
  root_ = fields.address();
  rows_ = fields.number(2);
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;
  for (const std::uint64_t size : {columns_, first_bytes_, most_bytes_}) {
    if (!std::has_single_bit(size) || size > kMostBytes) {
      file.fail_damaged("a heap has blocks of no size");
    }
  }
}

std::optional<std::string> Hdf5Heap::object(std::string_view id) {
  constexpr std::uint64_t kPlaced = 0, kHuge = 0x10;
  Hdf5Fields fields(file_, id);
  const auto kind = fields.byte();
  if (kind == kHuge) return std::nullopt;
  if (kind != kPlaced) file_.fail_damaged("an object of a heap has an unknown kind");
  const auto offset = fields.number(offset_bytes_), bytes = fields.number(fields.left());
  if (bytes > left_) file_.fail_damaged("objects of a heap overlap");
  left_ -= bytes;
  const Block block = block_of(offset);
  Hdf5Fields content(file_, content_of(block));
  content.skip(offset - block.first);
  return std::string(content.take(bytes));
}

Hdf5Heap::Block Hdf5Heap::block_of(std::uint64_t offset) {
  const auto log = [](std::uint64_t power) { return std::uint64_t(std::bit_width(power)) - 1; };
  const std::uint64_t row_bytes = columns_ * first_bytes_;
  Block block{0, root_, first_bytes_};
  // The children of a block of blocks are smaller than it, so this ends.
  for (std::uint64_t rows = rows_; rows > 0;) {
    const std::string& table = parts_.kept(
        block.address, 13 + offset_bytes_ + rows * columns_ * kPartAddress + kPartSum, "FHIB");
    const std::uint64_t within = offset - block.first;
    const auto row = static_cast<std::uint64_t>(std::bit_width(within / row_bytes));
    const std::uint64_t before = row == 0 ? 0 : row_bytes << (row - 1);
    block.bytes = row == 0 ? first_bytes_ : first_bytes_ << (row - 1);
    const std::uint64_t column = (within - before) / block.bytes;
    Hdf5Fields fields(file_, table);
    fields.skip(13 + offset_bytes_ + (row * columns_ + column) * kPartAddress);
    block.address = fields.address();
    block.first += before + column * block.bytes;
    rows = block.bytes <= most_bytes_ ? 0 : log(block.bytes) - log(row_bytes) + 1;
  }
  return block;
}

const std::string& Hdf5Heap::content_of(const Block& block) {
  const auto found = blocks_.find(block.address);
  if (found != blocks_.end()) return found->second;
  std::string bytes = parts_.at(block.address, block.bytes);
  require_signature(file_, bytes, "FHDB");
  // The checksum is among the bytes that it sums up, where it counts as 0.
  const std::size_t place = 13 + offset_bytes_;
  if (bytes.size() < place + kPartSum) file_.fail_damaged("a heap has blocks of no size");
  const std::string checksum = bytes.substr(place, kPartSum);
  bytes.replace(place, kPartSum, kPartSum, '\0');
  require_checksum(file_, bytes, checksum);
  return blocks_[block.address] = std::move(bytes);
}

}  // namespace mimetra
