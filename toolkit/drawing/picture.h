#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/image.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/operations/colors.h"

namespace mimetra {

/// Direction from which meshes are seen.
struct Viewpoint {
  /// At 0, faces that look along +z (-y if z is up) are seen from the front.
  double yaw = 15;
  /// Positive angles look down from above.
  double pitch = 5;
  UpAxis up = UpAxis::y;

  static constexpr Option kYaw{
      "yaw", &Viewpoint::yaw, {.minimum = -360, .maximum = 360}, "degrees"};
  static constexpr Option kPitch{
      "pitch", &Viewpoint::pitch, {.minimum = -90, .maximum = 90}, "degrees"};
  static constexpr Option kUp{"up", &Viewpoint::up};
  static constexpr auto declared() { return std::tuple(kYaw, kPitch, kUp); }
};

/// Colour scale of a row: even_color() over [minimum, maximum].
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  std::string unit;       ///< written after the maximum
  std::string name = {};  ///< name of the values, above the bar
};

/// Colours of a row that represent numbers.
struct Legend {
  struct Entry {
    int number;
    Color color;
  };
  std::string name;  ///< name of the numbers, above them
  std::vector<Entry> entries;
};

/// Text on a mesh.
struct TileLabel {
  std::string text;
  Eigen::RowVector3d position;  ///< middle of the text
};

/// One mesh in a sheet.
struct Tile {
  Positions positions;        ///< N x 3
  std::vector<Color> colors;  ///< per vertex (N), or empty for kClay
  double turn = 0;            ///< degrees about the upright axis, in addition to the sheet's
  std::string title = {};     ///< above the mesh
  std::vector<TileLabel> labels = {};
  /// Give each point the colour of the nearest vertex, instead of interpolating colours.
  bool crisp = false;
};

struct TileRow {
  std::string title;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Tile> tiles;
  std::optional<ColorBar> bar;
  Legend legend = {};  ///< without entries if there is none
};

/// Meshes in rows and columns, seen from one side without perspective. All have one scale, so a
/// single scale bar holds for all of them.
struct Sheet {
  std::vector<TileRow> rows;
  std::vector<std::string> column_titles;
  Viewpoint viewpoint = {.yaw = 0, .pitch = 0};
  int tile_height = 320;  ///< pixels
  int letters = 0;        ///< height of letters, pixels; 0 to fit the tiles
  std::string unit;       ///< unit of the positions, written at the scale bar
  bool edges = false;     ///< whether edges of polygons are drawn
};

/// Largest width and height of a picture.
constexpr int kLargestPicture = 16384;

/// Draws a sheet. Light comes from the upper left, so that wrinkles show; vertices at one place are
/// shaded as one. Throws std::invalid_argument for a sheet without tiles or larger than
/// kLargestPicture, and MismatchError if all vertices of the meshes coincide. Throws
/// std::runtime_error if there is no OpenGL or not enough memory for it, and Cancelled.
Image draw(const Sheet& sheet, const Context& context = {});

/// While it lives, one window draws all pictures of this thread. OpenGL starts and compiles its
/// shaders only once, and keeps its memory in between. The pictures have the same bytes.
class DrawingSession {
 public:
  /// Throws std::runtime_error if the drawing library is missing.
  DrawingSession();
  DrawingSession(const DrawingSession&) = delete;
  DrawingSession& operator=(const DrawingSession&) = delete;

 private:
  std::shared_ptr<void> window_;
};

/// Peak memory of draw() in bytes.
double drawing_bytes(const Sheet& sheet);

/// Bytes of a PNG file of the picture.
std::string png_of(const Image& image);

}  // namespace mimetra
