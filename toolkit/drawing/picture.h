#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/operations/colors.h"
#include "toolkit/operations/image.h"

namespace mimetra {

/// From where meshes are seen.
struct Viewpoint {
  /// 0 looks at what faces +z (-y where z is up).
  double yaw = 15;
  /// Positive looks from above.
  double pitch = 5;
  UpAxis up = UpAxis::y;

  static constexpr Option kYaw{
      "yaw", &Viewpoint::yaw, {.minimum = -360, .maximum = 360}, "degrees"};
  static constexpr Option kPitch{
      "pitch", &Viewpoint::pitch, {.minimum = -90, .maximum = 90}, "degrees"};
  static constexpr Option kUp{"up", &Viewpoint::up};
  static constexpr auto declared() { return std::tuple(kYaw, kPitch, kUp); }
};

/// What the colours of a row mean: even_color over [minimum, maximum].
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  std::string unit;       ///< written after the maximum
  std::string name = {};  ///< of the values, above it
};

/// What the colours of a row mean that stand for numbers.
struct Legend {
  struct Entry {
    int number;
    Color color;
  };
  std::string name;  ///< of the numbers, above them
  std::vector<Entry> entries;
};

/// Letters on a mesh.
struct TileLabel {
  std::string text;
  Eigen::RowVector3d position;  ///< their middle
};

/// One mesh in a sheet.
struct Tile {
  Positions positions;        ///< N x 3
  std::vector<Color> colors;  ///< per vertex (N), or none for kClay
  double turn = 0;            ///< degrees about the upright axis, besides the sheet's
  std::string title = {};     ///< above it
  std::vector<TileLabel> labels = {};
  /// Each point has the colour of the vertex nearest to it, instead of what lies between colours.
  bool crisp = false;
};

struct TileRow {
  std::string title;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Tile> tiles;
  std::optional<ColorBar> bar;
  Legend legend = {};  ///< without entries where there is none
};

/// Meshes in rows and columns, all at one scale and seen from one side without perspective, so that
/// one scale bar holds for all of them.
struct Sheet {
  std::vector<TileRow> rows;
  std::vector<std::string> column_titles;
  Viewpoint viewpoint = {.yaw = 0, .pitch = 0};
  int tile_height = 320;  ///< pixels
  int letters = 0;        ///< height of letters, pixels; 0 for what suits the tiles
  std::string unit;       ///< of positions, written at the scale bar
  bool edges = false;     ///< whether those of polygons are drawn
};

/// Largest width and height of a picture.
constexpr int kLargestPicture = 16384;

/// Draws a sheet. Light comes from the upper left, so that wrinkles show; vertices at one place are
/// shaded as one. Throws std::invalid_argument for a sheet without tiles or larger than
/// kLargestPicture, std::runtime_error where there is no OpenGL or it has not enough memory,
/// Cancelled.
Image draw(const Sheet& sheet, const Context& context = {});

/// What this thread draws while it lives is drawn by one window: OpenGL starts, and compiles its
/// shaders, once instead of for each picture, and keeps its memory in between. The pictures are the
/// same bytes.
class DrawingSession {
 public:
  /// Throws std::runtime_error where the library that draws is missing.
  DrawingSession();
  DrawingSession(const DrawingSession&) = delete;
  DrawingSession& operator=(const DrawingSession&) = delete;

 private:
  std::shared_ptr<void> window_;
};

/// Bytes that draw() takes at its peak.
double drawing_bytes(const Sheet& sheet);

/// The picture as the bytes of a PNG file.
std::string png_of(const Image& image);

}  // namespace mimetra
