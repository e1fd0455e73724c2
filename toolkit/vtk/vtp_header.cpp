#include "toolkit/vtk/vtp_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/silent_vtk.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

/// How a .vtp file stores the bytes of its arrays.
struct VtpStorage {
  std::size_t word = 4;  ///< bytes of each number before the values: block counts and sizes
  bool big_endian = false;
  std::string compressor = {};  ///< name of a VTK class; empty if not compressed
};

/// Numbers before the values of a compressed array: number of blocks, size of a block, and size of
/// the last block if it is smaller (otherwise 0).
struct VtpBlocks {
  std::uint64_t count, size, last;

  std::uint64_t bytes() const {
    return count == 0 ? 0 : count * size - (last > 0 ? size - last : 0);
  }
};

/// Values of one array as stored in the file. \pre check_blocks() accepts the sizes before at() is
/// called.
class StoredValues {
 public:
  enum class Form { text, base64, raw };

  /// `stored` starts with the array and may continue after it. `type` is the file's, such as
  /// "Int32".
  StoredValues(const VtpStorage& storage, std::string type, std::string_view stored, Form form);

  /// Bytes of the first `count` numbers before the values, fewer if the array ends.
  std::string words(std::size_t count) const;
  /// Number `index` of words().
  std::uint64_t word(const std::string& words, std::size_t index) const;
  /// Blocks of a compressed array, or nothing if the array ends too early.
  std::optional<VtpBlocks> blocks() const;

  /// Returns whether the file holds as many bytes as the numbers before the values say. Always true
  /// for text.
  bool are_all_there() const;
  /// Upper bound on the number of values.
  std::uint64_t most() const;
  /// Value `index`, or nothing if there are fewer values or the bytes are malformed.
  std::optional<double> at(std::uint64_t index) const;

 private:
  std::string bytes(std::uint64_t first, std::size_t count) const;
  std::uint64_t numbers_in_text() const;
  std::optional<double> in_text(std::uint64_t index) const;
  std::string unpacked(std::uint64_t first, std::size_t count) const;
  double number(std::string bytes) const;

  const VtpStorage& storage_;
  std::string type_;
  std::string_view stored_;
  Form form_;
};

std::string_view without_margins(std::string_view text) {
  while (!text.empty() && ends_word(text.front())) text.remove_prefix(1);
  while (!text.empty() && ends_word(text.back())) text.remove_suffix(1);
  return text;
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

/// Appends the one to three bytes that four base64 characters encode. Returns false if a character
/// is not base64.
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

/// Decodes base64 text from character `begin` on, up to `wanted` bytes. Like VTK, expects groups of
/// four characters without gaps, each with its own padding.
std::string decoded(std::string_view text, std::uint64_t begin, std::uint64_t wanted) {
  text = without_margins(text);
  std::string bytes;
  for (std::uint64_t i = begin; i + 4 <= text.size() && bytes.size() < wanted; i += 4) {
    if (!decode_group(text.substr(i, 4), bytes)) break;
  }
  if (bytes.size() > wanted) bytes.resize(wanted);
  return bytes;
}

/// Number of base64 characters that encode `bytes` bytes, including padding.
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

/// Bytes of a value, or 0 for String and Bit.
std::size_t size_of(const std::string& type) {
  if (type == "String" || type == "Bit") return 0;
  if (type.ends_with("64")) return 8;
  if (type.ends_with("32")) return 4;
  return type.ends_with("16") ? 2 : 1;
}

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
  std::uint64_t begin = 0;  // start of the blocks, which base64 encodes separately
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
    if (!ends_word(stored_[i]) && (i == 0 || ends_word(stored_[i - 1]))) ++count;
  }
  return count;
}

std::optional<double> StoredValues::in_text(std::uint64_t index) const {
  const char* at = stored_.data();
  const char* const end = at + stored_.size();
  while (true) {
    while (at != end && ends_word(*at)) ++at;
    if (at != end && *at == '+') ++at;
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc()) return {};
    if (index-- == 0) return number;
    at = next;
  }
}

/// Bytes of an uncompressed array. `first` counts from the number before the values.
std::string StoredValues::bytes(std::uint64_t first, std::size_t count) const {
  if (form_ == Form::raw) {
    return first < stored_.size() ? std::string(stored_.substr(first, count)) : "";
  }
  const std::string all = decoded(stored_, 0, first + count);
  return first < all.size() ? all.substr(first, count) : "";
}

/// Bytes of a compressed array. Unpacks only the block that contains them.
std::string StoredValues::unpacked(std::uint64_t first, std::size_t count) const {
  const auto all = blocks();
  if (!all || all->count == 0 || all->size == 0) return "";
  const auto head = static_cast<std::size_t>(3 + all->count);
  const std::string sizes = words(head);
  if (sizes.size() < head * storage_.word) return "";
  const std::uint64_t block = first / all->size;
  if (block >= all->count) return "";
  // VTK splits arrays into blocks. It does not write a large block for a few values.
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
    // The blocks are one base64 text after the text of the sizes.
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

/// Upper bound on the compression ratio of VTK's compressors.
constexpr std::uint64_t kMostCompressed = 8192;
constexpr std::uint64_t kMostComponents = 4096;
/// The values of a file may take kUnpackedBytes, or kUnpackedShare times the size of the file,
/// whichever is larger.
constexpr double kUnpackedBytes = 256e6, kUnpackedShare = 64;
/// VTK's time grows with the square of an element's number of attributes. VTK writes up to 10.
constexpr std::size_t kMostAttributes = 100;

constexpr std::array<std::string_view, 4> kCells = {"Verts", "Lines", "Strips", "Polys"};
constexpr std::array<std::string_view, 12> kTypes = {"Int8",    "UInt8",   "Int16",  "UInt16",
                                                     "Int32",   "UInt32",  "Int64",  "UInt64",
                                                     "Float32", "Float64", "String", "Bit"};

template <std::size_t Size>
bool is_one_of(const std::array<std::string_view, Size>& all, std::string_view word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

/// Arrays of one kind of cells of a piece, as far as they have been read.
struct Cells {
  std::string name;  ///< "Polys"; empty for none
  std::uint64_t count = 0;
  std::optional<std::uint64_t> corners = {};  ///< upper bound
  std::optional<double> end = {};             ///< offset of the last cell's end
};

class VtpHeader {
 public:
  VtpHeader(const std::string& path, std::string_view text)
      : path_(path), text_(text), elements_(xml_elements(path, text)) {}

  void check() {
    check_file(elements_.front());
    const XmlElement* piece = nullptr;
    Cells cells;
    for (const XmlElement& element : elements_) {
      if (element.attributes.size() > kMostAttributes) {
        fail(element.name + " has " + std::to_string(element.attributes.size()) +
             " attributes, expected at most " + std::to_string(kMostAttributes));
      }
      if (element.name == "Piece") {
        check_piece(element);
        piece = &element;
      }
      if (piece && is_one_of(kCells, element.name)) {
        cells = {element.name, count(*piece, "NumberOf" + element.name)};
      }
      if (element.name != "DataArray" && element.name != "Array") continue;
      const auto values = checked_array(element);
      if (values && element.parent == cells.name && cells.count > 0) {
        check_cells(cells, element.attribute("Name"), *values);
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw IoError(path_, problem); }

  static std::string shown(const XmlElement& element) {
    const std::string name = element.attribute("Name");
    return element.parent + (name.empty() ? "" : ", array '" + name + "'") + ": ";
  }

  void check_file(const XmlElement& root) {
    if (root.name != "VTKFile" || root.attribute("type") != "PolyData") {
      fail("expected a VTKFile of the type PolyData, found " +
           (root.name == "VTKFile" ? "the type '" + root.attribute("type") + "'"
                                   : "<" + root.name + ">"));
    }
    const std::string header = root.attribute("header_type");
    const std::string order = root.attribute("byte_order");
    const std::string compressor = root.attribute("compressor");
    if (!header.empty() && header != "UInt32" && header != "UInt64") {
      fail("header_type: expected UInt32 or UInt64, found '" + header + "'");
    }
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian") {
      fail("byte_order: expected LittleEndian or BigEndian, found '" + order + "'");
    }
    constexpr std::array<std::string_view, 4> kCompressors = {
        "", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};
    if (!is_one_of(kCompressors, compressor)) fail("no such compressor as '" + compressor + "'");
    storage_ = {header == "UInt64" ? 8U : 4U, order == "BigEndian", compressor};
    most_bytes_ = text_.size() * (compressor.empty() ? 1 : kMostCompressed);
    if (elements_.back().name == "AppendedData") {
      const auto start = text_.find('_', elements_.back().end_of_tag);
      appended_ = start == std::string_view::npos ? text_.size() : start + 1;
      appended_raw_ = elements_.back().attribute("encoding") == "raw";
    }
  }

  /// Value of an attribute that is a count, or 0 if the attribute is missing.
  std::uint64_t count(const XmlElement& element, const std::string& key) const {
    const std::string text = element.attribute(key);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty()) return 0;
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(shown(element) + key + ": expected a count, found '" + text.substr(0, 40) + "'");
    }
    if (number > most_bytes_) {
      fail(shown(element) + key + ": " + text + " is more than the file's " +
           std::to_string(text_.size()) + " bytes can hold");
    }
    return number;
  }

  void check_piece(const XmlElement& piece) const {
    for (const char* key :
         {"NumberOfPoints", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"}) {
      // mimetra numbers vertices and faces by int.
      if (count(piece, key) > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
        fail(std::string(key) + ": " + piece.attribute(key) + " is more than can be numbered");
      }
    }
  }

  /// Throws IoError if the offsets end beyond the corners. VTK does not check this before it reads
  /// them.
  void check_cells(Cells& cells, const std::string& name, const StoredValues& values) const {
    if (name == "connectivity") cells.corners = values.most();
    if (name == "offsets") {
      cells.end = values.at(cells.count - 1);
      if (!cells.end) {
        fail(cells.name + ", array 'offsets': expected " + std::to_string(cells.count) +
             " numbers, found fewer");
      }
    }
    if (!cells.corners || !cells.end) return;
    if (*cells.end >= 0 && *cells.end <= static_cast<double>(*cells.corners)) return;
    fail(cells.name + ", array 'offsets': ends at " + fixed(*cells.end, 0) + ", and there are " +
         std::to_string(*cells.corners) + " corners at most");
  }

  /// Checks an array and returns its values, or nothing if a binary array is empty.
  std::optional<StoredValues> checked_array(const XmlElement& array) {
    using Form = StoredValues::Form;
    const std::string type = array.attribute("type"), format = array.attribute("format");
    if (!is_one_of(kTypes, type)) fail(shown(array) + "no such type as '" + type + "'");
    const std::uint64_t components = count(array, "NumberOfComponents");
    const std::uint64_t tuples = count(array, "NumberOfTuples");
    if (components > kMostComponents ||
        std::max<std::uint64_t>(components, 1) * tuples > most_bytes_) {
      fail(shown(array) + std::to_string(tuples) + " x " + std::to_string(components) +
           " values are more than the file's " + std::to_string(text_.size()) + " bytes can hold");
    }
    if (array.parent == "Points" && components != 3) {
      fail(shown(array) + "expected 3 components, found " + std::to_string(components));
    }
    if (format == "appended") {
      const std::uint64_t offset = count(array, "offset");
      if (offset >= text_.size() - std::min(appended_, text_.size())) {
        fail(shown(array) + "its offset " + std::to_string(offset) + " lies behind the file's end");
      }
      const std::string_view stored = text_.substr(appended_ + static_cast<std::size_t>(offset));
      const StoredValues values(storage_, type, stored, appended_raw_ ? Form::raw : Form::base64);
      check_blocks(array, values, stored.size());
      return values;
    }
    const std::string_view own = text_.substr(array.end_of_tag);
    const std::string_view stored = own.substr(0, own.find('<'));
    if (format.empty() || format == "ascii") {
      return StoredValues(storage_, type, stored, Form::text);
    }
    if (format != "binary") {
      fail(shown(array) + "no such format as '" + format.substr(0, 40) + "'");
    }
    const StoredValues values(storage_, type, stored, Form::base64);
    if (stored.find_first_not_of(" \t\r\n") == std::string_view::npos) return {};
    check_blocks(array, values, stored.size());
    return values;
  }

  /// Checks the numbers before binary values: their size in bytes, or the number and sizes of
  /// blocks.
  void check_blocks(const XmlElement& array, const StoredValues& values, std::size_t size) {
    const auto lies = [&] { fail(shown(array) + "the sizes of its blocks cannot be true"); };
    const auto words = [&](std::size_t count) {
      const std::string bytes = values.words(count);
      if (bytes.size() < count * storage_.word) fail(shown(array) + "is truncated");
      return bytes;
    };
    if (storage_.compressor.empty()) {
      if (values.word(words(1), 0) > size) lies();
      check_bytes(array, values);
      return;
    }
    words(3);
    const VtpBlocks blocks = *values.blocks();
    if (blocks.count == 0 && blocks.last > 0) lies();
    if (blocks.count == 0) return;
    if (blocks.count > size / storage_.word) lies();
    const std::string bytes = words(3 + static_cast<std::size_t>(blocks.count));
    if (blocks.size > kMostCompressed * size / blocks.count || blocks.last > blocks.size) lies();
    std::uint64_t left = size;
    for (std::size_t i = 0; i < blocks.count; ++i) {
      const std::uint64_t packed = values.word(bytes, 3 + i);
      const std::uint64_t unpacked =
          i + 1 == blocks.count && blocks.last > 0 ? blocks.last : blocks.size;
      if (packed > left || unpacked / kMostCompressed > packed) lies();
      left -= packed;
      unpacked_ += static_cast<double>(unpacked);
    }
    if (unpacked_ > std::max(kUnpackedBytes, kUnpackedShare * static_cast<double>(text_.size()))) {
      fail("its arrays would take more than " + readable(unpacked_ / 1e6, 3) +
           " MB, which a file of " + std::to_string(text_.size()) + " bytes cannot mean");
    }
    check_bytes(array, values);
  }

  /// Throws IoError if bytes are missing. VTK stops silently at a gap in base64 and leaves the
  /// remaining values unset.
  void check_bytes(const XmlElement& array, const StoredValues& values) const {
    if (values.are_all_there()) return;
    fail(shown(array) + "is truncated, or its base64 has gaps or other characters");
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<XmlElement> elements_;
  VtpStorage storage_;
  bool appended_raw_ = false;
  std::size_t appended_ = std::numeric_limits<std::size_t>::max();
  std::uint64_t most_bytes_ = 0;
  double unpacked_ = 0;  ///< unpacked bytes of the compressed arrays so far
};

}  // namespace

void check_vtp_header(const std::string& path, std::string_view text) {
  VtpHeader(path, text).check();
}

}  // namespace mimetra
