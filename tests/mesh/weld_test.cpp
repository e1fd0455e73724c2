#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/streams.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// Vertices 1, 3 and 4 in one place, 0 and 5 in another.
Positions seam() {
  Positions positions(6, 3);
  positions << 0, 0, 0, 1, 2, 3, 1, 2, 4, 1, 2, 3, 1, 2, 3, -0.0, 0, -0.0;
  return positions;
}

TEST(Weld, JoinsVerticesInOnePlaceAndNoneBesideItToTheLowest) {
  const Weld weld = Weld::exact(seam());
  EXPECT_THAT(weld.representative, ElementsAre(0, 1, 2, 1, 1, 0));
  EXPECT_EQ(weld.count, 3);
  Positions positions = Positions::Ones(2, 3);
  positions(1, 2) = std::nextafter(1.0, 2.0);
  EXPECT_EQ(Weld::exact(positions).count, 0);
}

TEST(Weld, OfNothingLeavesAllVerticesAlone) {
  const Weld weld = Weld::none(3);
  EXPECT_THAT(weld.representative, ElementsAre(0, 1, 2));
  EXPECT_EQ(weld.count, 0);
}

TEST(Weld, NamesAVertexThatIsNotFinite) {
  Positions positions = seam();
  positions(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { Weld::exact(positions); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("vertex 2 is not finite")));
}

TEST(Weld, CarriesTrianglesToRepresentatives) {
  Triangles triangles(2, 3), expected(2, 3);
  triangles << 0, 2, 3, 4, 2, 5;
  expected << 0, 2, 1, 1, 2, 0;
  EXPECT_EQ(Weld::exact(seam()).welded(triangles), expected);
}

MeshSequence seam_that_opens(double gap) {
  const Positions rest = seam();
  Frames frames = rest.reshaped<Eigen::RowMajor>().transpose().replicate(2, 1);
  frames(1, 3 * 3 + 2) += gap;
  return {Connectivity::from_triangles(6, Triangles(0, 3)), frames, {}, rest};
}

TEST(PartingVertices, AreTheWeldedOnesThatLeaveTheirRepresentative) {
  const Weld weld = Weld::exact(seam());
  EXPECT_THAT(parting_vertices(seam_that_opens(0.5), weld, 0.25), ElementsAre(3));
  EXPECT_THAT(parting_vertices(seam_that_opens(0.25), weld, 0.25), IsEmpty());
  const test::Stream stream(seam_that_opens(0.5));
  for (const int threads : {1, 3}) {
    EXPECT_THAT(parting_vertices(stream, weld, 0.25, Context().with_threads(threads)),
                ElementsAre(3));
  }
}

TEST(PartingVertices, OfAnotherVertexCountAreRefused) {
  EXPECT_THAT(
      [] { parting_vertices(seam_that_opens(0), Weld::none(5), 0); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("weld of 5 vertices for a sequence of 6")));
}

TEST(PartingVertices, OfNothingWeldedNeedNoFrame) {
  const test::Stream stream(seam_that_opens(0.5));
  parting_vertices(stream, Weld::none(6), 0);
  EXPECT_EQ(stream.frames_read(), 0);
}

/// Vertices that are at one place at rest; `offsets` (F x N) of x in each frame.
MeshSequence parting_along_x(const Eigen::MatrixXd& offsets) {
  const auto n = static_cast<int>(offsets.cols());
  Frames frames = Frames::Zero(offsets.rows(), 3 * n);
  for (int v = 0; v < n; ++v) frames.col(3 * v) = offsets.col(v);
  return {Connectivity::from_triangles(n, Triangles(0, 3)), frames, {}, Positions::Zero(n, 3)};
}

Weld staying(const Eigen::MatrixXd& offsets, double tolerance) {
  const MeshSequence sequence = parting_along_x(offsets);
  return staying_together(sequence, Weld::exact(sequence.rest()), tolerance);
}

TEST(StayingTogether, SplitsWhatPartsInAnyFrame) {
  Eigen::MatrixXd offsets(3, 5);
  offsets << 0, 0, 0, 0, 0,  //
      0, 1, 0, 1, 0,         //
      0, 0, 0, 0, 0;
  const Weld weld = staying(offsets, 0.25);
  EXPECT_THAT(weld.representative, ElementsAre(0, 1, 0, 1, 0));
  EXPECT_EQ(weld.count, 3);
}

TEST(StayingTogether, SplitsAsOftenAsItHasTo) {
  Eigen::MatrixXd offsets(2, 6);
  offsets << 0, 0, 0, 0, 0, 0,  //
      0, 1, 1, 2, 2, 3;
  const Weld weld = staying(offsets, 0.25);
  EXPECT_THAT(weld.representative, ElementsAre(0, 1, 1, 3, 3, 5));
  EXPECT_EQ(weld.count, 2);
}

TEST(StayingTogether, MeasuresFromTheLowestAndNotAlongAChain) {
  Eigen::MatrixXd offsets(1, 4);
  offsets << 0, 0.2, 0.4, 0.6;
  EXPECT_THAT(staying(offsets, 0.25).representative, ElementsAre(0, 0, 2, 2));
}

TEST(StayingTogether, ReadsAStreamOnceWhereNothingParts) {
  const MeshSequence sequence = seam_that_opens(0);
  const test::Stream stream(sequence);
  const Weld weld = staying_together(stream, Weld::exact(seam()), 0);
  EXPECT_EQ(weld.representative, Weld::exact(seam()).representative);
  EXPECT_EQ(stream.frames_read(), sequence.frames());
}

TEST(StayingTogether, ReportsGrowingProgressAndStopsWhenAsked) {
  Eigen::MatrixXd offsets(1, 3);
  offsets << 0, 1, 1;
  const MeshSequence sequence = parting_along_x(offsets);
  const Weld weld = Weld::exact(sequence.rest());
  std::vector<double> shares;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  staying_together(sequence, weld, 0, Context().with_progress(keep));
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_LT(shares.back(), 1);
  const Context stopping = Context().with_progress([](double share) { return share < 0.6; });
  EXPECT_THROW(staying_together(sequence, weld, 0, stopping), Cancelled);
}

class WeldCheck : public testing::Test {
 protected:
  Weld weld_ = Weld::exact(seam());

  void expect(const char* message) const {
    EXPECT_THAT([this] { weld_.check(seam()); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  }
};

TEST_F(WeldCheck, AcceptsVerticesAtOnePlace) {
  EXPECT_NO_THROW(weld_.check(seam()));
  EXPECT_NO_THROW(Weld::none(6).check(seam()));
}

TEST_F(WeldCheck, NamesBothVertexCounts) {
  weld_ = Weld::none(5);
  expect("a weld of 5 vertices for 6");
}

TEST_F(WeldCheck, NamesAVertexThatIsNotWeldedToTheLowest) {
  weld_.representative[1] = 3;
  expect("vertex 1 is welded to 3, expected the lowest");
  weld_.representative[1] = -1;
  expect("vertex 1 is welded to -1, expected the lowest");
  weld_.representative[1] = 1;
  weld_.representative[4] = 3;
  expect("vertex 4 is welded to 3, expected the lowest");
}

TEST_F(WeldCheck, NamesAVertexAtAnotherPlace) {
  weld_.representative[2] = 1;
  expect("vertex 2 is welded to 1, which is at another place");
}

}  // namespace
}  // namespace mimetra
