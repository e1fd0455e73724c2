#pragma once

#include <vector>

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkDataArray;
class vtkPolyData;

/// Pieces of one mesh, one for each process that holds some of it.
using Pieces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// Index in the whole mesh of each point, or cell, of a piece.
using Places = std::vector<vtkIdType>;

/// A point or cell of a piece.
struct PieceElement {
  std::size_t piece = 0;
  vtkIdType index = 0;
};

/// Points of the mesh, and which points of pieces they join.
struct PiecePoints {
  std::vector<Places> places;         ///< places of each piece's points
  std::vector<PieceElement> holders;  ///< point that gives its data to each point of the mesh
  bool named = false;                 ///< points were joined by global ids and are in their order
  bool counted = false;               ///< the ids are 0, 1, 2, ..., so they equal numbers of points
  std::size_t joined = 0;             ///< number of points joined with others by position
};

/// Advice for pieces that cannot be merged without changes.
constexpr const char* kNumberThem =
    "use Generate Global Ids before the mesh is distributed, or one process";

/// Global ids as integers, because they may be too large for a double.
std::vector<vtkTypeInt64> ids_of(vtkDataArray& ids);

/// Returns whether a piece may be a part of a mesh even if no other process holds any of it. Such a
/// piece has global ids of points, or ghost points or cells.
bool is_part(vtkPolyData& piece);

/// Throws MismatchError if a position is not finite.
void expect_finite(const Pieces& pieces);

/// Returns whether another process holds a cell as its own.
bool is_ghost_cell(vtkPolyData& piece, vtkIdType cell);

/// Distance within which positions on two processes count as one: a millionth of the largest
/// coordinate, about eight times the resolution of single precision.
double seam_width(const Pieces& pieces);

/// Finds the points of the mesh. If all pieces with points have global ids, points with the same id
/// are one, in the order of their ids. Otherwise, points of different pieces are one if they are
/// within seam_width() and on the borders of both, or in no cell of one. They are in the order of
/// the pieces. Points of one piece are never joined. Ghost points have places, but are not points
/// of their own. Throws MismatchError if ids contradict each other or positions, or if the points
/// to join are ambiguous.
PiecePoints joined_points(const Pieces& pieces);

/// Throws MismatchError if points with the same place are farther than seam_width() apart.
void expect_joined(const Pieces& pieces, const std::vector<Places>& places);
