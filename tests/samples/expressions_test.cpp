#include <gmock/gmock.h>

#include <mimetra/samples/head_grid.h>

#include "head_fixture.h"

namespace mimetra::test {
namespace {

constexpr double kFewestQuality = 1e-3;

class HeadExpression : public ::testing::TestWithParam<int> {
 protected:
  Positions moved() const { return field(head().expressions(), GetParam()); }
  Positions pose() const { return head().mean() + moved(); }
};

TEST_P(HeadExpression, MovesLessThanFourTenthsOfTheVertices) {
  const auto moving = (moved().rowwise().norm().array() > 0).count();
  EXPECT_GT(moving, 30);
  EXPECT_LT(moving, 0.4 * head().vertices());
}

TEST_P(HeadExpression, MovesByMillimetres) {
  EXPECT_GT(moved().rowwise().norm().maxCoeff(), 2);
  EXPECT_LT(moved().rowwise().norm().maxCoeff(), 40);
}

TEST_P(HeadExpression, LeavesCrownBackAndNeckExactlyStill) {
  const Positions field = moved();
  for (int v = 0; v < head().vertices(); ++v) {
    const auto p = head().mean().row(v);
    const bool far_from_the_face = p.y() > 60 || p.z() < -10 || p.y() < -135;
    EXPECT_TRUE(!far_from_the_face || field.row(v).isZero(0)) << v;
  }
}

TEST_P(HeadExpression, LeavesTheEyeballsExactlyStill) {
  const Positions field = moved();
  const ConnectedComponents parts =
      connected_components(head().vertices(), head().connectivity().triangles);
  for (int v = 0; v < head().vertices(); ++v) {
    if (parts.of_vertex[static_cast<std::size_t>(v)] != 0) {
      EXPECT_TRUE(field.row(v).isZero(0)) << v;
    }
  }
}

TEST_P(HeadExpression, HasNoDegenerateTriangle) {
  EXPECT_GT(worst_quality(pose()), kFewestQuality);
}

TEST_P(HeadExpression, FlipsNoTriangle) {
  EXPECT_EQ(flipped(head().mean(), pose()), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, HeadExpression, ::testing::Range(0, 12), [](const auto& parameter) {
  return head().expressions().names[static_cast<std::size_t>(parameter.param)];
});

TEST(HeadExpressions, AreTwelve) {
  EXPECT_EQ(head().expressions().size(), 12);
}

/// The expression `name` seen in a mirror.
Positions mirrored(const std::string& name) {
  const std::vector<int> mirror = mirror_vertices();
  const Positions original = field(name);
  Positions result(original.rows(), 3);
  for (int v = 0; v < original.rows(); ++v) {
    result.row(mirror[static_cast<std::size_t>(v)]) =
        original.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
  }
  return result;
}

TEST(HeadExpressions, OfLeftAndRightAreMirrorImages) {
  for (const std::string name : {"eyeBlink", "eyeWide", "browDown", "mouthSmile"}) {
    EXPECT_EQ(mirrored(name + "_L"), field(name + "_R")) << name;
  }
}

TEST(HeadExpressions, OfBothSidesAreSymmetric) {
  for (const std::string name : {"browInnerUp", "jawOpen", "mouthPucker", "cheekPuff"}) {
    EXPECT_EQ(mirrored(name), field(name)) << name;
  }
}

TEST(HeadExpressions, CalledLeftMoveTheHeadsOwnLeft) {
  const Positions smile = field("mouthSmile_L");
  Eigen::Index most;
  smile.rowwise().norm().maxCoeff(&most);
  EXPECT_GT(head().mean()(most, 0), 10);
}

TEST(HeadExpressions, JawOpenPartsTheLips) {
  const Positions& mean = head().mean();
  const Positions open = mean + field("jawOpen");
  double lower_lip = -1e9, upper_lip = 1e9;
  for (int v = 0; v < mean.rows(); ++v) {
    if (mean(v, 0) != 0 || std::abs(mean(v, 1) + 66) > 12 || mean(v, 2) < 80) continue;
    const bool moves = open(v, 1) < mean(v, 1) - 5;
    if (moves) lower_lip = std::max(lower_lip, open(v, 1));
    if (!moves) upper_lip = std::min(upper_lip, open(v, 1));
  }
  EXPECT_GT(upper_lip - lower_lip, 15);
}

TEST(HeadExpressions, BlinkNeverEntersTheEyeball) {
  const Eigen::RowVector3d center(31, -0.5, 60.5);
  const samples::HeadGrid grid = samples::head_grid();
  const Positions blink = field("eyeBlink_L");
  for (const double weight : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Positions pose = head().mean() + weight * blink;
    for (int v = 0; v < pose.rows(); ++v) {
      if (grid.vertices[static_cast<std::size_t>(v)].part != samples::HeadVertex::Part::skin)
        continue;
      EXPECT_GE((pose.row(v) - center).norm(), 13) << v << " at " << weight;
    }
  }
}

}  // namespace
}  // namespace mimetra::test
