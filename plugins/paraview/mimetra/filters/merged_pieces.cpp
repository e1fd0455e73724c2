#include "plugins/paraview/mimetra/filters/merged_pieces.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include "plugins/paraview/mimetra/filters/piece_data.h"
#include "toolkit/mesh/errors.h"

using namespace mimetra;

namespace {

/// Cells in the order in which VTK numbers them.
std::array<vtkCellArray*, 4> cell_arrays(vtkPolyData& mesh) {
  return {mesh.GetVerts(), mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips()};
}

std::size_t as_index(vtkIdType id) {
  return static_cast<std::size_t>(id);
}

/// A cell of a piece, on points of the mesh.
struct Cell {
  PieceElement from = {};
  int kind = 0;  ///< index of cell_arrays()
  vtkTypeInt64 id = 0;
  std::vector<vtkIdType> corners = {};  ///< in their order
  std::vector<vtkIdType> sorted = {};
};

std::string name_of(const Cell& cell) {
  return "cell " + std::to_string(cell.from.index) + " of process " +
         std::to_string(cell.from.piece);
}

/// Throws MismatchError if cells use points that do not exist.
void expect_valid(vtkPolyData& piece, std::size_t number) {
  for (vtkCellArray* cells : cell_arrays(piece)) {
    vtkNew<vtkIdList> corners;
    bool fits = cells->IsValid();
    for (vtkIdType i = 0; fits && i < cells->GetNumberOfCells(); ++i) {
      cells->GetCellAtId(i, corners);
      fits = std::ranges::all_of(*corners, [&](vtkIdType corner) {
        return corner >= 0 && corner < piece.GetNumberOfPoints();
      });
    }
    if (!fits) {
      throw MismatchError("the cells of process " + std::to_string(number) +
                          " use points that it does not have");
    }
  }
}

/// Own cells, or ghost cells, of all pieces.
std::vector<Cell> cells_of(const Pieces& pieces, const std::vector<Places>& points, bool ghosts) {
  std::vector<Cell> cells;
  for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
    vtkDataArray* array = pieces[piece]->GetCellData()->GetGlobalIds();
    const auto ids = array ? ids_of(*array) : std::vector<vtkTypeInt64>();
    vtkNew<vtkIdList> corners;
    vtkIdType index = 0;
    int kind = 0;
    for (vtkCellArray* own : cell_arrays(*pieces[piece])) {
      for (vtkIdType i = 0; i < own->GetNumberOfCells(); ++i, ++index) {
        if (is_ghost_cell(*pieces[piece], index) != ghosts) continue;
        own->GetCellAtId(i, corners);
        Cell cell{{piece, index}, kind, ids.empty() ? 0 : ids[as_index(index)]};
        for (const vtkIdType corner : *corners) {
          cell.corners.push_back(points[piece][as_index(corner)]);
        }
        cell.sorted = cell.corners;
        std::ranges::sort(cell.sorted);
        cells.push_back(std::move(cell));
      }
      ++kind;
    }
  }
  return cells;
}

/// Finds cells by their kind and points.
class CellFinder {
 public:
  explicit CellFinder(const std::vector<Cell>& cells) : cells_(cells), order_(cells.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::ranges::stable_sort(order_, {}, [this](std::size_t i) { return key(cells_[i]); });
  }

  /// First cell with the points of this one, or none.
  std::optional<std::size_t> first_like(const Cell& cell) const {
    const auto found = std::ranges::lower_bound(order_, key(cell), {},
                                                [this](std::size_t i) { return key(cells_[i]); });
    if (found == order_.end() || key(cells_[*found]) != key(cell)) return {};
    return *found;
  }

 private:
  static std::tuple<int, const std::vector<vtkIdType>&> key(const Cell& cell) {
    return {cell.kind, cell.sorted};
  }

  const std::vector<Cell>& cells_;
  std::vector<std::size_t> order_;
};

bool all_have_cell_ids(const Pieces& pieces) {
  return std::ranges::all_of(pieces, [](const auto& piece) {
    return piece->GetNumberOfCells() == 0 || piece->GetCellData()->GetGlobalIds();
  });
}

/// Throws MismatchError if two processes have the same cell. It may be a copy or an intended
/// duplicate. Skips vertex cells, which may be on seams.
void expect_no_copies(const std::vector<Cell>& cells) {
  const CellFinder finder(cells);
  for (const Cell& cell : cells) {
    const Cell& first = cells[*finder.first_like(cell)];
    if (cell.corners.size() < 2 || first.from.piece == cell.from.piece) continue;
    throw MismatchError(name_of(first) + " and " + name_of(cell) +
                        " have the same points, but neither is marked as a ghost; distribute the "
                        "mesh with each cell in one piece");
  }
}

/// Sorts cells by their ids. Without cell ids, sorts them by their points if these have ids, which
/// does not depend on the pieces. Otherwise, keeps the order of the pieces.
std::vector<Cell> ordered(std::vector<Cell> cells, bool by_ids, bool by_points) {
  std::ranges::stable_sort(cells, {}, [&](const Cell& cell) {
    return std::pair(cell.kind, by_ids ? cell.id : vtkTypeInt64{0});
  });
  if (!by_ids && by_points) {
    std::ranges::stable_sort(cells, [](const Cell& a, const Cell& b) {
      return std::tie(a.kind, a.sorted) < std::tie(b.kind, b.sorted);
    });
  }
  const auto same = [](const Cell& a, const Cell& b) { return a.kind == b.kind && a.id == b.id; };
  const auto twice = by_ids ? std::ranges::adjacent_find(cells, same) : cells.end();
  if (twice == cells.end()) return cells;
  throw MismatchError("global id " + std::to_string(twice->id) + " names " + name_of(*twice) +
                      " and " + name_of(*std::next(twice)) + "; expected one for each cell");
}

std::vector<Places> places_of(const Pieces& pieces, const std::vector<Cell>& cells,
                              const std::vector<Cell>& ghosts) {
  std::vector<Places> places;
  for (const auto& piece : pieces) places.emplace_back(as_index(piece->GetNumberOfCells()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const PieceElement& from = cells[i].from;
    places[from.piece][as_index(from.index)] = static_cast<vtkIdType>(i);
  }
  if (ghosts.empty()) return places;
  const CellFinder finder(cells);
  for (const Cell& ghost : ghosts) {
    const auto owner = finder.first_like(ghost);
    if (!owner) {
      throw MismatchError(name_of(ghost) + " is a ghost of no process; " + kNumberThem);
    }
    places[ghost.from.piece][as_index(ghost.from.index)] = static_cast<vtkIdType>(*owner);
  }
  return places;
}

void set_cells(vtkPolyData& mesh, const std::vector<Cell>& cells) {
  std::array<vtkNew<vtkCellArray>, 4> arrays;
  for (const Cell& cell : cells) {
    arrays[static_cast<std::size_t>(cell.kind)]->InsertNextCell(
        static_cast<vtkIdType>(cell.corners.size()), cell.corners.data());
  }
  mesh.SetVerts(arrays[0]);
  mesh.SetLines(arrays[1]);
  mesh.SetPolys(arrays[2]);
  mesh.SetStrips(arrays[3]);
}

bool same_array(vtkDataArray* a, vtkDataArray* b) {
  if (a == b) return true;
  if (!a || !b || a->GetDataType() != b->GetDataType()) return false;
  const vtkIdType values = a->GetNumberOfValues();
  if (values != b->GetNumberOfValues()) return false;
  const auto bytes = as_index(values * a->GetDataTypeSize());
  return bytes == 0 || std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), bytes) == 0;
}

/// Returns whether pieces of two times have the same cells, ids and ghosts.
bool same_piece(const vtkSmartPointer<vtkPolyData>& a, const vtkSmartPointer<vtkPolyData>& b) {
  const auto same_cells = [](vtkCellArray* x, vtkCellArray* y) {
    return same_array(x->GetOffsetsArray(), y->GetOffsetsArray()) &&
           same_array(x->GetConnectivityArray(), y->GetConnectivityArray());
  };
  return a->GetNumberOfPoints() == b->GetNumberOfPoints() &&
         std::ranges::equal(cell_arrays(*a), cell_arrays(*b), same_cells) &&
         same_array(a->GetPointData()->GetGlobalIds(), b->GetPointData()->GetGlobalIds()) &&
         same_array(a->GetCellData()->GetGlobalIds(), b->GetCellData()->GetGlobalIds()) &&
         same_array(a->GetPointGhostArray(), b->GetPointGhostArray()) &&
         same_array(a->GetCellGhostArray(), b->GetCellGhostArray());
}

bool is_whole(const Pieces& pieces) {
  const auto has_points = [](const auto& piece) { return piece->GetNumberOfPoints() > 0; };
  const auto filled = std::ranges::count_if(pieces, has_points);
  return filled == 0 || (filled == 1 && !is_part(**std::ranges::find_if(pieces, has_points)));
}

/// Result whose mesh is the unchanged only piece with points, or an empty piece.
MergedPieces whole_piece(Pieces pieces) {
  MergedPieces merged{pieces.front()};
  for (const auto& piece : pieces) {
    if (piece->GetNumberOfPoints() > 0) merged.mesh = piece;
  }
  for (const auto& piece : pieces) {
    const bool is_mesh = piece == merged.mesh;
    merged.points.places.emplace_back(as_index(is_mesh ? piece->GetNumberOfPoints() : 0));
    merged.cells.emplace_back(as_index(is_mesh ? piece->GetNumberOfCells() : 0));
    std::iota(merged.points.places.back().begin(), merged.points.places.back().end(), 0);
    std::iota(merged.cells.back().begin(), merged.cells.back().end(), 0);
  }
  merged.points.named = merged.points.counted = true;
  merged.pieces = std::move(pieces);
  return merged;
}

[[noreturn]] void refuse_others(const Pieces& pieces, const Pieces& before) {
  const auto other = std::ranges::mismatch(pieces, before, same_piece).in1;
  throw MismatchError("process " + std::to_string(other - pieces.begin()) +
                      " holds another piece than before, and which points are which cannot be "
                      "known; " +
                      kNumberThem);
}

void merge_cells(MergedPieces& merged) {
  const Pieces& pieces = merged.pieces;
  std::vector<Cell> cells = cells_of(pieces, merged.points.places, false);
  expect_no_copies(cells);
  cells = ordered(std::move(cells), all_have_cell_ids(pieces), merged.points.named);
  merged.cells = places_of(pieces, cells, cells_of(pieces, merged.points.places, true));
  set_cells(*merged.mesh, cells);
  for (const Cell& cell : cells) merged.cell_holders.push_back(cell.from);
}

/// Result for the same pieces at another time.
MergedPieces followed(Pieces pieces, const MergedPieces& before) {
  expect_joined(pieces, before.points.places);
  MergedPieces merged = before;
  merged.mesh = vtkSmartPointer<vtkPolyData>::New();
  merged.mesh->SetVerts(before.mesh->GetVerts());
  merged.mesh->SetLines(before.mesh->GetLines());
  merged.mesh->SetPolys(before.mesh->GetPolys());
  merged.mesh->SetStrips(before.mesh->GetStrips());
  merged.pieces = std::move(pieces);
  return merged;
}

}  // namespace

MergedPieces merged(Pieces pieces, const MergedPieces* before) {
  const bool as_before = before && std::ranges::equal(pieces, before->pieces, same_piece);
  const bool is_another = before && !as_before;
  if (is_another && !before->points.named) refuse_others(pieces, before->pieces);
  if (is_whole(pieces)) return whole_piece(std::move(pieces));
  for (std::size_t i = 0; i < pieces.size(); ++i) expect_valid(*pieces[i], i);
  expect_finite(pieces);
  MergedPieces merged{vtkSmartPointer<vtkPolyData>::New()};
  if (as_before) {
    merged = followed(std::move(pieces), *before);
  } else {
    merged.points = joined_points(pieces);
    if (is_another && !merged.points.named) refuse_others(pieces, before->pieces);
    merged.pieces = std::move(pieces);
    merge_cells(merged);
  }
  merge_data(*merged.mesh, merged.pieces, merged.points.holders, merged.cell_holders);
  return merged;
}
