#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/pictures/picture.h"

namespace mimetra {

enum class StripLayout {
  strip,     ///< a column a frame
  turntable  ///< one frame from all around
};

struct StripOptions {
  StripLayout layout = StripLayout::strip;
  /// Columns, where `frames` names none, >= 1; their frames are spread evenly.
  int columns = 8;
  /// Frames shown, 0-based; for a turntable the first one only.
  std::vector<int> frames = {};
  /// For each sequence what colours it: "none", "displacement" (distance from the rest pose),
  /// "difference" (distance from the row above), or a field's name. One for all, or one each.
  std::vector<std::string> colors = {"none"};
  /// One for each sequence, or none.
  std::vector<std::string> titles = {};
  /// Value of the darkest colour; by default each row's largest.
  std::optional<double> maximum = {};
  double yaw = 15;   ///< degrees
  double pitch = 5;  ///< degrees
  bool z_up = false;
  int tile_height = 320;  ///< pixels, >= 16
  int letters = 0;        ///< height of letters, pixels; 0 for what suits the tiles
  std::string unit = {};  ///< of positions
};

/// Sequences as rows of a sheet. A sequence of one frame stands still in all columns. Throws
/// MismatchError that names the row: another number of frames, a field that it does not have (with
/// those it has), a difference from a row with another number of vertices; std::invalid_argument
/// for options out of range.
Sheet film_strip(const std::vector<FieldSequence>& sequences, const StripOptions& options = {});

}  // namespace mimetra
