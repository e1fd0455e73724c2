#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Weld, JoinsVerticesInOnePlaceToTheLowest) {
  const Weld weld = Weld::exact(seam());
  EXPECT_THAT(weld.representative, ElementsAre(0, 1, 2, 1, 1, 0));
  EXPECT_EQ(weld.count, 3);
}

TEST(Weld, LeavesNeighbouringNumbersApart) {
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
  EXPECT_THAT(parting_vertices(seam_that_opens(0.5), Weld::exact(seam()), 0.25), ElementsAre(3));
}

TEST(PartingVertices, WithinTheToleranceAreNone) {
  EXPECT_THAT(parting_vertices(seam_that_opens(0.25), Weld::exact(seam()), 0.25), IsEmpty());
}

TEST(PartingVertices, OfAnotherVertexCountAreRefused) {
  EXPECT_THAT(
      [] { parting_vertices(seam_that_opens(0), Weld::none(5), 0); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("weld of 5 vertices for a sequence of 6")));
}

}  // namespace
}  // namespace mimetra
