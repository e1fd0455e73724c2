#include "plugins/paraview/mimetra/filters/parcel.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <vtkMultiProcessStream.h>

#include "plugins/paraview/mimetra/filters/piece_answer.h"
#include "tests/paraview/made_pieces.h"

using namespace mimetra;
using namespace mimetra::test;

TEST(PieceAnswer, GivesEachPieceItsRowsAndLeavesTheRest) {
  for (const Ids ids : {Ids::none, Ids::points_and_cells}) {
    const Mesh mesh = square();
    const MergedPieces found = merged(scattered(*mesh, 5, ids), nullptr);
    vtkNew<vtkPolyData> output;
    output->ShallowCopy(found.mesh);
    vtkDataSetAttributes& on_points = *output->GetPointData();
    const auto twice = [&](vtkIdType i) { return 2 * value(*found.mesh->GetPointData(), "at", i); };
    on_points.AddArray(numbers<vtkDoubleArray>("twice", output->GetNumberOfPoints(), twice));
    output->GetCellData()->RemoveArray("on");
    ASSERT_TRUE(lies_on(*output, *found.mesh));
    for (std::size_t p = 0; p < found.pieces.size(); ++p) {
      vtkPolyData& piece = *found.pieces[p];
      Parcel parcel;
      put_answer(parcel, *output, found, p);
      vtkNew<vtkPolyData> shown;
      take_answer(parcel, piece, *shown);
      EXPECT_EQ(shown->GetPolys(), piece.GetPolys());
      EXPECT_EQ(shown->GetPoints(), piece.GetPoints());
      EXPECT_EQ(shown->GetPointData()->GetArray("at"), piece.GetPointData()->GetArray("at"));
      EXPECT_FALSE(shown->GetCellData()->HasArray("on"));
      for (vtkIdType i = 0; i < shown->GetNumberOfPoints(); ++i) {
        EXPECT_EQ(value(*shown->GetPointData(), "twice", i),
                  2 * value(*piece.GetPointData(), "at", i));
      }
    }
  }
}

TEST(Parcel, HasRoomForWordsOfAnyLength) {
  std::vector<double> times(10000);
  std::iota(times.begin(), times.end(), 0);
  vtkMultiProcessStream inner, outer;
  put_times(inner, times);
  put_words(outer, inner);
  outer << 7;
  vtkMultiProcessStream found = taken_words(outer);
  EXPECT_EQ(taken_times(found), times);
  int after = 0;
  outer >> after;
  EXPECT_EQ(after, 7);
}

TEST(Parcel, GivesBackThePieceThatWasPutIn) {
  const Pieces pieces = halves(Ids::points_and_cells);
  Parcel parcel = packed(*pieces[1]);
  const Mesh found = unpacked(parcel);
  EXPECT_EQ(found->GetNumberOfPoints(), pieces[1]->GetNumberOfPoints());
  EXPECT_EQ(corners_of(*found, 3), corners_of(*pieces[1], 3));
  EXPECT_EQ(found->GetPointData()->GetGlobalIds()->GetTuple1(4),
            pieces[1]->GetPointData()->GetGlobalIds()->GetTuple1(4));
  EXPECT_EQ(value(*found->GetCellData(), "on", 2), value(*pieces[1]->GetCellData(), "on", 2));
}
