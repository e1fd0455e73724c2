#pragma once

#include <vector>

#include <Eigen/Core>

#include "toolkit/drawing/picture.h"

namespace mimetra {

/// Pixels from the upper left corner.
struct Box {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// Direction from which a tile is seen: three orthogonal unit vectors.
struct View {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  Eigen::Vector3d towards_eye;
};

/// View of a tile; `turn` is about the upright axis, in degrees.
View view_of(const Viewpoint& viewpoint, double turn = 0);

/// Positions and sizes of everything in a sheet.
struct SheetLayout {
  int width = 0;  ///< pixels of the whole picture
  int height = 0;
  int margin = 0;
  int text = 0;          ///< height of letters
  int column_title = 0;  ///< height of the line above all rows
  int row_title = 0;     ///< height of the line above each row
  int tile_title = 0;    ///< height of the line above each tile
  int tile_width = 0;
  int tile_height = 0;
  double half_height = 0;                   ///< half a tile's height in the unit of the positions
  double reach = 0;                         ///< maximum distance of a vertex from its row's centre
  std::vector<Eigen::RowVector3d> centers;  ///< middle of each row's first tile

  /// Throws std::invalid_argument if a row has no tile or there is no row, and MismatchError if all
  /// vertices of the meshes coincide.
  static SheetLayout of(const Sheet& sheet);

  Box tile(std::size_t row, std::size_t column) const;
  double pixels_per_unit() const { return tile_height / (2 * half_height); }
  /// Lines and columns of a legend beside a row. A line is kLegendLine and a column kLegendColumn
  /// times the height of letters.
  int legend_lines() const;
  int legend_columns(const Legend& legend) const;
  static constexpr double kLegendColumn = 2.6, kLegendLine = 1.35;
};

/// Largest of 1, 2 and 5 times a power of ten that is at most `length` > 0.
double round_length(double length);

}  // namespace mimetra
