#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "toolkit/drawing/picture.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

enum class StripLayout {
  strip,     ///< one column per frame
  frame,     ///< a single frame
  turntable  ///< a single frame from all around
};

constexpr std::string_view choice_name(StripLayout value) {
  switch (value) {
    case StripLayout::strip:
      return "strip";
    case StripLayout::frame:
      return "frame";
    case StripLayout::turntable:
      return "turntable";
  }
  return {};
}

/// Colouring of a sequence, besides its fields.
enum class StripColor {
  none,
  displacement,  ///< distance from the rest pose
  difference     ///< distance from the row above
};

constexpr std::string_view choice_name(StripColor value) {
  switch (value) {
    case StripColor::none:
      return "none";
    case StripColor::displacement:
      return "displacement";
    case StripColor::difference:
      return "difference";
  }
  return {};
}

/// A measured colour, or the name of a field.
using RowColor = std::variant<StripColor, std::string>;

struct StripOptions {
  StripLayout layout = StripLayout::strip;
  /// Columns of a turntable, or of a strip without `frames`, whose frames are then spread evenly.
  int columns = 8;
  /// Frames shown, 0-based. StripLayout::frame and StripLayout::turntable use only the first.
  std::vector<int> frames = {};
  /// Colouring of each sequence: one for all, or one for each.
  std::vector<RowColor> colors = {StripColor::none};
  /// Title of each sequence, or empty.
  std::vector<std::string> titles = {};
  /// Value of the darkest colour; by default the largest of each row.
  std::optional<double> maximum = {};
  Viewpoint viewpoint = {};
  int tile_height = 320;
  int letters = 0;        ///< height of letters, pixels; 0 to fit the tiles
  std::string unit = {};  ///< unit of the positions
  bool edges = false;     ///< whether edges of polygons are drawn

  static constexpr Option kLayout{"layout", &StripOptions::layout};
  static constexpr Option kColumns{
      "columns", &StripOptions::columns, {.minimum = 1, .maximum = 100}};
  static constexpr Option kFrames{"frames", &StripOptions::frames, {.minimum = 0}};
  static constexpr Option kMaximum{"maximum", &StripOptions::maximum, {.minimum = 1e-300}};
  static constexpr Option kTileHeight{
      "tile_height", &StripOptions::tile_height, {.minimum = 16, .maximum = 4096}, "pixels"};
  static constexpr Option kLetters{"letters", &StripOptions::letters, {.minimum = 0}, "pixels"};
  static constexpr Option kUnit{"unit", &StripOptions::unit};
  static constexpr Option kEdges{"edges", &StripOptions::edges};
  static constexpr auto declared() {
    return std::tuple(kLayout, kColumns, kFrames, kMaximum, kTileHeight, kLetters, kEdges);
  }
};

/// Arranges sequences as rows of a sheet. A sequence of one frame repeats in all columns. Throws
/// MismatchError that names the row for another number of frames or an unknown field (with the
/// known ones). Throws it also for a difference from a row with another number of vertices, or if a
/// requested frame does not exist. Throws std::invalid_argument for options out of range.
Sheet film_strip(const std::vector<FieldSequence>& sequences, const StripOptions& options = {});

}  // namespace mimetra
