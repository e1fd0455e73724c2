#pragma once

#include <vector>

#include <vtkSmartPointer.h>
#include <vtkType.h>

class vtkDataArray;
class vtkPolyData;

/// Pieces of one mesh, one for each process that holds some of it.
using Pieces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// Where each point, or cell, of a piece is in the whole mesh.
using Places = std::vector<vtkIdType>;

/// A point or cell of a piece.
struct PieceElement {
  std::size_t piece = 0;
  vtkIdType index = 0;
};

/// Which points of pieces are one.
struct PiecePoints {
  std::vector<Places> places;         ///< of each piece's points
  std::vector<PieceElement> holders;  ///< of each point of the mesh, who is asked for its data
  bool named = false;                 ///< by global ids, in whose order the points are
  bool counted = false;    ///< those are 0, 1, 2, ..., so that numbers of points name them
  std::size_t joined = 0;  ///< points of pieces that became others', by position
};

/// What to do about pieces that cannot be put together as they are.
constexpr const char* kNumberThem =
    "use Generate Global Ids before the mesh is distributed, or one process";

/// Global ids, which may be too large for a double.
std::vector<vtkTypeInt64> ids_of(vtkDataArray& ids);

/// True for a piece that may be a part of a mesh even where no other process holds any of it: its
/// points have global ids, or some of its points or cells are marked as another process's.
bool is_part(vtkPolyData& piece);

/// Throws MismatchError where a position is not finite.
void expect_finite(const Pieces& pieces);

/// True for a cell that another process holds as its own.
bool is_ghost_cell(vtkPolyData& piece, vtkIdType cell);

/// Below this distance, positions that two processes computed are one: a millionth of the largest
/// coordinate, eight times what single precision keeps apart.
double seam_width(const Pieces& pieces);

/// Finds the points of the mesh. Points with one global id are one, and are in the order of their
/// ids; where a piece has none, points on the borders of different pieces less than seam_width()
/// apart are one, in the order of the pieces. What one piece keeps apart stays apart. Ghost points
/// have places, but are no points of their own. Throws MismatchError where ids contradict each
/// other or positions, or it cannot be known which points are one.
PiecePoints joined_points(const Pieces& pieces);

/// Throws MismatchError where points of pieces that have one place are apart.
void expect_joined(const Pieces& pieces, const std::vector<Places>& places);
