#include "toolkit/correspondence/markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Marker> kOctahedron = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};

auto refused(const std::vector<Marker>& markers, const std::string& why) {
  const Positions sphere = test::sphere(1).positions;
  EXPECT_THAT([&] { check_markers(markers, sphere, sphere); },
              ThrowsMessage<MismatchError>(HasSubstr(why)));
}

TEST(Markers, NeedTheirVertices) {
  refused({{0, 0}, {18, 1}, {2, 2}, {4, 4}},
          "marker 2: vertex 18 of the source, which has vertices 0 to 17");
  refused({{0, 0}, {1, -1}, {2, 2}, {4, 4}}, "marker 2: vertex -1 of the target");
}

TEST(Markers, HaveEachVertexOnce) {
  refused({{0, 0}, {1, 1}, {2, 2}, {0, 4}}, "marker 4: vertex 0 of the source is in marker 1 too");
  refused({{0, 0}, {1, 1}, {2, 2}, {4, 1}}, "marker 4: vertex 1 of the target is in marker 2 too");
}

TEST(Markers, AreAtLeastFourAndNotInOnePlane) {
  refused({{0, 0}, {2, 2}, {4, 4}}, "3 markers, expected at least 4");
  refused({{0, 0}, {1, 1}, {2, 2}, {3, 3}}, "the markers lie in one plane of the source");
}

TEST(Markers, ThatAnAffineMapExplainsAreFineAndLeaveNothing) {
  const Positions source = test::sphere(1).positions;
  Eigen::Matrix3d shear;
  shear << 2, 1, 0, 0, 1, 0.5, 0, 0, 3;
  const Positions target = source * shear;
  EXPECT_NO_THROW(check_markers(kOctahedron, source, target));
  EXPECT_LT(affine_residual(kOctahedron, source, target), 1e-14);
}

}  // namespace
}  // namespace mimetra
