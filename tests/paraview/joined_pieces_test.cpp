#include "plugins/paraview/mimetra/filters/joined_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>

#include "plugins/paraview/mimetra/filters/processes.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;
using testing::HasSubstr;

namespace {

using Mesh = vtkSmartPointer<vtkPolyData>;

constexpr int kSize = 5;
constexpr vtkIdType kPoints = kSize * kSize;
constexpr vtkIdType kLine = 0;  ///< the only cell that is a line
constexpr vtkIdType kCells = 1 + (kSize - 1) * (kSize - 1);
/// The numbers of ids before and after this one are no doubles.
constexpr vtkIdType kLarge = (vtkIdType{1} << 53) + 1;

/// Gives point or cell data the array `name`, and the same numbers from kLarge on as global ids.
void set_numbers(vtkDataSetAttributes& data, const char* name,
                 const std::vector<vtkIdType>& numbers) {
  vtkNew<vtkDoubleArray> array;
  vtkNew<vtkIdTypeArray> ids;
  array->SetName(name);
  ids->SetName("ids");
  for (const vtkIdType number : numbers) {
    array->InsertNextValue(static_cast<double>(number));
    ids->InsertNextValue(kLarge + number);
  }
  data.AddArray(array);
  data.SetGlobalIds(ids);
}

/// A piece of a bent square of quads with a line along its diagonal: its cells of these numbers, in
/// this order, and their points. The points have their numbers as data `at`, the cells as `on`.
Mesh piece_of(std::vector<vtkIdType> numbers) {
  std::ranges::stable_sort(numbers, {}, [](vtkIdType cell) { return cell != kLine; });
  const auto piece = Mesh::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines, quads;
  std::vector<vtkIdType> known;
  for (const vtkIdType cell : numbers) {
    const vtkIdType v = (cell - 1) / (kSize - 1) * kSize + (cell - 1) % (kSize - 1);
    vtkNew<vtkIdList> corners;
    const auto all = cell == kLine ? std::vector<vtkIdType>{0, kSize + 1}
                                   : std::vector<vtkIdType>{v, v + 1, v + kSize + 1, v + kSize};
    for (const vtkIdType corner : all) {
      const auto found = std::ranges::find(known, corner);
      corners->InsertNextId(found - known.begin());
      if (found != known.end()) continue;
      known.push_back(corner);
      const auto row = static_cast<double>(corner / kSize);
      const auto column = static_cast<double>(corner % kSize);
      points->InsertNextPoint(column, row, std::sin(row * 0.7 + column));
    }
    (cell == kLine ? lines : quads)->InsertNextCell(corners);
  }
  piece->SetPoints(points);
  piece->SetLines(lines);
  piece->SetPolys(quads);
  set_numbers(*piece->GetPointData(), "at", known);
  set_numbers(*piece->GetCellData(), "on", numbers);
  return piece;
}

std::vector<vtkIdType> range(vtkIdType begin, vtkIdType end) {
  std::vector<vtkIdType> numbers(static_cast<std::size_t>(end - begin));
  std::iota(numbers.begin(), numbers.end(), begin);
  return numbers;
}

/// The halves of the square.
Pieces halves() {
  return {piece_of(range(0, 9)), piece_of(range(9, kCells))};
}

/// Each cell in one of three pieces; a fourth is empty.
Pieces scattered(unsigned seed) {
  std::mt19937 random(seed);
  std::array<std::vector<vtkIdType>, 3> cells;
  std::vector<vtkIdType> order = range(0, kCells);
  std::shuffle(order.begin(), order.end(), random);
  for (const vtkIdType cell : order) cells[random() % cells.size()].push_back(cell);
  return {piece_of(cells[0]), piece_of(cells[1]), Mesh::New(), piece_of(cells[2])};
}

double value(vtkDataSetAttributes& data, const char* name, vtkIdType i) {
  return data.GetArray(name)->GetTuple1(i);
}

std::vector<vtkIdType> corners_of(vtkPolyData& mesh, vtkIdType cell) {
  vtkNew<vtkIdList> corners;
  mesh.GetCellPoints(cell, corners);
  return {corners->begin(), corners->end()};
}

/// The point of a piece that has a number in the square.
vtkIdType local(vtkPolyData& piece, vtkIdType number) {
  for (vtkIdType i = 0; i < piece.GetNumberOfPoints(); ++i) {
    if (value(*piece.GetPointData(), "at", i) == static_cast<double>(number)) return i;
  }
  return -1;
}

void move(vtkPolyData& mesh, vtkIdType point, double by) {
  std::array<double, 3> position = {};
  mesh.GetPoint(point, position.data());
  position[0] += by;
  mesh.GetPoints()->SetPoint(point, position.data());
}

void mark_ghosts(vtkDataSetAttributes& data, vtkIdType first) {
  vtkNew<vtkUnsignedCharArray> marks;
  marks->SetName(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < data.GetNumberOfTuples(); ++i) marks->InsertNextValue(i >= first);
  data.AddArray(marks);
}

void expect_square(vtkPolyData& mesh) {
  const Mesh whole = piece_of(range(1, kCells));
  ASSERT_EQ(mesh.GetNumberOfPoints(), kPoints);
  ASSERT_EQ(mesh.GetNumberOfCells(), kCells);
  for (vtkIdType i = 0; i < kPoints; ++i) {
    EXPECT_EQ(value(*mesh.GetPointData(), "at", i), static_cast<double>(i));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(mesh.GetPoint(i)[axis], whole->GetPoint(local(*whole, i))[axis]);
    }
  }
  for (vtkIdType i = 0; i < kCells; ++i) {
    EXPECT_EQ(value(*mesh.GetCellData(), "on", i), static_cast<double>(i));
    if (i == kLine) continue;
    const vtkIdType v = (i - 1) / (kSize - 1) * kSize + (i - 1) % (kSize - 1);
    EXPECT_THAT(corners_of(mesh, i), testing::ElementsAre(v, v + 1, v + kSize + 1, v + kSize));
  }
}

std::string refusal(const Pieces& pieces) {
  try {
    joined(pieces, "the target");
  } catch (const MismatchError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(JoinedPieces, AreTheOnlyPieceWithPointsIfItHasNoIds) {
  const Mesh piece = piece_of({7, 3, 5});
  piece->GetPointData()->RemoveArray("ids");
  const JoinedPieces found = joined({Mesh::New(), piece, Mesh::New()}, "the mesh");
  EXPECT_EQ(found.mesh, piece);
  EXPECT_EQ(part_of(*piece, found, 1), piece);
  EXPECT_EQ(part_of(*piece, found, 0)->GetNumberOfPoints(), 0);
  EXPECT_EQ(joined({Mesh::New(), Mesh::New()}, "the mesh").mesh->GetNumberOfPoints(), 0);
}

TEST(JoinedPieces, AreTheMeshInTheOrderOfItsIds) {
  for (unsigned seed = 0; seed < 20; ++seed) expect_square(*joined(scattered(seed), "").mesh);
  std::vector<vtkIdType> backwards = range(0, kCells);
  std::ranges::reverse(backwards);
  expect_square(*joined({Mesh::New(), piece_of(backwards)}, "").mesh);
}

TEST(JoinedPieces, AreRefusedWithoutGlobalIds) {
  Pieces pieces = halves();
  pieces[1]->GetPointData()->RemoveArray("ids");
  const std::string expected =
      "process 1 has a piece of the target without global ids; apply the filter Generate Global "
      "Ids before distributing it";
  EXPECT_EQ(refusal(pieces), expected);
  pieces = halves();
  pieces[1]->GetCellData()->RemoveArray("ids");
  EXPECT_EQ(refusal(pieces), expected);
  pieces = {Mesh::New(), piece_of(range(0, kCells))};
  pieces[1]->GetPointData()->RemoveArray("ids");
  mark_ghosts(*pieces[1]->GetCellData(), 16);
  EXPECT_EQ(refusal(pieces), expected);
}

TEST(JoinedPieces, AreRefusedIfTheirIdsHaveOtherTypes) {
  Pieces pieces = halves();
  vtkNew<vtkDoubleArray> ids;
  ids->DeepCopy(pieces[1]->GetPointData()->GetGlobalIds());
  pieces[1]->GetPointData()->SetGlobalIds(ids);
  EXPECT_THAT(refusal(pieces), HasSubstr("apply the filter Generate Global Ids"));
}

TEST(JoinedPieces, MayBePointsWithoutCells) {
  Pieces pieces = halves();
  for (const auto& piece : pieces) {
    piece->SetPolys(vtkNew<vtkCellArray>());
    piece->SetLines(vtkNew<vtkCellArray>());
    piece->GetCellData()->Initialize();
  }
  EXPECT_EQ(joined(pieces, "").mesh->GetNumberOfPoints(), kPoints);
}

TEST(JoinedPieces, KeepPointsAtOnePositionApartIfTheirIdsDiffer) {
  Pieces pieces = halves();
  auto& ids = *vtkIdTypeArray::SafeDownCast(pieces[1]->GetPointData()->GetGlobalIds());
  ids.SetValue(local(*pieces[1], 2 * kSize), kLarge + 100);
  EXPECT_EQ(joined(pieces, "").mesh->GetNumberOfPoints(), kPoints + 1);
}

TEST(JoinedPieces, MayHavePositionsThatDifferByRounding) {
  Pieces pieces = halves();
  const vtkIdType seam = local(*pieces[1], 2 * kSize);
  move(*pieces[1], seam, 1e-7);
  EXPECT_EQ(joined(pieces, "").mesh->GetNumberOfPoints(), kPoints);
  move(*pieces[1], seam, 1e-4);
  EXPECT_THAT(refusal(pieces), HasSubstr("names points at different positions, one on process 1"));
}

TEST(JoinedPieces, AreRefusedIfIdsContradict) {
  Mesh piece = piece_of({1, 2, 3});
  auto* ids = vtkIdTypeArray::SafeDownCast(piece->GetPointData()->GetGlobalIds());
  ids->SetValue(3, ids->GetValue(2));
  EXPECT_THAT(refusal({piece, Mesh::New()}), HasSubstr("names two points of process 0"));
  Pieces pieces = halves();
  ids = vtkIdTypeArray::SafeDownCast(pieces[1]->GetCellData()->GetGlobalIds());
  ids->SetValue(2, kLarge + 3);
  EXPECT_THAT(refusal(pieces), HasSubstr("names two cells, and neither is a ghost"));
}

TEST(JoinedPieces, AreRefusedIfCellsUsePointsThatDoNotExist) {
  Pieces pieces = halves();
  pieces[0]->GetPolys()->ReplaceCellAtId(0, {0, 1, 2, 99});
  EXPECT_EQ(refusal(pieces), "the cells of process 0 use points that it does not have");
}

TEST(JoinedPieces, LoseGhostsWhichGetTheValuesOfTheirOwners) {
  std::vector<vtkIdType> lower = range(0, 9), upper = range(9, kCells);
  lower.insert(lower.end(), {9, 10});
  upper.insert(upper.end(), {8, 7});
  Pieces pieces = {piece_of(lower), piece_of(upper)};
  EXPECT_THAT(refusal(pieces), HasSubstr("neither is a ghost"));
  mark_ghosts(*pieces[0]->GetCellData(), 9);
  mark_ghosts(*pieces[1]->GetCellData(), 8);
  expect_square(*joined(pieces, "").mesh);
  // A cell that is no ghost owns its points, marked or not.
  mark_ghosts(*pieces[1]->GetPointData(), 0);
  const JoinedPieces found = joined(pieces, "");
  expect_square(*found.mesh);
  EXPECT_FALSE(found.mesh->GetCellData()->HasArray(vtkDataSetAttributes::GhostArrayName()));
  found.mesh->GetCellData()->GetArray("on")->SetTuple1(9, -9);
  const Mesh part = part_of(*found.mesh, found, 0);
  EXPECT_EQ(value(*part->GetCellData(), "on", 9), -9);
  EXPECT_EQ(part->GetCellGhostArray(), pieces[0]->GetCellGhostArray());
}

TEST(JoinedPieces, AreRefusedWithAGhostOfNoProcess) {
  Pieces pieces = {piece_of({1, 2, 3, 4, 9}), piece_of({5, 6, 7, 8})};
  mark_ghosts(*pieces[0]->GetCellData(), 4);
  EXPECT_THAT(refusal(pieces), HasSubstr("names only ghosts; apply Remove Ghost Information"));
}

TEST(JoinedPieces, BringARestPoseOnPointsAlongButNotInFields) {
  Pieces pieces = halves();
  for (const bool in_fields : {false, true}) {
    for (const auto& piece : pieces) {
      vtkNew<vtkDoubleArray> rest;
      rest->SetName(kRestPose);
      rest->SetNumberOfComponents(3);
      for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i) {
        rest->InsertNextTuple3(value(*piece->GetPointData(), "at", i), 0, 0);
      }
      piece->GetPointData()->RemoveArray(kRestPose);
      (in_fields ? piece->GetFieldData() : piece->GetPointData())->AddArray(rest);
    }
    if (in_fields) break;
    const Mesh mesh = joined(pieces, "").mesh;
    for (vtkIdType i = 0; i < kPoints; ++i) {
      EXPECT_EQ(mesh->GetPointData()->GetArray(kRestPose)->GetTuple3(i)[0], i);
    }
  }
  EXPECT_THAT(refusal(pieces), HasSubstr("the rest pose of the target is field data"));
}

TEST(JoinedPieces, GiveEachPieceItsPartOfAnOutput) {
  const Pieces pieces = scattered(5);
  const JoinedPieces found = joined(pieces, "");
  vtkNew<vtkPolyData> output;
  output->ShallowCopy(found.mesh);
  vtkNew<vtkDoubleArray> twice;
  twice->SetName("twice");
  for (vtkIdType i = 0; i < kPoints; ++i) twice->InsertNextValue(2. * static_cast<double>(i));
  output->GetPointData()->AddArray(twice);
  output->GetCellData()->RemoveArray("on");
  ASSERT_TRUE(lies_on(*output, *found.mesh));
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Mesh part = part_of(*output, found, p);
    EXPECT_EQ(part->GetNumberOfPoints(), pieces[p]->GetNumberOfPoints());
    EXPECT_EQ(part->GetNumberOfCells(), pieces[p]->GetNumberOfCells());
    EXPECT_FALSE(part->GetCellData()->HasArray("on"));
    for (vtkIdType i = 0; i < part->GetNumberOfCells(); ++i) {
      EXPECT_EQ(corners_of(*part, i), corners_of(*pieces[p], i));
    }
    for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(value(*part->GetPointData(), "twice", i),
                2 * value(*pieces[p]->GetPointData(), "at", i));
      EXPECT_EQ(part->GetPoint(i)[0], pieces[p]->GetPoint(i)[0]);
    }
    if (part->GetNumberOfPoints() == 0) continue;
    auto* ids = vtkIdTypeArray::SafeDownCast(part->GetPointData()->GetGlobalIds());
    ASSERT_TRUE(ids);
    EXPECT_EQ(ids->GetValue(0),
              static_cast<vtkIdTypeArray*>(pieces[p]->GetPointData()->GetGlobalIds())->GetValue(0));
  }
}

TEST(Processes, SendTimesOfAnyNumber) {
  std::vector<double> times(10000);
  std::iota(times.begin(), times.end(), 0);
  vtkMultiProcessStream words;
  put_times(words, times);
  EXPECT_EQ(taken_times(words), times);
}
