#include "toolkit/formats/hdf5/hdf5_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

#include <zlib.h>

#include "toolkit/formats/hdf5/hdf5_chunks.h"
#include "toolkit/io/bytes.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

using Storage = Hdf5Dataset::Storage;

class ContiguousRows : public Storage {
 public:
  ContiguousRows(std::shared_ptr<const Hdf5Bytes> file, std::uint64_t address,
                 std::uint64_t row_bytes)
      : file_(std::move(file)), address_(address), row_bytes_(row_bytes) {}

  void read_rows(std::uint64_t first, std::uint64_t rows, char* to) const override {
    file_->read(address_ + first * row_bytes_, to, rows * row_bytes_);
  }

 private:
  std::shared_ptr<const Hdf5Bytes> file_;
  std::uint64_t address_;
  std::uint64_t row_bytes_;
};

/// Rows in the object's header.
class CompactRows : public Storage {
 public:
  CompactRows(std::string_view bytes, std::uint64_t row_bytes)
      : bytes_(bytes), row_bytes_(row_bytes) {}

  void read_rows(std::uint64_t first, std::uint64_t rows, char* to) const override {
    std::memcpy(to, bytes_.data() + first * row_bytes_, rows * row_bytes_);
  }

 private:
  std::string bytes_;
  std::uint64_t row_bytes_;
};

enum class Filter : std::uint64_t { deflate = 1, shuffle = 2, fletcher32 = 3 };

std::vector<Filter> filters_of(const Hdf5Dataset& dataset, const Hdf5Bytes& file,
                               const Hdf5Message* message) {
  if (!message) return {};
  Hdf5Fields fields(file, message->body);
  const auto version = fields.byte();
  const auto count = fields.byte();
  if (version == 1) fields.skip(6);
  constexpr std::uint64_t kMostFilters = 32;
  if (count > kMostFilters) file.fail_damaged("a dataset has too many filters");
  std::vector<Filter> filters;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = fields.number(2);
    constexpr std::uint64_t kFirstOfOthers = 256;
    const auto name_bytes = version == 1 || id >= kFirstOfOthers ? fields.number(2) : 0;
    fields.skip(2);
    const auto values = fields.number(2);
    std::string_view name = fields.take(name_bytes);
    name = name.substr(0, name.find('\0'));
    fields.skip(4 * values + (version == 1 && values % 2 == 1 ? 4 : 0));
    if (id < 1 || id > 3) {
      dataset.fail("is stored by the filter " + std::to_string(id) +
                   (name.empty() ? "" : " '" + std::string(name) + "'") +
                   ", which is not read; rewrite it by `h5repack -f GZIP=4 IN.h5 OUT.h5`");
    }
    filters.push_back(Filter(id));
  }
  return filters;
}

std::string inflated(const Hdf5Dataset& dataset, std::string_view stored, std::size_t most) {
  std::string bytes(most, '\0');
  auto size = static_cast<uLongf>(bytes.size());
  const int status =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                 reinterpret_cast<const Bytef*>(stored.data()), static_cast<uLong>(stored.size()));
  if (status != Z_OK) dataset.fail("cannot be inflated; the file is damaged");
  bytes.resize(size);
  return bytes;
}

/// Sum of 16-bit numbers, most significant byte first, which the filter of this name appends to a
/// block. It counts modulo 65535; sums of 0 become 65535 unless all bytes are 0.
///
/// [Fletcher. An arithmetic checksum for serial transmissions. IEEE Trans. Comm. 30(1), 1982]
std::uint32_t fletcher32(std::string_view bytes) {
  const auto folded = [](std::uint64_t sum) {
    while (sum > 0xffff) sum = (sum & 0xffff) + (sum >> 16);
    return sum;
  };
  std::uint64_t first = 0, second = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto high = static_cast<unsigned char>(bytes[i]);
    const auto low = i + 1 < bytes.size() ? static_cast<unsigned char>(bytes[i + 1]) : 0u;
    first = folded(first + (high * 256u + low));
    second += first;
  }
  return static_cast<std::uint32_t>(folded(second) << 16 | first);
}

/// Checks the sum at the end of a block and cuts it off.
void take_sum(const Hdf5Dataset& dataset, std::string& bytes) {
  constexpr std::size_t kSum = sizeof(std::uint32_t);
  const std::size_t size = bytes.size() - std::min(bytes.size(), kSum);
  const std::string_view all = bytes;
  if (bytes.size() < kSum || number_at<std::uint32_t>(&bytes[size], std::endian::little) !=
                                 fletcher32(all.substr(0, size))) {
    dataset.fail("has a wrong checksum; the file is damaged");
  }
  bytes.resize(size);
}

/// Undoes the shuffle filter, which stores all first bytes of the numbers, then all second bytes,
/// and so on.
std::string unshuffled(std::string_view bytes, std::size_t number) {
  std::string numbers(bytes);
  const std::size_t count = bytes.size() / number;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t b = 0; b < number; ++b) numbers[i * number + b] = bytes[b * count + i];
  }
  return numbers;
}

/// Decoded blocks of the same rows: in memory while they are few, otherwise in a ScratchFile.
class DecodedBlocks {
 public:
  DecodedBlocks(std::uint64_t count, std::uint64_t block_bytes) : block_bytes_(block_bytes) {
    constexpr std::uint64_t kMemoryBytes = std::uint64_t{16} << 20;
    if (count > kMemoryBytes / block_bytes) {
      file_.emplace();
    } else {
      memory_.resize(count * block_bytes);
    }
  }

  void put(std::uint64_t block, std::string_view bytes) {
    bytes = bytes.substr(0, block_bytes_);
    if (file_) {
      file_->write(block * block_bytes_, std::as_bytes(std::span(bytes)));
    } else {
      std::ranges::copy(bytes, memory_.data() + block * block_bytes_);
    }
  }

  /// Returns `count` bytes of a block from `offset` on, which may be stored in `held`. Several
  /// threads may call it.
  const char* bytes(std::uint64_t block, std::uint64_t offset, std::uint64_t count,
                    std::string& held) const {
    const std::uint64_t at = block * block_bytes_ + offset;
    if (!file_) return memory_.data() + at;
    held.resize(count);
    file_->read(at, std::as_writable_bytes(std::span(held)));
    return held.data();
  }

 private:
  std::uint64_t block_bytes_;
  std::string memory_;
  std::optional<ScratchFile> file_;
};

/// Dataset in separately compressed blocks. The decoded blocks of the last rows are kept, because
/// neighbouring rows are usually read next.
class ChunkedRows : public Storage {
 public:
  /// Takes all blocks in order. Throws IoError if together they are larger than the file.
  ChunkedRows(const Hdf5Dataset& dataset, std::shared_ptr<const Hdf5Bytes> file, Hdf5Grid grid,
              std::vector<Filter> filters, std::vector<Hdf5Chunk> chunks)
      : dataset_(dataset),
        file_(std::move(file)),
        grid_(std::move(grid)),
        filters_(std::move(filters)),
        number_(dataset.type().bytes),
        row_bytes_(dataset.row_size() * number_),
        chunks_(std::move(chunks)) {
    if (chunks_.size() != grid_.count()) dataset_.fail("holds no numbers for a part of it");
    std::uint64_t left = file_->size();
    for (const Hdf5Chunk& chunk : chunks_) {
      if (chunk.address == kNowhere) dataset_.fail("holds no numbers for a part of it");
      if (chunk.stored_bytes > left || !file_->holds(chunk.address, chunk.stored_bytes)) {
        dataset_.fail("claims more numbers than the file holds");
      }
      left -= chunk.stored_bytes;
      const std::uint64_t most =
          is_deflated(chunk) ? kMostInflated * (chunk.stored_bytes + 1) : chunk.stored_bytes;
      if (grid_.block_bytes > most) dataset_.fail("claims more numbers than the file holds");
    }
  }

  void read_rows(std::uint64_t first, std::uint64_t rows, char* to) const override {
    for (std::uint64_t row = first; row < first + rows;) {
      const std::uint64_t slab = row / grid_.extents[0], begin = slab * grid_.extents[0];
      const std::uint64_t end = std::min({begin + grid_.extents[0], grid_.sizes[0], first + rows});
      const auto blocks = blocks_of(slab);
      const std::uint64_t of_slab = chunks_.size() / grid_.counts[0];
      const std::uint64_t in_block = grid_.block_bytes / grid_.extents[0];
      std::string held;
      for (std::uint64_t i = 0; i < of_slab; ++i) {
        const char* const bytes =
            blocks->bytes(i, (row - begin) * in_block, (end - row) * in_block, held);
        copy_block(bytes, i, end - row, to);
      }
      to += (end - row) * row_bytes_;
      row = end;
    }
  }

 private:
  bool is_deflated(const Hdf5Chunk& chunk) const {
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      if (filters_[i] == Filter::deflate && (chunk.left_out >> i & 1) == 0) return true;
    }
    return false;
  }

  /// Returns the decoded blocks of one slab: all blocks that cover the same rows.
  std::shared_ptr<const DecodedBlocks> blocks_of(std::uint64_t slab) const {
    const std::lock_guard lock(mutex_);
    if (kept_ && kept_slab_ == slab) return kept_;
    kept_.reset();
    const std::uint64_t of_slab = chunks_.size() / grid_.counts[0];
    auto blocks = std::make_shared<DecodedBlocks>(of_slab, grid_.block_bytes);
    for (std::uint64_t i = 0; i < of_slab; ++i) {
      blocks->put(i, decoded(chunks_[slab * of_slab + i]));
    }
    kept_slab_ = slab;
    kept_ = std::move(blocks);
    return kept_;
  }

  std::string decoded(const Hdf5Chunk& chunk) const {
    constexpr std::size_t kChecksum = 4;
    std::string bytes = file_->at(chunk.address, chunk.stored_bytes);
    for (std::size_t i = filters_.size(); i > 0; --i) {
      if (chunk.left_out >> (i - 1) & 1) continue;
      if (filters_[i - 1] == Filter::fletcher32) {
        take_sum(dataset_, bytes);
      } else if (filters_[i - 1] == Filter::shuffle) {
        bytes = unshuffled(bytes, number_);
      } else {
        bytes = inflated(dataset_, bytes, grid_.block_bytes + kChecksum * filters_.size());
      }
    }
    if (bytes.size() < grid_.block_bytes) dataset_.fail("is truncated: a block of it is too short");
    return bytes;
  }

  /// Copies the first `rows` rows of block number `index`, without the part outside the dataset.
  void copy_block(const char* from, std::uint64_t index, std::uint64_t rows, char* to) const {
    // At most three dimensions: rows, columns, and the numbers of one element.
    std::array<std::uint64_t, 3> size = {1, 1, 1}, extent = {1, 1, 1}, begin = {0, 0, 0};
    for (std::size_t d = grid_.sizes.size(); d > 0; --d) {
      size[d - 1] = grid_.sizes[d - 1];
      extent[d - 1] = grid_.extents[d - 1];
      if (d == 1) break;
      begin[d - 1] = index % grid_.counts[d - 1] * grid_.extents[d - 1];
      index /= grid_.counts[d - 1];
    }
    const std::uint64_t columns = std::min(extent[1], size[1] - begin[1]);
    const std::size_t run = std::min(extent[2], size[2] - begin[2]) * number_;
    for (std::uint64_t row = 0; row < rows; ++row) {
      for (std::uint64_t column = 0; column < columns; ++column) {
        const std::uint64_t source = (row * extent[1] + column) * extent[2];
        const std::uint64_t place = (row * size[1] + begin[1] + column) * size[2] + begin[2];
        std::memcpy(to + place * number_, from + source * number_, run);
      }
    }
  }

  const Hdf5Dataset dataset_;
  std::shared_ptr<const Hdf5Bytes> file_;
  Hdf5Grid grid_;
  std::vector<Filter> filters_;
  std::size_t number_;
  std::uint64_t row_bytes_;
  std::vector<Hdf5Chunk> chunks_;

  mutable std::mutex mutex_;
  mutable std::uint64_t kept_slab_ = 0;
  mutable std::shared_ptr<const DecodedBlocks> kept_;
};

/// Grid of a dataset's blocks with these extents, the last of which are the bytes of a number.
Hdf5Grid grid_of(const Hdf5Dataset& dataset, const std::vector<std::uint64_t>& most,
                 std::vector<std::uint64_t> extents) {
  extents.pop_back();
  Hdf5Grid grid{dataset.shape(), std::move(extents), {}, {}, dataset.type().bytes};
  // Largest block, since a block is decoded as a whole.
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
  for (std::size_t d = 0; d < most.size(); ++d) {
    const std::uint64_t extent = grid.extents[d];
    // A block may reach beyond the dataset, so the dataset does not limit its size.
    if (grid.block_bytes > kMostBytes / extent) {
      dataset.fail("is cut into blocks of more than 1 GiB; rewrite it by `h5repack` with less");
    }
    grid.block_bytes *= extent;
    const auto blocks = [extent](std::uint64_t size) {
      return size / extent + (size % extent > 0);
    };
    grid.counts.push_back(blocks(grid.sizes[d]));
    grid.most.push_back(most[d] == kNowhere ? kNowhere : blocks(most[d]));
  }
  return grid;
}

std::shared_ptr<const Storage> chunked(const Hdf5Dataset& dataset,
                                       const std::shared_ptr<const Hdf5Bytes>& file,
                                       const std::vector<std::uint64_t>& most, Hdf5Fields& fields,
                                       std::uint64_t version, const Hdf5Message* filter_message) {
  const auto flags = version == 4 ? fields.byte() : 0;
  const auto dimensions = fields.byte();
  if (dimensions != most.size() + 1) file->fail_damaged("a dataset's blocks have another shape");
  const auto tree = version == 4 ? kNowhere : fields.address();
  const std::size_t width = version == 4 ? fields.byte() : 4;
  if (width < 1 || width > 8) file->fail_damaged("a dataset's blocks have no size");
  std::vector<std::uint64_t> extents;
  for (std::size_t d = 0; d < dimensions; ++d) {
    extents.push_back(fields.number(width));
    if (extents.back() == 0) file->fail_damaged("a dataset's blocks have no size");
  }
  const Hdf5Grid grid = grid_of(dataset, most, std::move(extents));
  // Every block takes at least one byte of the file.
  if (grid.count() > file->size()) dataset.fail("claims more numbers than the file holds");
  auto filters = filters_of(dataset, *file, filter_message);
  auto chunks = version == 4 ? hdf5_chunks_of_index(*file, grid, fields, flags, !filters.empty())
                             : hdf5_chunks_of_tree(*file, grid, tree);
  return std::make_shared<ChunkedRows>(dataset, file, grid, std::move(filters), std::move(chunks));
}

/// Source of the dataset's rows, from the layout and filter messages. Throws IoError.
std::shared_ptr<const Storage> hdf5_storage(const Hdf5Dataset& dataset,
                                            std::shared_ptr<const Hdf5Bytes> file,
                                            const std::vector<std::uint64_t>& most,
                                            const Hdf5Message& layout, const Hdf5Message* filters) {
  enum : std::uint64_t { kCompact, kContiguous, kChunked, kVirtual };
  constexpr std::size_t kMostDimensions = 3;
  const std::uint64_t row_bytes = dataset.row_size() * dataset.type().bytes;
  const std::uint64_t bytes = dataset.size() * dataset.type().bytes;
  if (bytes == 0) return std::make_shared<CompactRows>("", 0);
  Hdf5Fields fields(*file, layout.body);
  const auto version = fields.byte();
  if (version != 3 && version != 4) {
    dataset.fail("has version " + std::to_string(version) + " of HDF5's layout, expected 3 or 4");
  }
  const auto kind = fields.byte();
  if (kind == kCompact) {
    const std::string_view held = fields.take(fields.number(2));
    if (held.size() < bytes) dataset.fail("claims more numbers than the file holds");
    return std::make_shared<CompactRows>(held, row_bytes);
  }
  if (kind == kContiguous) {
    const auto address = fields.address();
    if (address == kNowhere) dataset.fail("holds no numbers");
    if (fields.address() < bytes || !file->holds(address, bytes)) {
      dataset.fail("claims more numbers than the file holds");
    }
    return std::make_shared<ContiguousRows>(std::move(file), address, row_bytes);
  }
  if (kind == kVirtual) dataset.fail("is made of other datasets, which are not followed");
  const std::size_t rank = dataset.shape().size();
  if (kind != kChunked || rank == 0) file->fail_damaged("a dataset has an unknown layout");
  if (rank > kMostDimensions) {
    dataset.fail("has " + std::to_string(rank) + " dimensions, expected 3 at most");
  }
  return chunked(dataset, file, most, fields, version, filters);
}

/// First message of a type; null if there is none.
const Hdf5Message* find(const std::vector<Hdf5Message>& messages, Hdf5Message::Type type) {
  for (const Hdf5Message& message : messages) {
    if (message.type == type) return &message;
  }
  return nullptr;
}

}  // namespace

Hdf5Dataset::Hdf5Dataset(std::shared_ptr<const Hdf5Bytes> file, std::string name,
                         const std::vector<Hdf5Message>& messages)
    : file_(std::move(file)), name_(std::move(name)) {
  if (find(messages, Hdf5Message::external_files)) {
    fail("keeps its numbers in another file, which is not read");
  }
  const auto* space = find(messages, Hdf5Message::dataspace);
  const auto* type = find(messages, Hdf5Message::datatype);
  const auto* layout = find(messages, Hdf5Message::layout);
  const auto* filters = find(messages, Hdf5Message::filters);
  if (!space || !type || !layout) fail("is no array");
  for (const auto* message : {space, type, layout, filters}) {
    if (message && message->is_shared) fail("shares its type with others, expected its own");
  }
  const auto number = hdf5_type(*file_, type->body);
  if (!number) fail("does not hold integers, float32 or float64");
  type_ = *number;
  auto [sizes, most] = hdf5_shape(*file_, space->body);
  shape_ = std::move(sizes);
  for (std::size_t d = 0; d < shape_.size(); ++d) {
    // The size in bytes, with 8 for each number, must fit into 64 bits.
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max() / 8;
    if (shape_[d] > 0 && size_ > kMost / shape_[d]) fail("claims more numbers than the file holds");
    size_ *= shape_[d];
    if (d > 0) row_size_ *= shape_[d];
  }
  // If one extent is 0, the others are not limited by the size. Readers loop over rows.
  if (size_ == 0 && std::ranges::any_of(shape_, [&](auto n) { return n > file_->size(); })) {
    fail("claims more rows than the file has bytes");
  }
  storage_ = hdf5_storage(*this, file_, most, *layout, filters);
}

void Hdf5Dataset::read(std::uint64_t first, std::span<double> values) const {
  if (values.empty()) return;
  std::string stored(values.size() * type_.bytes, '\0');
  storage_->read_rows(first, values.size() / row_size_, stored.data());
  decode_hdf5(type_, stored.data(), values);
}

std::vector<double> Hdf5Dataset::values() const {
  std::vector<double> values(size_);
  read(0, values);
  return values;
}

void Hdf5Dataset::fail(const std::string& message) const {
  file_->fail("dataset '" + name_ + "' " + message);
}

Hdf5File::Hdf5File(const fs::path& path) : bytes_(std::make_shared<const Hdf5Bytes>(path)) {
  const auto messages = hdf5_group(*bytes_, hdf5_root(*bytes_));
  links_ = hdf5_links(*bytes_, messages);
  for (const Hdf5Message& message : messages) {
    if (message.type == Hdf5Message::attribute) add_attribute(message);
  }
}

std::vector<std::string> Hdf5File::names() const {
  std::vector<std::string> names;
  for (const auto& [name, address] : links_) names.push_back(name);
  return names;
}

Hdf5Dataset Hdf5File::dataset(const std::string& name) const {
  const auto link = links_.find(name);
  if (link == links_.end()) fail("has no dataset '" + name + "'");
  if (!link->second) fail("'" + name + "' is a link to elsewhere, which is not followed");
  return {bytes_, name, hdf5_messages(*bytes_, *link->second)};
}

double Hdf5File::attribute(const std::string& name, double otherwise) const {
  const auto found = attributes_.find(name);
  if (found == attributes_.end()) return otherwise;
  if (found->second && std::isfinite(*found->second)) return *found->second;
  fail("attribute '" + name + "' is not one finite number");
}

void Hdf5File::add_attribute(const Hdf5Message& message) {
  if (message.is_shared) return;
  Hdf5Fields fields(*bytes_, message.body);
  const auto version = fields.byte();
  if (version < 1 || version > 3) bytes_->fail_damaged("an attribute has an unknown version");
  const bool type_is_shared = fields.byte() != 0 && version > 1;
  const auto name_bytes = fields.number(2), type_bytes = fields.number(2),
             space_bytes = fields.number(2);
  if (version == 3) fields.skip(1);
  const auto part = [&fields, version](std::uint64_t bytes) {
    const std::string_view taken = fields.take(bytes);
    if (version == 1) fields.skip((8 - bytes % 8) % 8);
    return taken;
  };
  std::string_view name = part(name_bytes);
  name = name.substr(0, name.find('\0'));
  const std::string_view type = part(type_bytes), space = part(space_bytes);
  std::optional<double>& value = attributes_[std::string(name)];
  if (type_is_shared) return;
  const auto number = hdf5_type(*bytes_, type);
  if (!number) return;
  for (const std::uint64_t size : hdf5_shape(*bytes_, space).sizes) {
    if (size != 1) return;
  }
  double stored = 0;
  decode_hdf5(*number, fields.take(number->bytes).data(), {&stored, 1});
  value = stored;
}

}  // namespace mimetra
