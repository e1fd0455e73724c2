#include "toolkit/vtk/vtk_array.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <vector>

#include <vtkBase64Utilities.h>
#include <vtkDataArray.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkZLibDataCompressor.h>

#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {
namespace {

/// Upper bound on the ratio of VTK's compressors.
constexpr std::uint64_t kMostCompressed = 8192;
/// Size of the blocks that VTK's writers make.
constexpr std::size_t kWrittenBlock = 32768;

struct NumberType {
  std::string_view name;
  int vtk;
  std::size_t bytes;
};

constexpr std::array<NumberType, 11> kTypes = {{{"Int8", VTK_TYPE_INT8, 1},
                                                {"UInt8", VTK_TYPE_UINT8, 1},
                                                {"Int16", VTK_TYPE_INT16, 2},
                                                {"UInt16", VTK_TYPE_UINT16, 2},
                                                {"Int32", VTK_TYPE_INT32, 4},
                                                {"UInt32", VTK_TYPE_UINT32, 4},
                                                {"Int64", VTK_TYPE_INT64, 8},
                                                {"UInt64", VTK_TYPE_UINT64, 8},
                                                {"Float32", VTK_TYPE_FLOAT32, 4},
                                                {"Float64", VTK_TYPE_FLOAT64, 8},
                                                {"Bit", VTK_TYPE_UINT8, 1}}};

const NumberType* number_type(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &NumberType::name);
  return found == kTypes.end() ? nullptr : &*found;
}

std::string_view name_of_type(int vtk) {
  const auto found = std::ranges::find(kTypes, vtk, &NumberType::vtk);
  return found == kTypes.end() ? "" : found->name;
}

/// Six bits that each base64 character encodes, or -1 for other characters.
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

/// Decodes the first `wanted` bytes of base64 text, and returns the number of characters that they
/// take. Like VTK's, the text has groups of four characters without gaps, each with its own
/// padding. Decodes fewer bytes if the text ends or a character is not base64.
std::size_t decode_base64(std::string_view text, std::uint64_t wanted, std::string& bytes) {
  bytes.clear();
  bytes.reserve(std::min<std::uint64_t>(wanted + 3, text.size() / 4 * 3 + 3));
  std::size_t at = 0;
  for (; at + 4 <= text.size() && bytes.size() < wanted; at += 4) {
    const std::size_t padding = text[at + 3] != '=' ? 0 : text[at + 2] != '=' ? 1 : 2;
    std::int32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t digit =
          i < 4 - padding ? kDigitOf[static_cast<unsigned char>(text[at + i])] : 0;
      if (digit < 0) return at;
      bits = bits << 6 | digit;
    }
    const std::array<char, 3> group = {static_cast<char>(bits >> 16), static_cast<char>(bits >> 8),
                                       static_cast<char>(bits)};
    bytes.append(group.data(), 3 - padding);
  }
  if (bytes.size() > wanted) bytes.resize(wanted);
  return at;
}

/// Bytes of an array in a file, in order, without base64.
class ByteCursor {
 public:
  ByteCursor(const VtkArray& array) : form_(array.form), left_(array.stored) {}

  /// The next bytes; fewer if the array ends. In base64 they are a text of their own.
  std::string take(std::uint64_t count) {
    std::string bytes;
    std::size_t used = 0;
    if (form_ == VtkArray::Form::base64) {
      used = decode_base64(left_, count, bytes);
    } else {
      bytes = left_.substr(0, count);
      used = bytes.size();
    }
    left_.remove_prefix(used);
    return bytes;
  }

  std::size_t left() const { return left_.size(); }

 private:
  VtkArray::Form form_;
  std::string_view left_;
};

std::uint64_t word_at(const std::string& bytes, std::size_t index, const VtkStorage& storage) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < storage.word; ++i) {
    const std::size_t place =
        index * storage.word + (storage.big_endian ? i : storage.word - 1 - i);
    number = number << 8U | static_cast<unsigned char>(bytes[place]);
  }
  return number;
}

/// Blocks of a compressed array.
struct Blocks {
  std::uint64_t size = 0;             ///< unpacked bytes of each block but the last
  std::vector<std::uint64_t> packed;  ///< packed bytes of each block
  std::uint64_t last = 0;             ///< unpacked bytes of the last block
  std::uint64_t characters = 0;       ///< bytes of the file before the blocks

  std::uint64_t unpacked() const { return packed.empty() ? 0 : (packed.size() - 1) * size + last; }
};

Blocks blocks_of(const VtkArray& array, const VtkStorage& storage, const ArrayFailure& fail) {
  const auto words = [&](std::uint64_t count) {
    ByteCursor cursor(array);
    std::string bytes = cursor.take(count * storage.word);
    if (bytes.size() < count * storage.word) fail("is truncated");
    return std::pair(std::move(bytes), array.stored.size() - cursor.left());
  };
  const auto check = [&fail](bool is_possible) {
    if (!is_possible) fail("the sizes of its blocks cannot be true");
  };
  const std::uint64_t size = array.stored.size();
  const std::string head = words(3).first;
  const std::uint64_t count = word_at(head, 0, storage), last = word_at(head, 2, storage);
  Blocks blocks{.size = word_at(head, 1, storage)};
  check(count <= size / storage.word && last <= blocks.size && (count > 0 || last == 0));
  blocks.last = last > 0 ? last : blocks.size;
  const auto [sizes, characters] = words(3 + count);
  blocks.characters = characters;
  std::uint64_t left = size;
  for (std::size_t block = 0; block < count; ++block) {
    const std::uint64_t packed = word_at(sizes, 3 + block, storage);
    const std::uint64_t unpacked = block + 1 == count ? blocks.last : blocks.size;
    check(packed <= left && unpacked / kMostCompressed <= packed);
    left -= packed;
    blocks.packed.push_back(packed);
  }
  return blocks;
}

vtkSmartPointer<vtkDataCompressor> compressor_of(const std::string& name) {
  if (name == "vtkZLibDataCompressor") return vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (name == "vtkLZMADataCompressor") return vtkSmartPointer<vtkLZMADataCompressor>::New();
  return vtkSmartPointer<vtkLZ4DataCompressor>::New();
}

unsigned char* pointer(std::string& bytes) {
  return reinterpret_cast<unsigned char*>(bytes.data());
}

/// Number of base64 characters that encode `bytes` bytes.
std::uint64_t base64_characters(std::uint64_t bytes) {
  return (bytes + 2) / 3 * 4;
}

std::string unpacked(const VtkArray& array, const VtkStorage& storage, const ArrayFailure& fail) {
  const Blocks blocks = blocks_of(array, storage, fail);
  VtkArray behind = array;
  behind.stored.remove_prefix(blocks.characters);
  std::uint64_t packed_size = 0;
  for (const std::uint64_t size : blocks.packed) packed_size += size;
  std::string packed = ByteCursor(behind).take(packed_size);
  if (packed.size() < packed_size) fail("is truncated, or its base64 has gaps");
  std::string bytes(blocks.unpacked(), '\0');
  const SilentVtk silent;
  const auto compressor = compressor_of(storage.compressor);
  std::size_t from = 0, to = 0;
  for (std::size_t block = 0; block < blocks.packed.size(); ++block) {
    const std::size_t size = block + 1 == blocks.packed.size() ? blocks.last : blocks.size;
    const std::size_t found = compressor->Uncompress(pointer(packed) + from, blocks.packed[block],
                                                     pointer(bytes) + to, size);
    if (found != size) fail("block " + std::to_string(block) + " cannot be decompressed");
    from += blocks.packed[block];
    to += size;
  }
  return bytes;
}

/// Bytes of the values.
std::string values_in_bytes(const VtkArray& array, const VtkStorage& storage,
                            const ArrayFailure& fail) {
  if (array.form == VtkArray::Form::bare) return std::string(array.stored);
  if (array.stored.empty()) return "";
  if (!storage.compressor.empty()) return unpacked(array, storage, fail);
  // The size is part of the same base64 text, or a text of its own.
  const std::string size = ByteCursor(array).take(storage.word);
  const std::uint64_t count = word_at(size, 0, storage);
  std::string bytes = ByteCursor(array).take(storage.word + count);
  if (bytes.size() < storage.word + count) fail("is truncated, or its base64 has gaps");
  return bytes.substr(storage.word);
}

template <typename Number>
void append_word(std::string_view word, std::string& bytes, const ArrayFailure& fail) {
  Number number = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  bool is_number = error == std::errc() && end == word.data() + word.size();
  if constexpr (std::is_same_v<Number, float>) {
    // VTK prints numbers below the range of float, which are 0 in single precision.
    double wide = 0;
    if (error == std::errc::result_out_of_range) {
      is_number = std::from_chars(word.data(), end, wide).ec == std::errc();
      number = static_cast<float>(wide);
    }
  }
  if (!is_number) fail("expected a number, found '" + std::string(word.substr(0, 40)) + "'");
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string values_in_text(const VtkArray& array, const ArrayFailure& fail) {
  using Append = void (*)(std::string_view, std::string&, const ArrayFailure&);
  constexpr std::array<Append, kTypes.size()> kAppend = {
      append_word<std::int8_t>,   append_word<std::uint8_t>,  append_word<std::int16_t>,
      append_word<std::uint16_t>, append_word<std::int32_t>,  append_word<std::uint32_t>,
      append_word<std::int64_t>,  append_word<std::uint64_t>, append_word<float>,
      append_word<double>,        append_word<std::uint8_t>};
  const Append append = kAppend[static_cast<std::size_t>(number_type(array.type) - kTypes.data())];
  std::string bytes;
  const std::string_view text = array.stored;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at;
    while (end < text.size() && !ends_word(text[end])) ++end;
    if (end > at) append(text.substr(at, end - at), bytes, fail);
    at = end + 1;
  }
  return bytes;
}

void swap_bytes(std::string& bytes, std::size_t size) {
  for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  }
}

/// One byte for each bit, the first bit of a byte being its highest.
std::string bits_of(const std::string& bytes) {
  std::string bits;
  for (const char byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      bits += static_cast<char>(static_cast<unsigned char>(byte) >> bit & 1);
    }
  }
  return bits;
}

}  // namespace

std::size_t bytes_of_number(std::string_view type) {
  const NumberType* found = number_type(type);
  return found ? found->bytes : 0;
}

std::uint64_t find_end(VtkArray& array, const VtkStorage& storage, const ArrayFailure& fail) {
  using Form = VtkArray::Form;
  const std::size_t left = array.stored.size();
  if (array.form == Form::bare) return left;
  // Each word of text has a character and a space behind it.
  if (array.form == Form::text) return (left / 2 + 1) * bytes_of_number(array.type);
  if (left == 0) return 0;
  std::uint64_t bytes = 0, end = 0;
  if (storage.compressor.empty()) {
    const std::string size = ByteCursor(array).take(storage.word);
    if (size.size() < storage.word) fail("is truncated");
    bytes = word_at(size, 0, storage);
    if (bytes > left) fail("the sizes of its blocks cannot be true");
    if (array.form == Form::raw) {
      end = storage.word + bytes;
    } else {
      // The size is a base64 text of its own if it ends in padding.
      const std::uint64_t before = base64_characters(storage.word);
      end = array.stored[before - 1] == '=' ? before + base64_characters(bytes)
                                            : base64_characters(storage.word + bytes);
    }
  } else {
    const Blocks blocks = blocks_of(array, storage, fail);
    std::uint64_t packed = 0;
    for (const std::uint64_t size : blocks.packed) packed += size;
    end = blocks.characters + (array.form == Form::raw ? packed : base64_characters(packed));
    bytes = blocks.unpacked();
  }
  if (end > left) fail("is truncated");
  array.stored = array.stored.substr(0, end);
  return bytes;
}

vtkSmartPointer<vtkDataArray> decoded(const VtkArray& array, const VtkStorage& storage,
                                      const ArrayFailure& fail) {
  const NumberType& type = *number_type(array.type);
  const bool is_text = array.form == VtkArray::Form::text;
  std::string bytes = is_text ? values_in_text(array, fail) : values_in_bytes(array, storage, fail);
  if (!is_text && array.type == "Bit") bytes = bits_of(bytes);
  if (!is_text && storage.big_endian != (std::endian::native == std::endian::big)) {
    swap_bytes(bytes, type.bytes);
  }
  const std::size_t tuple = type.bytes * static_cast<std::size_t>(array.components);
  if (bytes.size() % tuple != 0 && array.type != "Bit") {
    fail("holds " + std::to_string(bytes.size()) + " bytes, expected a multiple of " +
         std::to_string(tuple));
  }
  auto values = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type.vtk));
  values->SetName(array.name.empty() ? nullptr : array.name.c_str());
  values->SetNumberOfComponents(array.components);
  values->SetNumberOfTuples(static_cast<vtkIdType>(bytes.size() / tuple));
  const auto count = static_cast<std::size_t>(values->GetNumberOfTuples()) * tuple;
  if (count > 0) std::memcpy(values->GetVoidPointer(0), bytes.data(), count);
  return values;
}

std::string data_array_element(vtkDataArray& array, const std::string& compressor) {
  const auto size = static_cast<std::size_t>(array.GetNumberOfValues()) *
                    static_cast<std::size_t>(array.GetDataTypeSize());
  const auto* bytes =
      static_cast<const unsigned char*>(size > 0 ? array.GetVoidPointer(0) : nullptr);
  const auto compress = compressor_of(compressor);
  std::string packed, sizes;
  const auto add_word = [&sizes](std::size_t number) {
    const auto word = static_cast<std::uint32_t>(number);
    sizes.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  add_word((size + kWrittenBlock - 1) / kWrittenBlock);
  add_word(kWrittenBlock);
  add_word(size % kWrittenBlock);
  for (std::size_t first = 0; first < size; first += kWrittenBlock) {
    const std::size_t block = std::min(kWrittenBlock, size - first);
    const std::size_t before = packed.size();
    packed.resize(before + compress->GetMaximumCompressionSpace(block));
    const std::size_t taken =
        compress->Compress(bytes + first, block, pointer(packed) + before, packed.size() - before);
    packed.resize(before + taken);
    add_word(taken);
  }
  const auto in_base64 = [](std::string& given) {
    std::string text(base64_characters(given.size()), '\0');
    vtkBase64Utilities::Encode(pointer(given), given.size(), pointer(text));
    return text;
  };
  std::string element = "<DataArray type=\"" + std::string(name_of_type(array.GetDataType())) +
                        "\" Name=\"" + escaped_for_xml(array.GetName()) + '"';
  const int components = array.GetNumberOfComponents();
  if (components > 1) element += " NumberOfComponents=\"" + std::to_string(components) + '"';
  for (int i = 0; i < components; ++i) {
    if (const char* name = array.GetComponentName(i)) {
      element += " ComponentName" + std::to_string(i) + "=\"" + escaped_for_xml(name) + '"';
    }
  }
  return element + " format=\"binary\">" + in_base64(sizes) + in_base64(packed) + "</DataArray>\n";
}

}  // namespace mimetra
