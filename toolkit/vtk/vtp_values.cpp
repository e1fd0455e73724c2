#include "toolkit/vtk/vtp_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

#include "toolkit/io/text_cursor.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

bool separates(char c) {
  return is_blank(c) || c == '\n';
}

std::string_view without_margins(std::string_view text) {
  while (!text.empty() && separates(text.front())) text.remove_prefix(1);
  while (!text.empty() && separates(text.back())) text.remove_suffix(1);
  return text;
}

/// The six bits that a character of base64 stands for; -1 for others.
constexpr std::array<std::int8_t, 256> kDigitOf = [] {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> digits{};
  digits.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    digits[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  }
  return digits;
}();

/// Adds the bytes of four characters of base64, one to three. False where they are none.
bool decode_group(std::string_view four, std::string& bytes) {
  const std::size_t padding = four[3] != '=' ? 0 : four[2] != '=' ? 1 : 2;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const int digit = i < 4 - padding ? kDigitOf[static_cast<unsigned char>(four[i])] : 0;
    if (digit < 0) return false;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
  }
  for (std::size_t i = 0; i < 3 - padding; ++i) {
    bytes += static_cast<char>(bits >> (16 - 8 * i) & 0xffU);
  }
  return true;
}

/// The bytes of base64 text from character `begin` on, until it ends or as many are there as are
/// wanted. As VTK reads it: in groups of four characters without gaps, each with its own padding.
std::string decoded(std::string_view text, std::uint64_t begin, std::uint64_t wanted) {
  text = without_margins(text);
  std::string bytes;
  for (std::uint64_t i = begin; i + 4 <= text.size() && bytes.size() < wanted; i += 4) {
    if (!decode_group(text.substr(i, 4), bytes)) break;
  }
  if (bytes.size() > wanted) bytes.resize(wanted);
  return bytes;
}

/// Characters of so many bytes, which end with their own padding.
std::uint64_t base64_characters(std::uint64_t bytes) {
  return (bytes + 2) / 3 * 4;
}

vtkSmartPointer<vtkDataCompressor> compressor_of(const std::string& name) {
  if (name == "vtkZLibDataCompressor") return vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (name == "vtkLZMADataCompressor") return vtkSmartPointer<vtkLZMADataCompressor>::New();
  return vtkSmartPointer<vtkLZ4DataCompressor>::New();
}

template <typename Number>
double as(const std::string& bytes) {
  Number number = 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  return static_cast<double>(number);
}

/// 0 for what is no number of bytes.
std::size_t size_of(const std::string& type) {
  if (type == "String" || type == "Bit") return 0;
  if (type.ends_with("64")) return 8;
  if (type.ends_with("32")) return 4;
  return type.ends_with("16") ? 2 : 1;
}

}  // namespace

StoredValues::StoredValues(const VtpStorage& storage, std::string type, std::string_view stored,
                           Form form)
    : storage_(storage), type_(std::move(type)), stored_(stored), form_(form) {}

std::string StoredValues::words(std::size_t count) const {
  const std::size_t wanted = count * storage_.word;
  return form_ == Form::raw ? std::string(stored_.substr(0, wanted)) : decoded(stored_, 0, wanted);
}

std::uint64_t StoredValues::word(const std::string& words, std::size_t index) const {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < storage_.word; ++i) {
    const std::size_t place =
        index * storage_.word + (storage_.big_endian ? i : storage_.word - 1 - i);
    number = number << 8U | static_cast<unsigned char>(words[place]);
  }
  return number;
}

std::optional<VtpBlocks> StoredValues::blocks() const {
  const std::string sizes = words(3);
  if (sizes.size() < 3 * storage_.word) return {};
  return VtpBlocks{word(sizes, 0), word(sizes, 1), word(sizes, 2)};
}

bool StoredValues::are_all_there() const {
  if (form_ == Form::text) return true;
  std::uint64_t before = storage_.word, bytes = 0;
  std::uint64_t begin = 0;  // of what stands apart: in base64 the blocks
  if (storage_.compressor.empty()) {
    const std::string first = words(1);
    if (first.size() < storage_.word) return false;
    bytes = before + word(first, 0);
  } else {
    const auto all = blocks();
    if (!all) return false;
    const auto head = static_cast<std::size_t>(3 + all->count);
    const std::string sizes = words(head);
    if (sizes.size() < head * storage_.word) return false;
    before = sizes.size();
    begin = base64_characters(before);
    for (std::size_t i = 3; i < head; ++i) bytes += word(sizes, i);
  }
  if (form_ == Form::raw) return stored_.size() >= (begin > 0 ? before + bytes : bytes);
  return decoded(stored_, begin, bytes).size() == bytes;
}

std::uint64_t StoredValues::most() const {
  if (form_ == Form::text) return numbers_in_text();
  const std::size_t size = size_of(type_);
  if (size == 0) return 0;
  if (!storage_.compressor.empty()) {
    const auto all = blocks();
    return all ? all->bytes() / size : 0;
  }
  const std::string first = words(1);
  return first.size() < storage_.word ? 0 : word(first, 0) / size;
}

std::optional<double> StoredValues::at(std::uint64_t index) const {
  if (form_ == Form::text) return in_text(index);
  if (index >= most()) return {};
  const std::size_t size = size_of(type_);
  const std::string found = storage_.compressor.empty() ? bytes(storage_.word + index * size, size)
                                                        : unpacked(index * size, size);
  if (found.size() < size) return {};
  return number(found);
}

std::uint64_t StoredValues::numbers_in_text() const {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    if (!separates(stored_[i]) && (i == 0 || separates(stored_[i - 1]))) ++count;
  }
  return count;
}

std::optional<double> StoredValues::in_text(std::uint64_t index) const {
  const char* at = stored_.data();
  const char* const end = at + stored_.size();
  while (true) {
    while (at != end && separates(*at)) ++at;
    if (at != end && *at == '+') ++at;
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc()) return {};
    if (index-- == 0) return number;
    at = next;
  }
}

/// Of an array that is not compressed, with the number before its values.
std::string StoredValues::bytes(std::uint64_t first, std::size_t count) const {
  if (form_ == Form::raw) {
    return first < stored_.size() ? std::string(stored_.substr(first, count)) : "";
  }
  const std::string all = decoded(stored_, 0, first + count);
  return first < all.size() ? all.substr(first, count) : "";
}

/// Of a compressed one, of which only the block that holds them is unpacked.
std::string StoredValues::unpacked(std::uint64_t first, std::size_t count) const {
  const auto all = blocks();
  if (!all || all->count == 0 || all->size == 0) return "";
  const auto head = static_cast<std::size_t>(3 + all->count);
  const std::string sizes = words(head);
  if (sizes.size() < head * storage_.word) return "";
  const std::uint64_t block = first / all->size;
  if (block >= all->count) return "";
  // Blocks are for a part of an array: a large one for a few values is none of VTK's.
  constexpr std::uint64_t kLargeBlock = std::uint64_t{1} << 24U;
  if (all->size > kLargeBlock && all->size > 4 * (first + count)) return "";
  std::uint64_t begin = 0;
  for (std::size_t i = 0; i < block; ++i) begin += word(sizes, 3 + i);
  const auto packed_size =
      static_cast<std::size_t>(word(sizes, 3 + static_cast<std::size_t>(block)));
  const std::uint64_t head_bytes = head * storage_.word;
  std::string packed;
  if (form_ == Form::raw) {
    const std::uint64_t place = head_bytes + begin;
    if (place < stored_.size()) packed = stored_.substr(place, packed_size);
  } else {
    // The blocks are one text behind that of the sizes.
    const std::string behind = decoded(stored_, base64_characters(head_bytes), begin + packed_size);
    if (begin < behind.size()) packed = behind.substr(begin);
  }
  if (packed.size() < packed_size) return "";
  const bool is_last = block + 1 == all->count && all->last > 0;
  std::string values(is_last ? all->last : all->size, '\0');
  const SilentVtk silent;
  const auto pointer = [](std::string& text) {
    return reinterpret_cast<unsigned char*>(text.data());
  };
  const std::size_t size =
      compressor_of(storage_.compressor)
          ->Uncompress(pointer(packed), packed.size(), pointer(values), values.size());
  const std::uint64_t place = first % all->size;
  return size == values.size() && place < size ? values.substr(place, count) : "";
}

double StoredValues::number(std::string bytes) const {
  if (storage_.big_endian) std::ranges::reverse(bytes);
  if (type_ == "Int8") return as<std::int8_t>(bytes);
  if (type_ == "UInt8") return as<std::uint8_t>(bytes);
  if (type_ == "Int16") return as<std::int16_t>(bytes);
  if (type_ == "UInt16") return as<std::uint16_t>(bytes);
  if (type_ == "Int32") return as<std::int32_t>(bytes);
  if (type_ == "UInt32") return as<std::uint32_t>(bytes);
  if (type_ == "Int64") return as<std::int64_t>(bytes);
  if (type_ == "UInt64") return as<std::uint64_t>(bytes);
  return type_ == "Float32" ? as<float>(bytes) : as<double>(bytes);
}

}  // namespace mimetra
