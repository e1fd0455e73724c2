#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/vtk_layout.h"

namespace mimetra {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kLegacyTypes = {{
    {"bit", "Bit"},
    {"char", "Int8"},
    {"signed_char", "Int8"},
    {"unsigned_char", "UInt8"},
    {"short", "Int16"},
    {"unsigned_short", "UInt16"},
    {"int", "Int32"},
    {"unsigned_int", "UInt32"},
    {"long", "Int64"},
    {"unsigned_long", "UInt64"},
    {"vtktypeint64", "Int64"},
    {"vtktypeuint64", "UInt64"},
    {"vtkidtype", "Int32"},  // VTK writes its ids as int
    {"float", "Float32"},
    {"double", "Float64"},
}};

/// Reads a legacy file from its start to its end. Keywords may be in any case.
class LegacyLayout {
 public:
  LegacyLayout(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  VtkLayout layout() {
    if (!line().starts_with("# vtk DataFile Version")) {
      fail("expected '# vtk DataFile Version' in the first line");
    }
    line();  // the title
    const std::string form = keyword();
    if (form != "ascii" && form != "binary") fail("expected ASCII or BINARY, found '" + form + "'");
    form_ = form == "ascii" ? VtkArray::Form::text : VtkArray::Form::bare;
    layout_.storage.big_endian = true;
    layout_.pieces.emplace_back();
    for (std::string word = keyword(); !word.empty(); word = keyword()) add(word);
    if (!has_data_set_) fail("expected DATASET POLYDATA or UNSTRUCTURED_GRID");
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw IoError(path_, "byte " + std::to_string(at_) + ": " + problem);
  }

  std::string_view line() {
    const std::size_t first = at_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    at_ = std::min(end + 1, text_.size());
    std::string_view found = text_.substr(first, end - first);
    if (found.ends_with('\r')) found.remove_suffix(1);
    return found;
  }

  std::string_view word() {
    while (at_ < text_.size() && ends_word(text_[at_])) ++at_;
    const std::size_t first = at_;
    while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }

  std::string keyword() { return lower_case(std::string(word())); }

  /// Next word if it is on this line; empty otherwise.
  std::string_view word_of_line() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ < text_.size() && text_[at_] != '\n' ? word() : std::string_view();
  }

  std::uint64_t count_of(std::string_view word) const {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() ||
        number > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
      fail("expected a count, found '" + std::string(word.substr(0, 40)) + "'");
    }
    return number;
  }
  std::uint64_t count() { return count_of(word()); }

  /// Names are written with %20 for a space.
  std::string name() {
    const std::string_view written = word();
    std::string name;
    for (std::size_t i = 0; i < written.size(); ++i) {
      int code = 0;
      const char* digits = written.data() + i + 1;
      const bool is_code = written[i] == '%' && i + 2 < written.size() &&
                           std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
      name += is_code ? static_cast<char>(code) : written[i];
      if (is_code) i += 2;
    }
    return name;
  }

  std::string type() {
    const std::string word = keyword();
    const auto found =
        std::ranges::find(kLegacyTypes, word, [](const auto& entry) { return entry.first; });
    if (found == kLegacyTypes.end()) fail("type '" + word.substr(0, 40) + "' is not read");
    return std::string(found->second);
  }

  /// Array whose values follow this line.
  VtkArray values(std::string name, const std::string& type, std::uint64_t tuples,
                  std::uint64_t components) {
    if (components == 0 || components > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
      fail("array '" + name + "': expected components");
    VtkArray array{std::move(name), type, static_cast<int>(components), form_, {}};
    // Both are below 2^31.
    const std::uint64_t numbers = tuples * components;
    if (form_ == VtkArray::Form::bare) {
      line();
      const std::uint64_t bytes =
          type == "Bit" ? (numbers + 7) / 8 : numbers * bytes_of_number(type);
      if (numbers > text_.size() * 8 || bytes > text_.size() - at_) fail_truncated(array);
      array.stored = text_.substr(at_, bytes);
      at_ += bytes;
    } else {
      const std::size_t first = at_;
      for (std::uint64_t i = 0; i < numbers; ++i) {
        if (word().empty()) fail_truncated(array);
      }
      array.stored = text_.substr(first, at_ - first);
    }
    return array;
  }

  [[noreturn]] void fail_truncated(const VtkArray& array) const {
    fail("array '" + array.name + "' is truncated");
  }

  void add(const std::string& word) {
    VtkPiece& piece = layout_.pieces.front();
    if (word == "dataset") {
      const std::string kind = keyword();
      if (kind != "polydata" && kind != "unstructured_grid") {
        fail("expected DATASET POLYDATA or UNSTRUCTURED_GRID, found '" + kind.substr(0, 40) + "'");
      }
      layout_.is_grid = kind == "unstructured_grid";
      has_data_set_ = true;
    } else if (word == "points") {
      piece.points = count();
      const std::string kind = type();
      piece.positions = values("Points", kind, piece.points, 3);
    } else if (word == "vertices") {
      piece.verts = cells();
    } else if (word == "lines") {
      piece.lines = cells();
    } else if (word == "polygons") {
      piece.polys = cells();
    } else if (word == "triangle_strips") {
      piece.strips = cells();
    } else if (word == "cells") {
      piece.cells = cells();
    } else if (word == "cell_types") {
      piece.types = values("types", "Int32", count(), 1);
    } else if (word == "metadata") {
      line();
      while (at_ < text_.size() && !line().empty()) {
      }
    } else if (word == "point_data" || word == "cell_data") {
      tuples_ = count();
      attributes_ = word == "point_data" ? &piece.point_data : &piece.cell_data;
    } else {
      add_attribute(word);
    }
  }

  VtkCells cells() {
    VtkCells found{.count = count()};
    const std::uint64_t size = count();
    const std::size_t behind = at_;
    if (keyword() != "offsets") {
      at_ = behind;
      found.are_interleaved = true;
      found.corners = values("connectivity", "Int32", size, 1);
      return found;
    }
    // Version 5.1: as many offsets as cells, and one more.
    const std::string of_ends = type();
    found.ends = values("offsets", of_ends, found.count, 1);
    if (keyword() != "connectivity") fail("expected CONNECTIVITY");
    const std::string of_corners = type();
    found.corners = values("connectivity", of_corners, size, 1);
    found.has_start = true;
    if (found.count > 0) --found.count;
    return found;
  }

  void add_attribute(const std::string& word) {
    if (word == "field") {
      name();
      const std::uint64_t arrays = count();
      auto& target = attributes_ ? *attributes_ : layout_.field_data;
      for (std::uint64_t i = 0; i < arrays; ++i) {
        skip_metadata();
        const std::string own = name();
        const std::uint64_t components = count(), tuples = count();
        const std::string kind = type();
        target.push_back(values(own, kind, tuples, components));
      }
      return;
    }
    if (!attributes_) fail("'" + word.substr(0, 40) + "' is not read");
    const std::string own = name();
    if (word == "scalars") {
      const std::string kind = type();
      const std::string_view components = word_of_line();
      const std::uint64_t columns = components.empty() ? 1 : count_of(components);
      const std::size_t before = at_;
      if (keyword() == "lookup_table") {
        name();
      } else {
        at_ = before;
      }
      attributes_->push_back(values(own, kind, tuples_, columns));
    } else if (word == "color_scalars") {
      const std::uint64_t columns = count();
      attributes_->push_back(values(own, color_type(), tuples_, columns));
    } else if (word == "lookup_table") {
      const std::uint64_t colors = count();
      values(own, color_type(), colors, 4);
    } else if (word == "texture_coordinates") {
      const std::uint64_t columns = count();
      const std::string kind = type();
      attributes_->push_back(values(own, kind, tuples_, columns));
    } else {
      constexpr std::array<std::pair<std::string_view, int>, 7> kColumns = {{{"vectors", 3},
                                                                             {"normals", 3},
                                                                             {"tensors", 9},
                                                                             {"tensors6", 6},
                                                                             {"global_ids", 1},
                                                                             {"pedigree_ids", 1},
                                                                             {"edge_flags", 1}}};
      const auto found =
          std::ranges::find(kColumns, word, [](const auto& entry) { return entry.first; });
      if (found == kColumns.end()) fail("'" + word.substr(0, 40) + "' is not read");
      const std::string kind = type();
      attributes_->push_back(values(own, kind, tuples_, static_cast<std::uint64_t>(found->second)));
    }
  }

  /// Colours are shares from 0 to 1 in text, and bytes in binary files.
  std::string color_type() const { return form_ == VtkArray::Form::text ? "Float32" : "UInt8"; }

  /// Metadata may stand between the arrays of a field.
  void skip_metadata() {
    const std::size_t before = at_;
    if (keyword() != "metadata") {
      at_ = before;
      return;
    }
    add("metadata");
  }

  const std::string& path_;
  std::string_view text_;
  std::size_t at_ = 0;
  bool has_data_set_ = false;
  VtkArray::Form form_ = VtkArray::Form::text;
  std::uint64_t tuples_ = 0;
  std::vector<VtkArray>* attributes_ = nullptr;
  VtkLayout layout_;
};

}  // namespace

VtkLayout legacy_layout(const std::string& path, std::string_view text) {
  return LegacyLayout(path, text).layout();
}

}  // namespace mimetra
