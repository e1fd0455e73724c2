#include "toolkit/vtk/vtp_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/vtp_values.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

/// No compressor of VTK's makes anything smaller than this share.
constexpr std::uint64_t kMostCompressed = 8192;
constexpr std::uint64_t kMostComponents = 4096;
/// Values of a whole file may take this much, or so many times the file.
constexpr double kUnpackedBytes = 256e6, kUnpackedShare = 64;
/// VTK's time grows with the square of an element's attributes; it writes up to 10.
constexpr std::size_t kMostAttributes = 100;

constexpr std::array<std::string_view, 4> kCells = {"Verts", "Lines", "Strips", "Polys"};
constexpr std::array<std::string_view, 12> kTypes = {"Int8",    "UInt8",   "Int16",  "UInt16",
                                                     "Int32",   "UInt32",  "Int64",  "UInt64",
                                                     "Float32", "Float64", "String", "Bit"};

template <std::size_t Size>
bool is_one_of(const std::array<std::string_view, Size>& all, std::string_view word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

/// The arrays of one kind of cells of a piece, as far as they have been seen.
struct Cells {
  std::string name;  ///< "Polys"; empty for none
  std::uint64_t count = 0;
  std::optional<std::uint64_t> corners = {};  ///< at most
  std::optional<double> end = {};             ///< that the last cell's offset tells
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

  /// VTK asks for as many corners as the last offset says, without looking whether they are there.
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

  /// Its values; nothing where there are none.
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

  /// The numbers before binary values: their bytes, or how many blocks of which sizes there are.
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

  /// VTK stops without a word where base64 has gaps, and leaves the values behind as they are.
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
  double unpacked_ = 0;  ///< bytes of the values of compressed arrays so far
};

}  // namespace

void check_vtp_header(const std::string& path, std::string_view text) {
  VtpHeader(path, text).check();
}

}  // namespace mimetra
