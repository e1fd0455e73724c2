#include "toolkit/drawing/sheet_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr double kSpaceAround = 1.05;
/// Height of letters in pixels for tiles of this height: a fraction of it, smaller for large tiles,
/// but always readable.
int letters_for(int tile_height) {
  constexpr int kSmallest = 12;
  return std::max(kSmallest, std::min(tile_height / 18, kSmallest + tile_height / 60));
}

/// Vertices of each row that triangles use. Stray points do not affect the scale of the meshes.
using SeenVertices = std::vector<std::vector<VertexIndex>>;

SeenVertices seen_vertices(const Sheet& sheet) {
  SeenVertices seen;
  for (const TileRow& row : sheet.rows) {
    seen.push_back(used_vertices(row.connectivity->triangles, row.connectivity->vertices));
  }
  return seen;
}

/// Half the width and height that all tiles need in their views.
Eigen::Vector2d half_extent(const Sheet& sheet, const SeenVertices& seen,
                            const std::vector<Eigen::RowVector3d>& centers) {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    for (const Tile& tile : sheet.rows[row].tiles) {
      const View view = view_of(sheet.viewpoint, tile.turn);
      const Positions centered = tile.positions(seen[row], Eigen::all).rowwise() - centers[row];
      half[0] = std::max(half[0], (centered * view.right).cwiseAbs().maxCoeff());
      half[1] = std::max(half[1], (centered * view.up).cwiseAbs().maxCoeff());
    }
  }
  return half;
}

double reach_of(const Sheet& sheet, const SeenVertices& seen,
                const std::vector<Eigen::RowVector3d>& centers) {
  double reach = 0;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    for (const Tile& tile : sheet.rows[row].tiles) {
      const Positions centered = tile.positions(seen[row], Eigen::all).rowwise() - centers[row];
      reach = std::max(reach, centered.rowwise().norm().maxCoeff());
    }
  }
  return reach;
}

}  // namespace

View view_of(const Viewpoint& viewpoint, double turn) {
  const double yaw = (viewpoint.yaw + turn) * std::numbers::pi / 180;
  const double pitch = viewpoint.pitch * std::numbers::pi / 180;
  View view;
  view.right = {std::cos(yaw), 0, -std::sin(yaw)};
  view.towards_eye = {std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                      std::cos(pitch) * std::cos(yaw)};
  view.up = view.towards_eye.cross(view.right);
  if (viewpoint.up == UpAxis::z) {
    for (Eigen::Vector3d* axis : {&view.right, &view.up, &view.towards_eye}) {
      *axis = Eigen::Vector3d(axis->x(), -axis->z(), axis->y());
    }
  }
  return view;
}

SheetLayout SheetLayout::of(const Sheet& sheet) {
  SheetLayout layout;
  std::size_t columns = 0;
  const SeenVertices seen = seen_vertices(sheet);
  for (std::size_t r = 0; r < sheet.rows.size(); ++r) {
    const TileRow& row = sheet.rows[r];
    if (row.tiles.empty()) throw std::invalid_argument("a row of a sheet has no tile");
    const Positions first = row.tiles.front().positions(seen[r], Eigen::all);
    layout.centers.push_back((first.colwise().minCoeff() + first.colwise().maxCoeff()) / 2);
    columns = std::max(columns, row.tiles.size());
  }
  if (sheet.rows.empty()) throw std::invalid_argument("a sheet has no row");
  layout.reach = reach_of(sheet, seen, layout.centers);
  if (!(layout.reach > 0)) {
    throw MismatchError("all vertices are at one place, so that there is nothing to draw");
  }
  const Eigen::Vector2d half = kSpaceAround * half_extent(sheet, seen, layout.centers);
  const double aspect = std::clamp(half[0] / half[1], 0.5, 2.0);
  layout.half_height = std::max(half[1], half[0] / aspect);
  layout.tile_height = sheet.tile_height;
  layout.tile_width = static_cast<int>(std::ceil(aspect * sheet.tile_height));
  layout.text = sheet.letters > 0 ? sheet.letters : letters_for(sheet.tile_height);
  layout.margin = layout.text;
  const int line = 2 * layout.text;
  const auto has_title = [](const TileRow& row) { return !row.title.empty(); };
  layout.column_title = sheet.column_titles.empty() ? 0 : line;
  layout.row_title = std::ranges::any_of(sheet.rows, has_title) ? line : 0;
  const auto has_tile_titles = [](const TileRow& row) {
    return std::ranges::any_of(row.tiles, [](const Tile& tile) { return !tile.title.empty(); });
  };
  layout.tile_title = std::ranges::any_of(sheet.rows, has_tile_titles) ? line : 0;
  double beside = 0;  // in letter heights
  for (const TileRow& row : sheet.rows) {
    if (row.bar) beside = std::max(beside, 8.0);
    if (row.legend.entries.empty()) continue;
    beside = std::max(beside, 1 + kLegendColumn * layout.legend_columns(row.legend));
    beside = std::max(beside, 2 + 0.6 * static_cast<double>(row.legend.name.size()));
  }
  layout.width = 2 * layout.margin + static_cast<int>(columns) * layout.tile_width +
                 static_cast<int>(std::ceil(beside * layout.text));
  const Box last = layout.tile(sheet.rows.size() - 1, 0);
  layout.height = last.top + last.height + 2 * layout.text;
  return layout;
}

int SheetLayout::legend_lines() const {
  return std::max(1, static_cast<int>((tile_height - 2 * text) / (kLegendLine * text)));
}

int SheetLayout::legend_columns(const Legend& legend) const {
  return (static_cast<int>(legend.entries.size()) + legend_lines() - 1) / legend_lines();
}

Box SheetLayout::tile(std::size_t row, std::size_t column) const {
  const int above = row_title + tile_title, row_height = above + tile_height;
  return {margin + static_cast<int>(column) * tile_width,
          margin + column_title + static_cast<int>(row) * row_height + above, tile_width,
          tile_height};
}

double round_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= length) return factor * power;
  }
  return power;
}

}  // namespace mimetra
