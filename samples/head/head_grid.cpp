#include "samples/head/head_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

namespace mimetra::samples {
namespace {

// Columns from the middle of the face to the ear, as sines of the angle around the head. They are
// even where the face moves, and the corners of mouth and eyes are on columns.
constexpr std::array kColumnSines = {0.0,   0.046, 0.092, 0.138, 0.184, 0.23,  0.272,
                                     0.314, 0.356, 0.398, 0.44,  0.482, 0.524, 0.566,
                                     0.608, 0.67,  0.735, 0.80,  0.865, 0.925, 0.975};
// Columns from the front of the ear to the back of the head, as `u`.
constexpr std::array kBackColumns = {1.0, 1.06, 1.11, 1.16, 1.21, 1.27, 1.42, 1.60, 1.80, 2.0};
constexpr int kEarColumn = static_cast<int>(kColumnSines.size());
constexpr int kBackColumn = kEarColumn + static_cast<int>(kBackColumns.size()) - 1;
constexpr int kMouthCorner = 9;
constexpr int kInnerEyeCorner = 5;
constexpr int kOuterEyeCorner = 14;

// Rows, close together at the brows, the eyes, the tip of the nose and the lips.
constexpr std::array kRows = {
    0.25, 0.6,  1.0,  1.4,  1.85, 2.3,  2.75, 3.15, 3.5,  3.8,        // forehead
    4.05, 4.18, 4.29, 4.39, 4.49, 4.59, 4.69, 4.78, 4.87, 4.94, 5.0,  // brows, upper lid
    5.06, 5.12, 5.19, 5.27, 5.36, 5.46, 5.56,                         // lower lid
    5.65, 5.73, 5.80, 5.87, 5.93, 5.99, 6.05, 6.12, 6.2,  6.3,        // nose
    6.42, 6.54, 6.65, 6.75, 6.84, 6.92, 7.0,                          // upper lip
    7.06, 7.12, 7.19, 7.27, 7.36, 7.46, 7.57, 7.70, 7.84,             // lower lip
    8.0,  8.2,  8.45, 8.7,  9.0,  9.4,  9.9,  10.5, 11.2, 12.0};      // chin, neck

constexpr int kEyelidRings = 2;
// Rows of the pit of the pupil, the dish of the iris, and the ball.
constexpr std::array kEyeballRows = {0.06, 0.10, 0.185, 0.205, 0.28, 0.37, 0.48, 0.60, 0.76, 0.89};
constexpr std::array kTongueRows = {0.14, 0.27, 0.40, 0.50, 0.60, 0.73, 0.86};
// Columns within a tooth, from one side to the other.
constexpr std::array kToothColumns = {0.0, 0.22, 0.78};

/// Parameter `u` of a column in -kBackColumn + 1 .. kBackColumn.
double around(int column) {
  const int side = column < 0 ? -1 : 1;
  const int c = side * column;
  if (c >= kEarColumn) return side * kBackColumns[static_cast<std::size_t>(c - kEarColumn)];
  const double s = kColumnSines[static_cast<std::size_t>(c)];
  return side * s / (1 + std::sqrt(1 - s * s));  // tangent of half the angle
}

class Builder {
 public:
  HeadGrid build() {
    add_skin_vertices();
    add_skin_faces();
    const int eye_row = row_at(kEyeRow), mouth_row = row_at(kMouthRow);
    close(add_rim(mouth_row, -kMouthCorner, kMouthCorner, HeadVertex::Part::mouth, kMouthRings, 0));
    for (const int eye : {-1, 1}) {
      const int from = eye < 0 ? -kOuterEyeCorner : kInnerEyeCorner;
      const int to = eye < 0 ? -kInnerEyeCorner : kOuterEyeCorner;
      add_rim(eye_row, from, to, HeadVertex::Part::eyelid, kEyelidRings, eye);
      add_ball({.part = HeadVertex::Part::eyeball, .eye = eye}, kEyeballRows);
    }
    for (const int jaw : {1, -1}) add_teeth(jaw);
    add_ball({.part = HeadVertex::Part::tongue, .rim = -1}, kTongueRows);
    return std::move(grid_);
  }

 private:
  static int row_at(double v) {
    int row = 0;
    while (kRows[static_cast<std::size_t>(row)] < v) ++row;
    return row;
  }

  static bool is_cut(int row, int column) {
    const int c = std::abs(column);
    if (row == row_at(kMouthRow)) return c < kMouthCorner;
    return row == row_at(kEyeRow) && c > kInnerEyeCorner && c < kOuterEyeCorner;
  }

  VertexIndex add(const HeadVertex& vertex) {
    grid_.vertices.push_back(vertex);
    return static_cast<VertexIndex>(grid_.vertices.size()) - 1;
  }

  void add_face(const std::vector<VertexIndex>& corners) {
    grid_.faces.corners.insert(grid_.faces.corners.end(), corners.begin(), corners.end());
    grid_.faces.offsets.push_back(static_cast<int>(grid_.faces.corners.size()));
  }

  void add_skin_vertices() {
    pole_ = add({});
    for (int row = 0; row < static_cast<int>(kRows.size()); ++row) {
      for (int column = -kBackColumn + 1; column <= kBackColumn; ++column) {
        HeadVertex vertex;
        vertex.u = around(column);
        vertex.v = kRows[static_cast<std::size_t>(row)];
        const bool cut = is_cut(row, column);
        vertex.rim = cut ? 1 : 0;
        above_[{row, column}] = below_[{row, column}] = add(vertex);
        vertex.rim = -1;
        if (cut) below_[{row, column}] = add(vertex);
      }
    }
  }

  void add_skin_faces() {
    for (int column = -kBackColumn + 1; column <= kBackColumn; ++column) {
      const int next = column == kBackColumn ? -kBackColumn + 1 : column + 1;
      add_face({pole_, above_[{0, column}], above_[{0, next}]});
      for (int row = 0; row + 1 < static_cast<int>(kRows.size()); ++row) {
        add_face({below_[{row, column}], above_[{row + 1, column}], above_[{row + 1, next}],
                  below_[{row, next}]});
      }
    }
  }

  /// Adds rings behind the cut of `row` between columns `from` and `to`. Returns the last ring: its
  /// upper half by ascending column, then its lower half back.
  std::vector<VertexIndex> add_rim(int row, int from, int to, HeadVertex::Part part, int rings,
                                   int eye) {
    std::vector<VertexIndex> sources;
    for (int column = from; column < to; ++column) sources.push_back(above_[{row, column}]);
    for (int column = to; column > from; --column) sources.push_back(below_[{row, column}]);
    std::vector<VertexIndex> front = sources;
    for (int ring = 1; ring <= rings; ++ring) {
      std::vector<VertexIndex> back;
      for (const VertexIndex source : sources) {
        HeadVertex vertex = grid_.vertices[static_cast<std::size_t>(source)];
        vertex.part = part;
        vertex.source = source;
        vertex.ring = ring;
        vertex.eye = eye;
        back.push_back(add(vertex));
      }
      for (std::size_t i = 0; i < front.size(); ++i) {
        const std::size_t next = (i + 1) % front.size();
        add_face({front[next], front[i], back[i], back[next]});
      }
      front = back;
    }
    return front;
  }

  /// Closes the ring that add_rim() returned, between its upper and lower half.
  void close(const std::vector<VertexIndex>& ring) {
    const std::size_t half = ring.size() / 2;
    const auto below = [&](std::size_t column) {
      return ring[(ring.size() - column) % ring.size()];
    };
    add_face({ring[0], below(1), ring[1]});
    for (std::size_t c = 1; c + 1 < half; ++c) {
      add_face({ring[c], below(c), below(c + 1), ring[c + 1]});
    }
    add_face({ring[half - 1], below(half - 1), ring[half]});
  }

  /// Adds a closed surface around the z axis, from its front (v = 0) to its back (v = 1), with a
  /// ring in each of `rows`.
  void add_ball(HeadVertex vertex, std::span<const double> rows) {
    const auto at = [&](double u, double v) {
      vertex.u = u;
      vertex.v = v;
      return add(vertex);
    };
    const VertexIndex front = at(0, 0);
    for (const double v : rows) {
      for (int i = 0; i < kBallColumns; ++i) at(i / double(kBallColumns), v);
    }
    const VertexIndex back = at(0, 1);
    add_tube(front + 1, kBallColumns, static_cast<int>(rows.size()), front, back, false);
  }

  /// Adds the teeth and gum of the upper (1) or lower (-1) jaw, from the head's right to its left.
  void add_teeth(int jaw) {
    std::vector<double> columns;
    for (int tooth = 0; tooth < kTeeth; ++tooth) {
      for (const double within : kToothColumns) columns.push_back(tooth + within);
    }
    columns.push_back(kTeeth);
    constexpr double kEnd = kTeeth + 0.1;
    const auto at = [&](double u, double v) {
      return add({.part = HeadVertex::Part::teeth, .u = u, .v = v, .rim = jaw});
    };
    const VertexIndex right = at(-kEnd, 0);
    const auto ring = [&](double u) {
      for (int point = 0; point < kToothPoints; ++point) at(u, point);
    };
    for (auto u = columns.rbegin(); u != columns.rend() - 1; ++u) ring(-*u);
    for (const double u : columns) ring(u);
    const VertexIndex left = at(kEnd, 0);
    add_tube(right + 1, kToothPoints, 2 * static_cast<int>(columns.size()) - 1, right, left,
             jaw < 0);
  }

  /// Adds the faces of a tube, closed by a vertex at each end. Its rings have `columns` vertices
  /// each and start at vertex `first`.
  void add_tube(VertexIndex first, int columns, int rings, VertexIndex begin, VertexIndex end,
                bool inside_out) {
    const auto face = [&](std::vector<VertexIndex> corners) {
      if (inside_out) std::ranges::reverse(corners);
      add_face(corners);
    };
    for (int i = 0; i < columns; ++i) {
      const int next = (i + 1) % columns;
      const auto at = [&](int ring, int column) { return first + ring * columns + column; };
      face({begin, at(0, i), at(0, next)});
      for (int ring = 0; ring + 1 < rings; ++ring) {
        face({at(ring, i), at(ring + 1, i), at(ring + 1, next), at(ring, next)});
      }
      face({end, at(rings - 1, next), at(rings - 1, i)});
    }
  }

  HeadGrid grid_;
  VertexIndex pole_ = -1;
  /// Vertices by row and column, used by the faces above and below the row, respectively.
  std::map<std::pair<int, int>, VertexIndex> above_, below_;
};

}  // namespace

HeadGrid head_grid() {
  return Builder().build();
}

}  // namespace mimetra::samples
