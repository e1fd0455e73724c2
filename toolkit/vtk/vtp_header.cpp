#include "toolkit/vtk/vtp_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>

#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

/// No compressor of VTK's makes anything smaller than this share.
constexpr std::uint64_t kMostCompressed = 8192;
constexpr std::uint64_t kMostComponents = 4096;

constexpr std::array<std::string_view, 12> kTypes = {"Int8",    "UInt8",   "Int16",  "UInt16",
                                                     "Int32",   "UInt32",  "Int64",  "UInt64",
                                                     "Float32", "Float64", "String", "Bit"};

template <std::size_t size>
bool is_one_of(const std::array<std::string_view, size>& all, std::string_view word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

/// The bytes of base64 text, until it ends or as many are there as are wanted.
std::string decoded(std::string_view text, std::size_t wanted) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (is_blank(c) || c == '\n') continue;
    const auto digit = kDigits.find(c);
    if (digit == std::string_view::npos || bytes.size() >= wanted) break;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xffU);
    }
  }
  return bytes;
}

class VtpHeader {
 public:
  VtpHeader(const std::string& path, std::string_view text)
      : path_(path), text_(text), elements_(xml_elements(path, text)) {}

  void check() {
    check_file(elements_.front());
    for (const XmlElement& element : elements_) {
      if (element.name == "Piece") check_piece(element);
      if (element.name == "DataArray" || element.name == "Array") check_array(element);
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
    word_ = header == "UInt64" ? 8 : 4;
    big_endian_ = order == "BigEndian";
    compressed_ = !compressor.empty();
    most_bytes_ = text_.size() * (compressed_ ? kMostCompressed : 1);
    if (elements_.back().name == "AppendedData") {
      const auto start = text_.find('_', elements_.back().end_of_tag);
      appended_ = start == std::string_view::npos ? text_.size() : start + 1;
      appended_raw_ = elements_.back().attribute("encoding") == "raw";
    }
  }

  /// An attribute that counts something; 0 where it is not there.
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
      // Vertices and faces are numbered by int.
      if (count(piece, key) > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
        fail(std::string(key) + ": " + piece.attribute(key) + " is more than can be numbered");
      }
    }
  }

  void check_array(const XmlElement& array) const {
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
    if (format == "binary") {
      const std::string_view own = text_.substr(array.end_of_tag);
      const std::string_view values = own.substr(0, own.find('<'));
      if (!decoded(values, 1).empty()) check_blocks(array, values, false);
    } else if (format == "appended") {
      const std::uint64_t offset = count(array, "offset");
      if (offset >= text_.size() - std::min(appended_, text_.size())) {
        fail(shown(array) + "its offset " + std::to_string(offset) + " lies behind the file's end");
      }
      check_blocks(array, text_.substr(appended_ + static_cast<std::size_t>(offset)),
                   appended_raw_);
    } else if (!format.empty() && format != "ascii") {
      fail(shown(array) + "no such format as '" + format.substr(0, 40) + "'");
    }
  }

  /// The numbers before binary values: their bytes, or how many blocks of which sizes there are.
  void check_blocks(const XmlElement& array, std::string_view stored, bool is_raw) const {
    const auto lies = [&] { fail(shown(array) + "the sizes of its blocks cannot be true"); };
    const auto words = [&](std::size_t count) {
      const std::string bytes =
          is_raw ? std::string(stored.substr(0, count * word_)) : decoded(stored, count * word_);
      if (bytes.size() < count * word_) fail(shown(array) + "is truncated");
      return bytes;
    };
    const auto word = [this](const std::string& bytes, std::size_t i) {
      std::uint64_t number = 0;
      for (std::size_t j = 0; j < word_; ++j) {
        const std::size_t place = i * word_ + (big_endian_ ? j : word_ - 1 - j);
        number = number << 8U | static_cast<unsigned char>(bytes[place]);
      }
      return number;
    };
    if (!compressed_) {
      if (word(words(1), 0) > stored.size()) lies();
      return;
    }
    const std::uint64_t blocks = word(words(1), 0);
    if (blocks == 0) return;
    if (blocks > stored.size() / word_) lies();
    const std::string bytes = words(3 + static_cast<std::size_t>(blocks));
    const std::uint64_t size = word(bytes, 1), last = word(bytes, 2);
    const std::uint64_t most = kMostCompressed * stored.size();
    if (size > most / blocks || last > size) lies();
    std::uint64_t left = stored.size();
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::uint64_t packed = word(bytes, 3 + i);
      if (packed > left) lies();
      left -= packed;
    }
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<XmlElement> elements_;
  std::size_t word_ = 4;
  bool big_endian_ = false;
  bool compressed_ = false;
  bool appended_raw_ = false;
  std::size_t appended_ = std::numeric_limits<std::size_t>::max();
  std::uint64_t most_bytes_ = 0;
};

}  // namespace

void check_vtp_header(const std::string& path, std::string_view text) {
  VtpHeader(path, text).check();
}

}  // namespace mimetra
