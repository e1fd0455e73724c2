#include <mimetra/samples/head_grid.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <map>

namespace mimetra::samples {
namespace {

// Columns from the middle of the face to the ear, as sines of the angle around the head: even where
// the face moves, the corners of mouth and eyes on a column each.
constexpr std::array kColumnSines = {0.0,   0.046, 0.092, 0.138, 0.184, 0.23,  0.272, 0.314,
                                     0.356, 0.398, 0.44,  0.482, 0.524, 0.566, 0.608, 0.67,
                                     0.73,  0.79,  0.85,  0.90,  0.945, 0.98};
constexpr int kEarColumn = static_cast<int>(kColumnSines.size());
constexpr int kBackColumn = kEarColumn + 8;
constexpr int kColumns = 2 * kBackColumn;
constexpr int kMouthCorner = 9;
constexpr int kInnerEyeCorner = 5;
constexpr int kOuterEyeCorner = 14;

// Rows, close together at the eyes and the lips.
constexpr std::array kRows = {0.35, 0.70, 1.05, 1.4,   1.75, 2.1,   2.45, 2.8,  3.1,  3.4,  3.65,
                              3.88, 4.08, 4.26, 4.42,  4.56, 4.68,  4.79, 4.90, 5.0,  5.08, 5.16,
                              5.24, 5.33, 5.43, 5.53,  5.63, 5.73,  5.82, 5.91, 6.0,  6.11, 6.24,
                              6.38, 6.51, 6.63, 6.74,  6.84, 6.92,  7.0,  7.05, 7.11, 7.18, 7.26,
                              7.35, 7.46, 7.58, 7.7,   7.84, 8.0,   8.2,  8.45, 8.7,  8.95, 9.25,
                              9.6,  9.95, 10.3, 10.65, 11.0, 11.35, 11.7, 12.0};

constexpr int kMouthRings = 3;
constexpr int kEyelidRings = 2;
constexpr int kEyeballColumns = 12;
constexpr std::array kEyeballRows = {0.08, 0.16, 0.24, 0.32, 0.42, 0.56, 0.72, 0.88};

/// Column in -kBackColumn + 1 .. kBackColumn to the parameter u.
double around(int column) {
  const int side = column < 0 ? -1 : 1;
  const int c = side * column;
  if (c >= kEarColumn) return side * (1 + (c - kEarColumn) / double(kBackColumn - kEarColumn));
  const double s = kColumnSines[static_cast<std::size_t>(c)];
  return side * s / (1 + std::sqrt(1 - s * s));  // tangent of half the angle
}

class Builder {
 public:
  HeadGrid build() {
    add_skin_vertices();
    add_skin_faces();
    const int eye_row = row_at(kEyeRow), mouth_row = row_at(kMouthRow);
    add_rim(mouth_row, -kMouthCorner, kMouthCorner, HeadVertex::Part::mouth, kMouthRings, 0);
    for (const int eye : {-1, 1}) {
      const int from = eye < 0 ? -kOuterEyeCorner : kInnerEyeCorner;
      const int to = eye < 0 ? -kInnerEyeCorner : kOuterEyeCorner;
      add_rim(eye_row, from, to, HeadVertex::Part::eyelid, kEyelidRings, eye);
      add_eyeball(eye);
    }
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

  void add_face(std::initializer_list<VertexIndex> corners) {
    grid_.faces.corners.insert(grid_.faces.corners.end(), corners);
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

  /// Rings behind the cut of `row` from column `from` to `to`.
  void add_rim(int row, int from, int to, HeadVertex::Part part, int rings, int eye) {
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
  }

  void add_eyeball(int eye) {
    const auto vertex = [eye](double u, double v) {
      return HeadVertex{HeadVertex::Part::eyeball, u, v, 0, -1, 0, eye};
    };
    const VertexIndex pupil = add(vertex(0, 0));
    const int first = pupil + 1;
    for (const double v : kEyeballRows) {
      for (int i = 0; i < kEyeballColumns; ++i) add(vertex(i / double(kEyeballColumns), v));
    }
    const VertexIndex back = add(vertex(0, 1));
    const int rows = static_cast<int>(kEyeballRows.size());
    for (int i = 0; i < kEyeballColumns; ++i) {
      const int next = (i + 1) % kEyeballColumns;
      const auto at = [first](int row, int column) {
        return first + row * kEyeballColumns + column;
      };
      add_face({pupil, at(0, i), at(0, next)});
      for (int row = 0; row + 1 < rows; ++row) {
        add_face({at(row, i), at(row + 1, i), at(row + 1, next), at(row, next)});
      }
      add_face({back, at(rows - 1, next), at(rows - 1, i)});
    }
  }

  HeadGrid grid_;
  VertexIndex pole_ = -1;
  /// Vertices by row and column, as the faces above and below the row see them.
  std::map<std::pair<int, int>, VertexIndex> above_, below_;
};

}  // namespace

HeadGrid head_grid() {
  return Builder().build();
}

}  // namespace mimetra::samples
