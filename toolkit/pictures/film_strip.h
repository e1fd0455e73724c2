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
  strip,     ///< a column a frame
  frame,     ///< one frame
  turntable  ///< one frame from all around
};

/// As people choose it.
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

/// What colours a sequence, besides its fields.
enum class StripColor {
  none,
  displacement,  ///< distance from the rest pose
  difference     ///< distance from the row above
};

/// As people choose it.
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

/// Or the field of that name.
using RowColor = std::variant<StripColor, std::string>;

struct StripOptions {
  StripLayout layout = StripLayout::strip;
  /// Of a turntable, and of a strip where `frames` names none; its frames are spread evenly.
  int columns = 8;
  /// Frames shown, 0-based; of StripLayout::frame and a turntable the first one only.
  std::vector<int> frames = {};
  /// What colours each sequence. One for all, or one each.
  std::vector<RowColor> colors = {StripColor::none};
  /// One for each sequence, or none.
  std::vector<std::string> titles = {};
  /// Value of the darkest colour; by default each row's largest.
  std::optional<double> maximum = {};
  Viewpoint viewpoint = {};
  int tile_height = 320;
  int letters = 0;        ///< height of letters, pixels; 0 for what suits the tiles
  std::string unit = {};  ///< of positions
  bool edges = false;     ///< whether those of polygons are drawn

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

/// Sequences as rows of a sheet. A sequence of one frame stands still in all columns. Throws
/// MismatchError that names the row: another number of frames, a field that it does not have (with
/// those it has), a difference from a row with another number of vertices; std::invalid_argument
/// for options out of range.
Sheet film_strip(const std::vector<FieldSequence>& sequences, const StripOptions& options = {});

}  // namespace mimetra
