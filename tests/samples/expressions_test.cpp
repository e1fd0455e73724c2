#include <gmock/gmock.h>

#include "samples/head/anatomy.h"
#include "tests/samples/head_fixture.h"
#include "toolkit/mesh/alignment.h"

namespace mimetra::test {
namespace {

class HeadExpression : public ::testing::TestWithParam<int> {
 protected:
  Positions moved() const { return field(head().expressions(), GetParam()); }
  Positions pose() const { return head().mean() + moved(); }
};

TEST_P(HeadExpression, MovesLessThanFourTenthsOfTheVerticesByMillimetres) {
  const Eigen::VectorXd distances = moved().rowwise().norm();
  const auto moving = (distances.array() > 0).count();
  EXPECT_GT(moving, 30);
  EXPECT_LT(moving, 0.4 * head().vertices());
  EXPECT_GT(distances.maxCoeff(), 2);
  EXPECT_LT(distances.maxCoeff(), 40);
}

TEST_P(HeadExpression, LeavesCrownBackNeckAndEyeballsExactlyStill) {
  const Positions field = moved();
  for (int v = 0; v < head().vertices(); ++v) {
    const auto p = head().mean().row(v);
    const bool far_from_the_face = p.y() > 60 || p.z() < -10 || p.y() < -135;
    if (!far_from_the_face && part_of(v) != samples::HeadVertex::Part::eyeball) continue;
    EXPECT_TRUE(field.row(v).isZero(0)) << v;
  }
}

TEST_P(HeadExpression, MovesTeethAndTongueAsBonesOnly) {
  const Positions field = moved();
  const bool opens = head().expressions().names[static_cast<std::size_t>(GetParam())] == "jawOpen";
  for (const int jaw : {1, -1}) {
    std::vector<int> bone;
    for (int v = 0; v < head().vertices(); ++v) {
      const samples::HeadVertex& vertex = grid().vertices[static_cast<std::size_t>(v)];
      const bool hard = vertex.part == samples::HeadVertex::Part::teeth ||
                        vertex.part == samples::HeadVertex::Part::tongue;
      if (hard && vertex.rim == jaw) bone.push_back(v);
    }
    ASSERT_FALSE(bone.empty());
    const Positions rest = head().mean()(bone, Eigen::all), offsets = field(bone, Eigen::all);
    if (jaw > 0 || !opens) {
      EXPECT_TRUE(offsets.isZero(0)) << jaw;
      continue;
    }
    const RigidTransform turn = rigid_fit(rest, rest + offsets);
    // Rounding of a fit at 100 mm; the whole is a turn by the sine 0.24 at 30 mm and more.
    EXPECT_LT((turn.apply(rest) - rest - offsets).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_GT(offsets.rowwise().norm().minCoeff(), 0.24 * 30);
  }
}

TEST_P(HeadExpression, FlipsAndCrushesNoTriangle) {
  EXPECT_GT(worst_quality(pose()), kFewestQuality);
  EXPECT_EQ(flipped(head().mean(), pose()), 0);
}

INSTANTIATE_TEST_SUITE_P(Each, HeadExpression, ::testing::Range(0, 12), [](const auto& parameter) {
  return head().expressions().names[static_cast<std::size_t>(parameter.param)];
});

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
    EXPECT_EQ(mirrored(name + "Left"), field(name + "Right")) << name;
  }
}

TEST(HeadExpressions, OfBothSidesAreSymmetric) {
  for (const std::string name : {"browInnerUp", "jawOpen", "mouthPucker", "cheekPuff"}) {
    EXPECT_EQ(mirrored(name), field(name)) << name;
  }
}

TEST(HeadExpressions, CalledLeftMoveTheHeadsOwnLeft) {
  const Positions smile = field("mouthSmileLeft");
  Eigen::Index most;
  smile.rowwise().norm().maxCoeff(&most);
  EXPECT_GT(head().mean()(most, 0), 10);
}

TEST(HeadExpressions, JawOpenPartsTheLipsAndLeavesTheUpperOne) {
  const Edges lips = mouth_edges();
  const Positions moved = field("jawOpen");
  const std::vector<double> open = gaps(head().mean() + moved, lips);
  EXPECT_GT(open[open.size() / 2], 18);
  EXPECT_LT(open.front(), open[open.size() / 2] / 2);  // the corners hold the lips together
  const auto [upper, lower] = lips[lips.size() / 2];
  EXPECT_LT(moved(lower, 1), -18);
  EXPECT_TRUE(moved.row(upper).isZero(0));
}

TEST(HeadExpressions, JawOpenHasAPalateThatStaysAndAFloorThatFalls) {
  const Positions moved = field("jawOpen");
  int palate = 0, floor = 0;
  for (int v = 0; v < head().vertices(); ++v) {
    const samples::HeadVertex& vertex = grid().vertices[static_cast<std::size_t>(v)];
    if (vertex.part != samples::HeadVertex::Part::mouth || vertex.u != 0) continue;
    if (vertex.rim > 0) {
      EXPECT_TRUE(moved.row(v).isZero(0)) << vertex.ring;
      ++palate;
    } else {
      EXPECT_LT(moved(v, 1), -8) << vertex.ring;  // all of it is far in front of the joints
      ++floor;
    }
  }
  EXPECT_EQ(palate, samples::kMouthRings);
  EXPECT_EQ(floor, samples::kMouthRings);
}

TEST(HeadExpressions, BlinkClosesTheEyeToAFewHundredthsOfItsOpening) {
  for (const auto& [name, eye] :
       {std::pair<std::string, int>{"eyeBlinkLeft", 1}, {"eyeBlinkRight", -1}}) {
    const std::vector<double> open = gaps(head().mean(), eye_edges(eye));
    const double widest = *std::max_element(open.begin(), open.end());
    for (const double gap : gaps(head().mean() + field(name), eye_edges(eye))) {
      EXPECT_LT(gap, 0.05 * widest) << name;
    }
  }
}

TEST(HeadExpressions, BlinkNeverCrossesTheLids) {
  for (const double weight : {0.25, 0.5, 0.75, 1.0}) {
    const Positions pose = head().mean() + weight * field("eyeBlinkLeft");
    for (const auto& [above, below] : eye_edges(1)) EXPECT_GT(pose(above, 1), pose(below, 1));
  }
}

TEST(HeadExpressions, BlinkIsDoneMostlyByTheUpperLid) {
  const Positions moved = field("eyeBlinkLeft");
  for (const auto& [above, below] : eye_edges(1)) {
    EXPECT_GT(moved.row(above).norm(), 4 * moved.row(below).norm());
  }
}

TEST(HeadExpressions, EyeWideOpensTheEyeFurther) {
  const std::vector<double> open = gaps(head().mean(), eye_edges(-1));
  const std::vector<double> wide = gaps(head().mean() + field("eyeWideRight"), eye_edges(-1));
  for (std::size_t i = 0; i < open.size(); ++i) EXPECT_GT(wide[i], 1.2 * open[i]);
}

TEST(HeadExpressions, SmilePullsTheCornerOfTheMouthUpAndOutAndTheCheekForward) {
  const Positions moved = field("mouthSmileLeft");
  const int corner = mouth_edges().back().first;
  EXPECT_GT(moved(corner, 0), 4);
  EXPECT_GT(moved(corner, 1), 4);
  Eigen::Index cheek;
  moved.col(2).maxCoeff(&cheek);
  EXPECT_GT(moved(cheek, 2), 3);
  EXPECT_GT(moved(cheek, 1), 2);
  EXPECT_NEAR(head().mean()(cheek, 1), -30, 15);
}

TEST(HeadExpressions, BrowsMoveAsTheirNamesSay) {
  EXPECT_GT(field("browInnerUp").col(1).maxCoeff(), 5);
  EXPECT_GE(field("browInnerUp").col(1).minCoeff(), 0);
  EXPECT_LT(field("browDownLeft").col(1).minCoeff(), -5);
  EXPECT_LE(field("browDownLeft").col(1).maxCoeff(), 0);
}

/// Height and side of all that an expression may move, mm.
struct Reach {
  const char* name;
  double lowest, highest, rightmost, leftmost;
};

class HeadExpressionReach : public ::testing::TestWithParam<Reach> {};

TEST_P(HeadExpressionReach, EndsExactlyWhereItsMusclesDo) {
  const Reach& reach = GetParam();
  const Positions moved = field(reach.name);
  for (int v = 0; v < head().vertices(); ++v) {
    const double x = head().mean()(v, 0), y = head().mean()(v, 1);
    const bool inside =
        y >= reach.lowest && y <= reach.highest && x >= reach.rightmost && x <= reach.leftmost;
    EXPECT_TRUE(inside || moved.row(v).isZero(0)) << v << " at " << x << ", " << y;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, HeadExpressionReach,
                         ::testing::Values(Reach{"eyeBlinkLeft", -20, 22, 15, 47},
                                           Reach{"eyeWideRight", -20, 22, -47, -15},
                                           Reach{"browInnerUp", 0, 55, -65, 65},
                                           Reach{"browDownLeft", 0, 50, -8, 60},
                                           Reach{"jawOpen", -150, -25, -80, 80},
                                           Reach{"mouthPucker", -95, -38, -45, 45},
                                           Reach{"mouthSmileLeft", -95, -8, -12, 70},
                                           Reach{"cheekPuff", -95, -20, -82, 82}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(HeadExpressions, BlinkNeverEntersTheEyeball) {
  constexpr double kEyeballRadius = 13;
  const Positions blink = field("eyeBlinkLeft");
  for (const double weight : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Positions pose = head().mean() + weight * blink;
    for (int v = 0; v < pose.rows(); ++v) {
      if (grid().vertices[static_cast<std::size_t>(v)].part != samples::HeadVertex::Part::skin)
        continue;
      EXPECT_GE((pose.row(v) - samples::kLeftEye.transpose()).norm(), kEyeballRadius)
          << v << " at " << weight;
    }
  }
}

}  // namespace
}  // namespace mimetra::test
