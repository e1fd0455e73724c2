#include "toolkit/formats/hdf5/hdf5_chunks.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>

#include "toolkit/formats/hdf5/hdf5_parts.h"

namespace mimetra {

namespace {

constexpr std::uint64_t kSeal = 4, kPointer = 8;
/// Signature, version and kind of a part of an array, and the address of the array.
constexpr std::uint64_t kArrayHead = 14;

/// Array of the blocks of a dataset.
class ChunkArray {
 public:
  ChunkArray(const Hdf5Bytes& file, std::uint64_t chunk_bytes)
      : file_(file), parts_(file), chunk_bytes_(chunk_bytes) {}
  virtual ~ChunkArray() = default;
  virtual Hdf5Chunk at(std::uint64_t index) = 0;

 protected:
  /// Reads what entries contain, which headers tell after their version.
  void take_kind(Hdf5Fields& header) {
    const bool is_filtered = header.byte() == 1;
    entry_bytes_ = header.byte();
    if (is_filtered ? entry_bytes_ < 13 || entry_bytes_ > 20 : entry_bytes_ != kPointer) {
      file_.fail_damaged("an index is of another kind");
    }
  }

  std::uint64_t number_at(std::string_view part, std::uint64_t place, std::size_t bytes) const {
    Hdf5Fields fields(file_, part);
    fields.skip(place);
    return fields.number(bytes);
  }

  Hdf5Chunk entry(std::string_view part, std::uint64_t place) const {
    Hdf5Fields fields(file_, part);
    fields.skip(place);
    Hdf5Chunk chunk{fields.address(), chunk_bytes_, 0};
    if (entry_bytes_ == kPointer) return chunk;
    chunk.stored_bytes = fields.number(entry_bytes_ - kPointer - 4);
    chunk.left_out = fields.number(4);
    return chunk;
  }

  /// Entry of a page. Pages follow each other. Bits from `first_bit` on are set for pages that were
  /// written.
  Hdf5Chunk paged(std::uint64_t pages, std::uint64_t index, std::uint64_t entries,
                  std::string_view bits, std::uint64_t first_bit) {
    const std::uint64_t page = index / page_, bit = first_bit + page;
    if ((number_at(bits, bit / 8, 1) << bit % 8 & 0x80) == 0) return {};
    const std::uint64_t count = std::min(page_, entries - page * page_);
    const std::uint64_t address = pages + page * (page_ * entry_bytes_ + kSeal);
    return entry(parts_.kept(address, count * entry_bytes_ + kSeal, ""),
                 index % page_ * entry_bytes_);
  }

  const Hdf5Bytes& file_;
  Hdf5Parts parts_;
  std::uint64_t chunk_bytes_;
  std::uint64_t entry_bytes_ = 0;
  std::uint64_t page_ = 0;  ///< entries of a page
};

/// Array for datasets with limits in all dimensions.
class FixedArray : public ChunkArray {
 public:
  FixedArray(const Hdf5Bytes& file, std::uint64_t chunk_bytes, std::uint64_t address)
      : ChunkArray(file, chunk_bytes) {
    const std::string head = parts_.sealed(address, 28, "FAHD");
    Hdf5Fields fields(file, head);
    fields.skip(5);
    take_kind(fields);
    const auto page_bits = fields.byte();
    entries_ = fields.address();
    block_ = fields.address();
    if (entries_ > file.size() || page_bits > 62) file.fail_damaged("an index has no size");
    page_ = std::uint64_t{1} << page_bits;
  }

  Hdf5Chunk at(std::uint64_t index) override {
    if (index >= entries_ || block_ == kNowhere) return {};
    if (entries_ <= page_) {
      return entry(parts_.kept(block_, kArrayHead + entries_ * entry_bytes_ + kSeal, "FADB"),
                   kArrayHead + index * entry_bytes_);
    }
    const std::uint64_t bits = ((entries_ + page_ - 1) / page_ + 7) / 8;
    const std::string_view head = parts_.kept(block_, kArrayHead + bits + kSeal, "FADB");
    return paged(block_ + kArrayHead + bits + kSeal, index, entries_, head.substr(kArrayHead), 0);
  }

 private:
  std::uint64_t entries_, block_;
};

/// Array for datasets with one dimension of unlimited size. Its root contains some entries. Levels
/// of blocks contain the others, and have in turn twice as many blocks, or blocks twice as large,
/// as the level before. The root lists the blocks of some levels, and the lists of the later
/// levels.
class ExtensibleArray : public ChunkArray {
 public:
  ExtensibleArray(const Hdf5Bytes& file, std::uint64_t chunk_bytes, std::uint64_t address)
      : ChunkArray(file, chunk_bytes) {
    const std::string head = parts_.sealed(address, 72, "EAHD");
    Hdf5Fields fields(file, head);
    fields.skip(5);
    take_kind(fields);
    bits_ = fields.byte();
    root_entries_ = fields.byte();
    least_entries_ = fields.byte();
    const auto least_blocks = fields.byte();
    const auto page_bits = fields.byte();
    fields.skip(48);
    root_ = fields.address();
    if (bits_ > 62 || page_bits > 62 || !std::has_single_bit(least_entries_) ||
        !std::has_single_bit(least_blocks)) {
      file.fail_damaged("an index has no size");
    }
    page_ = std::uint64_t{1} << page_bits;
    list_levels_ = 2 * log(least_blocks);
    root_list_ = kArrayHead + root_entries_ * entry_bytes_;
    const std::uint64_t levels = 1 + bits_ - std::min(bits_, log(least_entries_));
    root_bytes_ = place_of_list(std::max(levels, list_levels_)) + kSeal;
  }

  Hdf5Chunk at(std::uint64_t index) override {
    if (index >> bits_ != 0 || root_ == kNowhere) return {};
    const std::string_view root = parts_.kept(root_, root_bytes_, "EAIB");
    if (index < root_entries_) return entry(root, kArrayHead + index * entry_bytes_);
    index -= root_entries_;
    const std::uint64_t level = log(index / least_entries_ + 1);
    return at(root, level, index - least_entries_ * ((std::uint64_t{1} << level) - 1));
  }

 private:
  static std::uint64_t log(std::uint64_t number) {
    return static_cast<std::uint64_t>(std::bit_width(number)) - 1;
  }
  /// Blocks of all levels before one.
  static std::uint64_t blocks_before(std::uint64_t level) {
    return (std::uint64_t{level % 2 == 0 ? 2u : 3u} << level / 2) - 2;
  }
  std::uint64_t place_of_list(std::uint64_t level) const {
    return root_list_ + (blocks_before(list_levels_) + level - list_levels_) * kPointer;
  }

  Hdf5Chunk at(std::string_view root, std::uint64_t level, std::uint64_t index) {
    const std::uint64_t entries = least_entries_ << (level + 1) / 2;
    const std::uint64_t block = index / entries, head = kArrayHead + (bits_ + 7) / 8;
    const std::uint64_t pages = entries > page_ ? entries / page_ : 0;
    std::string_view list = root;
    std::uint64_t place = root_list_ + blocks_before(level) * kPointer;
    if (level >= list_levels_) {
      const auto address = number_at(root, place_of_list(level), kPointer);
      if (address == kNowhere) return {};
      const std::uint64_t blocks = std::uint64_t{1} << level / 2;
      place = head + blocks * ((pages + 7) / 8);
      list = parts_.kept(address, place + blocks * kPointer + kSeal, "EASB");
    } else if (pages > 0) {
      file_.fail_damaged("an index has pages where it cannot");
    }
    const auto address = number_at(list, place + block * kPointer, kPointer);
    if (address == kNowhere) return {};
    index %= entries;
    if (pages > 0) {
      return paged(address + head + kSeal, index, entries, list.substr(head), block * pages);
    }
    return entry(parts_.kept(address, head + entries * entry_bytes_ + kSeal, "EADB"),
                 head + index * entry_bytes_);
  }

  std::uint64_t bits_, root_entries_, least_entries_, root_;
  std::uint64_t list_levels_ = 0;  ///< first level that has a list of its own
  std::uint64_t root_list_ = 0;    ///< place of the first address in the root
  std::uint64_t root_bytes_ = 0;
};

/// Blocks one after the other, without filters.
class ImplicitArray : public ChunkArray {
 public:
  ImplicitArray(const Hdf5Bytes& file, std::uint64_t chunk_bytes, std::uint64_t address)
      : ChunkArray(file, chunk_bytes), address_(address) {}

  Hdf5Chunk at(std::uint64_t index) override {
    if (address_ == kNowhere) return {};
    if (index > file_.size() / chunk_bytes_) file_.fail_damaged("a part of it lies outside of it");
    return {address_ + index * chunk_bytes_, chunk_bytes_, 0};
  }

 private:
  std::uint64_t address_;
};

std::vector<Hdf5Chunk> chunks_of_array(const Hdf5Grid& grid, ChunkArray&& array) {
  // Arrays have an entry for each block that the dataset may get. Of these, the blocks along an
  // unlimited dimension are furthest apart.
  const std::size_t rank = grid.counts.size();
  std::vector<std::uint64_t> steps(rank);
  std::uint64_t step = 1;
  for (std::size_t d = rank; d > 0; --d) {
    steps[d - 1] = step;
    if (grid.most[d - 1] != kNowhere) step *= grid.most[d - 1];
  }
  for (std::size_t d = 0; d < rank; ++d) {
    if (grid.most[d] == kNowhere) steps[d] = step;
  }
  std::vector<Hdf5Chunk> chunks;
  for (std::uint64_t i = 0, count = grid.count(); i < count; ++i) {
    std::uint64_t index = 0, rest = i;
    for (std::size_t d = rank; d > 0; --d) {
      index += rest % grid.counts[d - 1] * steps[d - 1];
      rest /= grid.counts[d - 1];
    }
    chunks.push_back(array.at(index));
    if (chunks.back().address == kNowhere) return {};
  }
  return chunks;
}

/// Number of the block at a position, in C order.
std::uint64_t number_of_block(const Hdf5Bytes& file, const Hdf5Grid& grid,
                              const std::vector<std::uint64_t>& position) {
  std::uint64_t index = 0;
  for (std::size_t d = 0; d < position.size(); ++d) {
    if (position[d] >= grid.counts[d]) file.fail_damaged("a block lies outside of its dataset");
    index = index * grid.counts[d] + position[d];
  }
  return index;
}

/// True if a block reaches beyond the dataset.
bool is_partial_block(const Hdf5Grid& grid, std::uint64_t index) {
  for (std::size_t d = grid.counts.size(); d > 0; --d) {
    if ((index % grid.counts[d - 1] + 1) * grid.extents[d - 1] > grid.sizes[d - 1]) return true;
    index /= grid.counts[d - 1];
  }
  return false;
}

std::vector<Hdf5Chunk> chunks_of_records(const Hdf5Bytes& file, const Hdf5Grid& grid,
                                         std::uint64_t tree, bool is_filtered) {
  constexpr unsigned kPlain = 10, kFiltered = 11;
  const auto records = hdf5_records(file, tree, is_filtered ? kFiltered : kPlain);
  if (records.size() != grid.count()) return {};
  std::vector<Hdf5Chunk> chunks(records.size());
  for (const std::string& record : records) {
    Hdf5Fields fields(file, record);
    Hdf5Chunk chunk{fields.address(), grid.block_bytes, 0};
    if (is_filtered) {
      const std::size_t after = 4 + kPointer * grid.counts.size();
      chunk.stored_bytes = fields.number(std::clamp(fields.left(), after + 1, after + 8) - after);
      chunk.left_out = fields.number(4);
    }
    std::vector<std::uint64_t> position;
    while (position.size() < grid.counts.size()) position.push_back(fields.address());
    chunks[number_of_block(file, grid, position)] = chunk;
  }
  return chunks;
}

/// Block of a dataset that has one only.
std::vector<Hdf5Chunk> single_chunk(const Hdf5Bytes& file, const Hdf5Grid& grid, Hdf5Fields fields,
                                    bool has_size) {
  if (grid.count() != 1) file.fail_damaged("a dataset's blocks have another shape");
  Hdf5Chunk chunk{kNowhere, grid.block_bytes, 0};
  if (has_size) {
    chunk.stored_bytes = fields.address();
    chunk.left_out = fields.number(4);
  }
  chunk.address = fields.address();
  if (chunk.address == kNowhere) return {};
  return {chunk};
}

}  // namespace

std::uint64_t Hdf5Grid::count() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{1}, std::multiplies<>());
}

std::vector<Hdf5Chunk> hdf5_chunks_of_tree(const Hdf5Bytes& file, const Hdf5Grid& grid,
                                           std::uint64_t tree) {
  // A key contains the size, the filters not applied, and the offset in each dimension and within a
  // number.
  const std::size_t rank = grid.counts.size(), key_bytes = 8 + 8 * (rank + 1);
  if (tree == kNowhere) return {};
  const auto leaves = hdf5_leaves(file, tree, 1, key_bytes);
  if (leaves.size() != grid.count()) return {};
  std::vector<Hdf5Chunk> chunks(leaves.size());
  for (const Hdf5Leaf& leaf : leaves) {
    Hdf5Fields key(file, leaf.key);
    const auto bytes = key.number(4), left_out = key.number(4);
    std::vector<std::uint64_t> position;
    for (const std::uint64_t extent : grid.extents) {
      const auto offset = key.address();
      if (offset % extent != 0) file.fail_damaged("a block lies outside of its dataset");
      position.push_back(offset / extent);
    }
    chunks[number_of_block(file, grid, position)] = {leaf.address, bytes, left_out};
  }
  return chunks;
}

std::vector<Hdf5Chunk> hdf5_chunks_of_index(const Hdf5Bytes& file, const Hdf5Grid& grid,
                                            Hdf5Fields layout, std::uint64_t flags,
                                            bool is_filtered) {
  enum : std::uint64_t { kPlainEdges = 1, kFilteredSize = 2 };
  enum : std::uint64_t { kSingle = 1, kImplicit, kFixed, kExtensible, kTree };
  const auto kind = layout.byte();
  std::vector<Hdf5Chunk> chunks;
  if (kind == kSingle) {
    chunks = single_chunk(file, grid, layout, (flags & kFilteredSize) != 0);
  } else {
    // These parameters are also in the header of the index.
    if (kind == kFixed) layout.skip(1);
    if (kind == kExtensible) layout.skip(5);
    if (kind == kTree) layout.skip(6);
    const auto address = layout.address();
    if (address == kNowhere) return {};
    if (kind == kImplicit) {
      chunks = chunks_of_array(grid, ImplicitArray(file, grid.block_bytes, address));
    } else if (kind == kFixed) {
      chunks = chunks_of_array(grid, FixedArray(file, grid.block_bytes, address));
    } else if (kind == kExtensible) {
      chunks = chunks_of_array(grid, ExtensibleArray(file, grid.block_bytes, address));
    } else if (kind == kTree) {
      chunks = chunks_of_records(file, grid, address, is_filtered);
    } else {
      file.fail_damaged("a dataset has an unknown layout");
    }
  }
  for (std::size_t i = 0; flags & kPlainEdges && i < chunks.size(); ++i) {
    if (is_partial_block(grid, i)) chunks[i].left_out = ~std::uint64_t{0};
  }
  return chunks;
}

}  // namespace mimetra
