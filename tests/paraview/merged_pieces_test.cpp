#include "plugins/paraview/mimetra/filters/merged_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include "tests/paraview/made_pieces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;
using namespace mimetra::test;
using testing::HasSubstr;

namespace {

void mark_ghosts(vtkDataSetAttributes& attributes, vtkIdType count, vtkIdType first) {
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < count; ++i) ghosts->InsertNextValue(i < first ? 0 : 1);
  attributes.AddArray(ghosts);
}

void move(vtkPolyData& mesh, vtkIdType point, double by) {
  std::array<double, 3> position = {};
  mesh.GetPoint(point, position.data());
  position[0] += by;
  mesh.GetPoints()->SetPoint(point, position.data());
}

/// The point of a piece that is a point of the whole.
vtkIdType local(vtkPolyData& piece, double number) {
  for (vtkIdType i = 0; i < piece.GetNumberOfPoints(); ++i) {
    if (value(*piece.GetPointData(), "at", i) == number) return i;
  }
  return -1;
}

std::string refusal(const Pieces& pieces, const MergedPieces* before = nullptr) {
  try {
    merged(pieces, before);
  } catch (const MismatchError& error) {
    return error.what();
  }
  return "";
}

/// Whatever the order is: every point and cell of the pieces is found in it once.
void expect_square(const MergedPieces& found) {
  const Mesh whole = square();
  ASSERT_EQ(found.mesh->GetNumberOfPoints(), whole->GetNumberOfPoints());
  ASSERT_EQ(found.mesh->GetNumberOfCells(), whole->GetNumberOfCells());
  for (vtkIdType i = 0; i < found.mesh->GetNumberOfPoints(); ++i) {
    const auto at = static_cast<vtkIdType>(value(*found.mesh->GetPointData(), "at", i));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(found.mesh->GetPoint(i)[axis], whole->GetPoint(at)[axis]);
    }
  }
  for (vtkIdType cell = 0; cell < found.mesh->GetNumberOfCells(); ++cell) {
    std::vector<vtkIdType> corners;
    for (const vtkIdType corner : corners_of(*found.mesh, cell)) {
      corners.push_back(static_cast<vtkIdType>(value(*found.mesh->GetPointData(), "at", corner)));
    }
    const auto on = static_cast<vtkIdType>(value(*found.mesh->GetCellData(), "on", cell));
    EXPECT_EQ(corners, corners_of(*whole, on));
  }
  for (std::size_t p = 0; p < found.pieces.size(); ++p) {
    for (vtkIdType i = 0; i < found.pieces[p]->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(value(*found.pieces[p]->GetPointData(), "at", i),
                value(*found.mesh->GetPointData(), "at", found.points.places[p][std::size_t(i)]));
    }
    for (vtkIdType i = 0; i < found.pieces[p]->GetNumberOfCells(); ++i) {
      EXPECT_EQ(value(*found.pieces[p]->GetCellData(), "on", i),
                value(*found.mesh->GetCellData(), "on", found.cells[p][std::size_t(i)]));
    }
  }
}

}  // namespace

TEST(MergedPieces, AreTheMeshItselfWhereOnePieceHoldsIt) {
  const Mesh mesh = square();
  const MergedPieces found = merged({Mesh::New(), mesh, Mesh::New()}, nullptr);
  EXPECT_EQ(found.mesh, mesh);
  EXPECT_TRUE(found.points.counted);
  expect_square(found);
}

TEST(MergedPieces, AreInTheOrderOfIdsWhereOneProcessWasGivenAll) {
  const Mesh mesh = square();
  const std::vector<vtkIdType> backwards = {15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0};
  const Mesh piece = piece_of(*mesh, backwards, Ids::points_and_cells);
  const MergedPieces found = merged({Mesh::New(), piece}, nullptr);
  EXPECT_TRUE(found.points.counted);
  expect_square(found);
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
    EXPECT_EQ(value(*found.mesh->GetPointData(), "at", i), static_cast<double>(i));
  }
}

TEST(MergedPieces, AreRefusedWhereOneProcessWasGivenAPointTwice) {
  const Mesh piece = piece_of(*square(), {0, 1, 2, 3}, Ids::points);
  vtkDataArray& ids = *piece->GetPointData()->GetGlobalIds();
  ids.SetTuple1(3, ids.GetTuple1(2));
  EXPECT_THAT(refusal({piece, Mesh::New()}), HasSubstr("expected one for each point"));
}

TEST(MergedPieces, LoseGhostsOfOneProcessThatWasGivenAll) {
  const Mesh mesh = square();
  std::vector<vtkIdType> cells(16);
  std::iota(cells.begin(), cells.end(), 0);
  cells.push_back(3);  // a copy, marked as one
  for (const Ids ids : {Ids::none, Ids::points}) {
    const Mesh piece = piece_of(*mesh, cells, ids);
    mark_ghosts(*piece->GetCellData(), 17, 16);
    expect_square(merged({piece, Mesh::New()}, nullptr));
  }
}

TEST(MergedPieces, AreCountedByIdsWithoutGapsOnly) {
  const Mesh mesh = square();
  EXPECT_TRUE(merged(halves(Ids::points), nullptr).points.counted);
  EXPECT_FALSE(merged(halves(), nullptr).points.counted);
  const Pieces later = {piece_of(*mesh, {4, 5, 6, 7}, Ids::points),
                        piece_of(*mesh, {8, 9, 10, 11}, Ids::points)};
  EXPECT_FALSE(merged(later, nullptr).points.counted);
  const Pieces gap = {piece_of(*mesh, {0, 1, 2, 3}, Ids::points),
                      piece_of(*mesh, {12, 13, 14, 15}, Ids::points)};
  EXPECT_TRUE(merged(gap, nullptr).points.named);
  EXPECT_FALSE(merged(gap, nullptr).points.counted);
}

TEST(MergedPieces, AreTheMeshInItsOrderWhereGlobalIdsSayIt) {
  const Mesh mesh = square();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MergedPieces found = merged(scattered(*mesh, seed, Ids::points_and_cells), nullptr);
    EXPECT_TRUE(found.points.named);
    expect_square(found);
    for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(value(*found.mesh->GetPointData(), "at", i), static_cast<double>(i));
    }
    for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
      EXPECT_EQ(corners_of(*found.mesh, i), corners_of(*mesh, i));
    }
  }
}

TEST(MergedPieces, AreInOneOrderHoweverTheyAreCutWherePointsHaveIds) {
  const Mesh mesh = square();
  const MergedPieces first = merged(scattered(*mesh, 1, Ids::points), nullptr);
  for (unsigned seed = 2; seed < 20; ++seed) {
    const MergedPieces found = merged(scattered(*mesh, seed, Ids::points), nullptr);
    expect_square(found);
    for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
      EXPECT_EQ(corners_of(*found.mesh, i), corners_of(*first.mesh, i));
    }
  }
}

TEST(MergedPieces, AreJoinedAtSeamsWithoutIdsInTheOrderOfThePieces) {
  const Mesh mesh = square();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MergedPieces found = merged(scattered(*mesh, seed, Ids::none), nullptr);
    EXPECT_FALSE(found.points.named);
    expect_square(found);
  }
  Places first = merged(halves(), nullptr).points.places.front();
  EXPECT_TRUE(std::ranges::is_sorted(first));
  EXPECT_EQ(first.back(), 3 * kSize - 1);
}

TEST(MergedPieces, AreJoinedWherePositionsDifferByRounding) {
  Pieces pieces = halves();
  move(*pieces[1], local(*pieces[1], 2 * kSize), 1e-7);
  EXPECT_EQ(merged(pieces, nullptr).mesh->GetNumberOfPoints(), kSize * kSize);
  EXPECT_EQ(merged(pieces, nullptr).points.joined, std::size_t{kSize});
  EXPECT_EQ(merged(halves(Ids::points), nullptr).points.joined, 0U);
  move(*pieces[1], local(*pieces[1], 2 * kSize), 1e-4);
  EXPECT_EQ(merged(pieces, nullptr).mesh->GetNumberOfPoints(), kSize * kSize + 1);
}

TEST(MergedPieces, KeepApartWhatOnePieceKeepsApart) {
  Pieces pieces = halves();
  // A slit that is closed: two border points of one piece at one position, far from the other.
  pieces[0]->GetPoints()->SetPoint(local(*pieces[0], 1), pieces[0]->GetPoint(local(*pieces[0], 0)));
  EXPECT_EQ(merged(pieces, nullptr).mesh->GetNumberOfPoints(), kSize * kSize);
  EXPECT_EQ(refusal(pieces), "");
}

TEST(MergedPieces, AreRefusedWhereWhichPointIsWhichCannotBeKnown) {
  Pieces pieces = halves();
  pieces[0]->GetPoints()->SetPoint(local(*pieces[0], 0),
                                   pieces[0]->GetPoint(local(*pieces[0], 2 * kSize)));
  EXPECT_THAT(refusal(pieces), HasSubstr("which of them it is cannot be known"));
  EXPECT_THAT(refusal(pieces), HasSubstr("Generate Global Ids"));
}

TEST(MergedPieces, AreRefusedWhereAnInnerPointOfOneIsAtAPointOfAnother) {
  Pieces pieces = halves();
  const std::array<double, 3> inner = {1, 1, std::sin(0.7 + 1)};
  pieces[1]->GetPoints()->SetPoint(local(*pieces[1], kSize * kSize - 1), inner.data());
  EXPECT_THAT(refusal(pieces), HasSubstr("not at the border of both pieces"));
}

TEST(MergedPieces, LoseGhostsWhichKeepTheirPlaces) {
  const Mesh mesh = square();
  for (const Ids ids : {Ids::none, Ids::points, Ids::points_and_cells}) {
    Pieces pieces = {piece_of(*mesh, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, ids),
                     piece_of(*mesh, {8, 9, 10, 11, 12, 13, 14, 15, 7, 6}, ids)};
    EXPECT_THAT(refusal(pieces), HasSubstr("ghost"));
    for (const auto& piece : pieces) mark_ghosts(*piece->GetCellData(), 10, 8);
    expect_square(merged(pieces, nullptr));
    // Marked points, too; the first piece owns the seam.
    mark_ghosts(*pieces[0]->GetPointData(), pieces[0]->GetNumberOfPoints(), 3 * kSize);
    const MergedPieces found = merged(pieces, nullptr);
    expect_square(found);
    EXPECT_FALSE(found.mesh->GetPointData()->HasArray(vtkDataSetAttributes::GhostArrayName()));
    EXPECT_FALSE(found.mesh->GetCellData()->HasArray(vtkDataSetAttributes::GhostArrayName()));
  }
}

TEST(MergedPieces, AreRefusedWithAGhostOfNobody) {
  const Mesh mesh = square();
  Pieces pieces = {piece_of(*mesh, {0, 1, 2, 3, 8}), piece_of(*mesh, {4, 5, 6, 7})};
  mark_ghosts(*pieces[0]->GetCellData(), 5, 4);
  EXPECT_THAT(refusal(pieces), HasSubstr("is a ghost of no process"));
}

TEST(MergedPieces, AreRefusedWhereIdsContradict) {
  Pieces pieces = halves(Ids::points);
  pieces[1]->GetPointData()->GetGlobalIds()->SetTuple1(0, 0);
  EXPECT_THAT(refusal(pieces), HasSubstr("which are at different positions"));
  pieces = halves(Ids::points);
  pieces[1]->GetPointData()->GetGlobalIds()->SetTuple1(0, 24);
  EXPECT_THAT(refusal(pieces), HasSubstr("global id 24 names point"));
  pieces = halves(Ids::points_and_cells);
  pieces[1]->GetCellData()->GetGlobalIds()->SetTuple1(0, 3);
  EXPECT_THAT(refusal(pieces), HasSubstr("global id 3 names cell"));
}

TEST(MergedPieces, AreRefusedWhereIdsLeaveASeamOpenThatRoundingMade) {
  Pieces pieces = halves(Ids::points);
  const vtkIdType seam = local(*pieces[1], 2 * kSize);
  pieces[1]->GetPointData()->GetGlobalIds()->SetTuple1(seam, 100);
  EXPECT_EQ(merged(pieces, nullptr).mesh->GetNumberOfPoints(), kSize * kSize + 1);
  move(*pieces[1], seam, 1e-7);
  EXPECT_THAT(refusal(pieces), HasSubstr("nearly at one position"));
}

TEST(MergedPieces, AreRefusedWithPositionsThatAreNoNumbers) {
  Pieces pieces = halves();
  move(*pieces[1], 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(refusal(pieces), HasSubstr("point 3 of process 1 is not finite"));
}

TEST(MergedPieces, AreFollowedOverTime) {
  const Mesh mesh = square();
  const MergedPieces before = merged(halves(), nullptr);
  Pieces later = halves();
  for (const auto& piece : later) {
    for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i) {
      move(*piece, i, value(*piece->GetPointData(), "at", i));
    }
  }
  const MergedPieces found = merged(later, &before);
  EXPECT_EQ(found.points.places, before.points.places);
  EXPECT_EQ(found.points.joined, std::size_t{kSize});
  Pieces broken = halves();
  const vtkIdType inner = local(*broken[1], kSize * kSize - 1);
  move(*broken[1], inner, std::numeric_limits<double>::infinity());
  EXPECT_THAT(refusal(broken, &before), HasSubstr("is not finite"));
  move(*later[1], local(*later[1], 2 * kSize + 1), 0.5);
  EXPECT_THAT(refusal(later, &before), HasSubstr("have parted"));
  EXPECT_THAT(refusal(scattered(*mesh, 3, Ids::none), &before), HasSubstr("another piece"));
  EXPECT_THAT(refusal({mesh, Mesh::New()}, &before), HasSubstr("another piece"));
  const MergedPieces alone = merged({mesh, Mesh::New()}, nullptr);
  EXPECT_THAT(refusal(halves(), &alone), HasSubstr("another piece"));
  const MergedPieces named = merged(scattered(*mesh, 3, Ids::points), nullptr);
  expect_square(merged(scattered(*mesh, 4, Ids::points), &named));
}

TEST(MergedPieces, ShareTheirCellsWhereOnlyPositionsAreOthers) {
  for (const Ids ids : {Ids::none, Ids::points, Ids::points_and_cells}) {
    const MergedPieces before = merged(halves(ids), nullptr);
    Pieces later = halves(ids);
    for (const auto& piece : later) {
      for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i) move(*piece, i, 2);
    }
    const MergedPieces found = merged(later, &before);
    EXPECT_EQ(found.mesh->GetPolys(), before.mesh->GetPolys());
    EXPECT_EQ(found.points.counted, before.points.counted);
    for (vtkIdType i = 0; i < found.mesh->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(found.mesh->GetPoint(i)[0], value(*found.mesh->GetPointData(), "at", i) -
                                                kSize * before.mesh->GetPoint(i)[1] + 2);
    }
  }
  const MergedPieces before = merged(halves(Ids::points), nullptr);
  Pieces renamed = halves(Ids::points);
  for (const auto& piece : renamed) {
    vtkDataArray& ids = *piece->GetPointData()->GetGlobalIds();
    for (vtkIdType i = 0; i < ids.GetNumberOfTuples(); ++i) ids.SetTuple1(i, 24 - ids.GetTuple1(i));
  }
  expect_square(merged(renamed, &before));
  EXPECT_EQ(value(*merged(renamed, &before).mesh->GetPointData(), "at", 0), 24);
}

namespace {

/// Numbers of the whole square's rows, or of a piece's points, as an array of three components.
vtkSmartPointer<vtkDoubleArray> vectors(const char* name, vtkIdType rows,
                                        const std::function<double(vtkIdType)>& row) {
  const auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < rows; ++i) array->InsertNextTuple3(row(i), 0, 0);
  return array;
}

vtkSmartPointer<vtkDoubleArray> own_numbers(const char* name, vtkPolyData& piece) {
  return vectors(name, piece.GetNumberOfPoints(),
                 [&](vtkIdType i) { return value(*piece.GetPointData(), "at", i); });
}

}  // namespace

TEST(MergedPieces, BringARestPoseOnPointsAlong) {
  for (const Ids ids : {Ids::none, Ids::points}) {
    Pieces pieces = halves(ids);
    for (const auto& piece : pieces) {
      piece->GetPointData()->AddArray(own_numbers(kRestPose, *piece));
    }
    const MergedPieces found = merged(pieces, nullptr);
    const auto rest = rest_of(*found.mesh, positions_of(*found.mesh, "mesh"), "mesh");
    ASSERT_TRUE(rest);
    for (vtkIdType i = 0; i < found.mesh->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(rest->positions(i, 0), value(*found.mesh->GetPointData(), "at", i));
    }
  }
}

TEST(MergedPieces, AreRefusedWithARestPoseThatStayedBehind) {
  // Rows of the whole mesh, whatever the ids are: they may have been made after it was distributed.
  const auto whole =
      vectors(kRestPose, kSize * kSize, [](vtkIdType i) { return static_cast<double>(i); });
  for (const Ids ids : {Ids::none, Ids::points, Ids::points_and_cells}) {
    Pieces pieces = halves(ids);
    pieces[1]->GetFieldData()->AddArray(whole);
    EXPECT_THAT(refusal(pieces), HasSubstr("the rest pose is field data (mimetra_rest)"));
    EXPECT_THAT(refusal(pieces), HasSubstr("read the file by mimetra Sequence"));
    // As many rows as the piece has points may be those of another piece.
    pieces = halves(ids);
    for (const auto& piece : pieces) {
      piece->GetFieldData()->AddArray(own_numbers(kRestPose, *piece));
    }
    EXPECT_THAT(refusal(pieces), HasSubstr("the rest pose is field data (mimetra_rest)"));
  }
}

TEST(MergedPieces, AreRefusedWithRestPosesOfSomeOnly) {
  for (const char* name : {kRestPose, kPlaced, kDisplacement}) {
    Pieces pieces = halves();
    pieces[1]->GetPointData()->AddArray(own_numbers(name, *pieces[1]));
    EXPECT_THAT(refusal(pieces),
                HasSubstr("the point data " + std::string(name) + " of process 1 are not on all"));
    pieces[0]->GetPointData()->AddArray(own_numbers(name, *pieces[0]));
    EXPECT_EQ(refusal(pieces), "");
  }
}

TEST(MergedPieces, KnowIdsThatDoublesCannotTellApart) {
  constexpr vtkIdType kLarge = vtkIdType{1} << 53;  // and the next one is no double
  const auto shift = [](vtkDataArray* ids) {
    auto& whole = *vtkIdTypeArray::SafeDownCast(ids);
    for (vtkIdType i = 0; i < whole.GetNumberOfTuples(); ++i) {
      whole.SetValue(i, whole.GetValue(i) + kLarge);
    }
  };
  Pieces pieces = halves(Ids::points_and_cells);
  for (const auto& piece : pieces) {
    shift(piece->GetPointData()->GetGlobalIds());
    shift(piece->GetCellData()->GetGlobalIds());
  }
  const MergedPieces found = merged(pieces, nullptr);
  expect_square(found);
  for (vtkIdType i = 0; i < found.mesh->GetNumberOfPoints(); ++i) {
    EXPECT_EQ(value(*found.mesh->GetPointData(), "at", i), static_cast<double>(i));
  }
}
