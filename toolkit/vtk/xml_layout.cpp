#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/vtk_layout.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {
namespace {

constexpr std::uint64_t kMostComponents = 4096;
/// The values of a file may take kUnpackedBytes, or kUnpackedShare times the size of the file,
/// whichever is larger.
constexpr double kUnpackedBytes = 256e6, kUnpackedShare = 64;

template <std::size_t Size>
bool is_one_of(const std::array<std::string_view, Size>& all, std::string_view word) {
  return std::ranges::find(all, word) != all.end();
}

class XmlLayout {
 public:
  XmlLayout(const std::string& path, std::string_view text)
      : path_(path), text_(text), elements_(xml_elements(path, text)) {}

  VtkLayout layout() {
    look_at_root(elements_.front());
    for (const XmlElement& element : elements_) {
      if (element.name == "Piece") {
        add_piece(element);
      } else if (element.name == "DataArray" && element.attribute("type") != "String") {
        add_array(element);
      }
    }
    if (unpacked_ > std::max(kUnpackedBytes, kUnpackedShare * static_cast<double>(text_.size()))) {
      fail("its arrays would take more than " + readable(unpacked_ / 1e6, 3) +
           " MB, which a file of " + std::to_string(text_.size()) + " bytes cannot mean");
    }
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw IoError(path_, problem); }

  static std::string shown(const XmlElement& element) {
    const std::string name = element.attribute("Name");
    return element.parent + (name.empty() ? "" : ", array '" + name + "'") + ": ";
  }

  void look_at_root(const XmlElement& root) {
    const std::string type = root.attribute("type");
    if (root.name != "VTKFile" || (type != "PolyData" && type != "UnstructuredGrid")) {
      fail("expected a VTKFile of type PolyData or UnstructuredGrid, found " +
           (root.name == "VTKFile" ? "type '" + type + "'" : "<" + root.name + ">"));
    }
    layout_.is_grid = type == "UnstructuredGrid";
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
    if (!is_one_of(kCompressors, compressor)) fail("compressor '" + compressor + "' is unknown");
    layout_.storage = {header == "UInt64" ? 8U : 4U, order == "BigEndian", compressor};
    if (elements_.back().name == "AppendedData") {
      const auto start = text_.find('_', elements_.back().end_of_tag);
      appended_ = text_.substr(start == std::string_view::npos ? text_.size() : start + 1);
      appended_form_ = elements_.back().attribute("encoding") == "raw" ? VtkArray::Form::raw
                                                                       : VtkArray::Form::base64;
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
    // mimetra numbers vertices and faces by int.
    if (number > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
      fail(shown(element) + key + ": " + text + " is more than can be numbered");
    }
    return number;
  }

  void add_piece(const XmlElement& element) {
    VtkPiece piece{.points = count(element, "NumberOfPoints")};
    piece.verts.count = count(element, "NumberOfVerts");
    piece.lines.count = count(element, "NumberOfLines");
    piece.strips.count = count(element, "NumberOfStrips");
    piece.polys.count = count(element, "NumberOfPolys");
    piece.cells.count = count(element, "NumberOfCells");
    layout_.pieces.push_back(std::move(piece));
  }

  void add_array(const XmlElement& element) {
    VtkArray array = stored(element);
    if (element.parent == "FieldData") {
      layout_.field_data.push_back(std::move(array));
      return;
    }
    if (layout_.pieces.empty()) fail(shown(element) + "is outside of all pieces");
    VtkPiece& piece = layout_.pieces.back();
    const auto add_to = [&array](VtkCells& cells) {
      if (array.name == "connectivity") cells.corners = array;
      if (array.name == "offsets") cells.ends = array;
    };
    if (element.parent == "PointData") piece.point_data.push_back(array);
    if (element.parent == "CellData") piece.cell_data.push_back(array);
    if (element.parent == "Points") piece.positions = array;
    if (element.parent == "Verts") add_to(piece.verts);
    if (element.parent == "Lines") add_to(piece.lines);
    if (element.parent == "Strips") add_to(piece.strips);
    if (element.parent == "Polys") add_to(piece.polys);
    if (element.parent == "Cells") add_to(piece.cells);
    if (element.parent == "Cells" && array.name == "types") piece.types = array;
  }

  VtkArray stored(const XmlElement& element) {
    VtkArray array{.name = element.attribute("Name"), .type = element.attribute("type")};
    const std::string format = element.attribute("format");
    if (bytes_of_number(array.type) == 0) {
      fail(shown(element) + "type '" + array.type + "' is unknown");
    }
    const std::uint64_t components = count(element, "NumberOfComponents");
    if (components > kMostComponents) {
      fail(shown(element) + "NumberOfComponents: " + std::to_string(components) + " is more than " +
           std::to_string(kMostComponents));
    }
    array.components = static_cast<int>(std::max<std::uint64_t>(components, 1));
    if (format == "appended") {
      const std::uint64_t offset = count(element, "offset");
      if (offset >= appended_.size()) {
        fail(shown(element) + "its offset " + std::to_string(offset) + " is behind the file's end");
      }
      array.form = appended_form_;
      array.stored = appended_.substr(offset);
    } else if (format == "binary") {
      array.form = VtkArray::Form::base64;
      array.stored = element.text;
    } else if (format.empty() || format == "ascii") {
      array.stored = element.text;
    } else {
      fail(shown(element) + "format '" + format.substr(0, 40) + "' is unknown");
    }
    unpacked_ +=
        static_cast<double>(find_end(array, layout_.storage, [&](const std::string& problem) {
          fail(shown(element) + problem);
        }));
    return array;
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<XmlElement> elements_;
  VtkLayout layout_;
  std::string_view appended_;
  VtkArray::Form appended_form_ = VtkArray::Form::raw;
  double unpacked_ = 0;  ///< bytes of the decoded arrays so far
};

}  // namespace

VtkLayout xml_layout(const std::string& path, std::string_view text) {
  return XmlLayout(path, text).layout();
}

}  // namespace mimetra
