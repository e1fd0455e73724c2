#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/operations/colors.h"

namespace mimetra {

/// What the colours of a row mean: even_color over [minimum, maximum].
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  std::string unit;  ///< written after the maximum
};

/// One mesh in a sheet.
struct Tile {
  Positions positions;        ///< N x 3
  std::vector<Color> colors;  ///< per vertex (N), or none for kClay
  double turn = 0;            ///< degrees about the upright axis, besides the sheet's
  std::string title = {};     ///< above it
};

struct TileRow {
  std::string title;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Tile> tiles;
  std::optional<ColorBar> bar;
};

/// Meshes in rows and columns, all at one scale and seen from one side without perspective, so that
/// one scale bar holds for all of them.
struct Sheet {
  std::vector<TileRow> rows;
  std::vector<std::string> column_titles;
  double yaw = 0;         ///< degrees; 0 looks at what faces +z (-y where z is up)
  double pitch = 0;       ///< degrees; positive looks from above
  bool z_up = false;      ///< else y
  int tile_height = 320;  ///< pixels
  int letters = 0;        ///< height of letters, pixels; 0 for what suits the tiles
  std::string unit;       ///< of positions, written at the scale bar
};

/// Largest width and height of a picture.
constexpr int kLargestPicture = 16384;

}  // namespace mimetra
