#include "toolkit/io/hdf5_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/io/bytes.h"
#include "toolkit/io/hdf5_fields.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Null where there is none.
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
  shape_ = hdf5_shape(*file_, space->body);
  for (std::size_t d = 0; d < shape_.size(); ++d) {
    // Eight bytes for each number are counted by 64 bits.
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max() / 8;
    if (shape_[d] > 0 && size_ > kMost / shape_[d]) fail("claims more numbers than the file holds");
    size_ *= shape_[d];
    if (d > 0) row_size_ *= shape_[d];
  }
  // Beside an extent of 0 others could be anything, and readers go through rows.
  if (size_ == 0 && std::ranges::any_of(shape_, [&](auto n) { return n > file_->size(); })) {
    fail("claims more rows than the file has bytes");
  }
  storage_ = hdf5_storage(*this, file_, *layout, filters);
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
  const auto messages = hdf5_messages(*bytes_, hdf5_root(*bytes_));
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
  for (const std::uint64_t size : hdf5_shape(*bytes_, space)) {
    if (size != 1) return;
  }
  double stored = 0;
  decode_hdf5(*number, fields.take(number->bytes).data(), {&stored, 1});
  value = stored;
}

}  // namespace mimetra
