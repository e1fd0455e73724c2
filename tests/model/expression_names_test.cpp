#include "toolkit/model/expression_names.h"

#include <gmock/gmock.h>

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Pair = std::array<int, 2>;

TEST(ExpressionNamed, IsTheSameOrTheOnlyOneThatIsWrittenOtherwise) {
  const std::vector<std::string> names{"jawOpen", "mouthSmile_L", "mouthSmileLeft", "browDown_r"};
  EXPECT_EQ(expression_named("jawOpen", names), 0);
  EXPECT_EQ(expression_named("JawOpen", names), 0);
  EXPECT_EQ(expression_named("mouthSmile_L", names), 1);
  EXPECT_EQ(expression_named("mouthSmileLeft", names), 2);
  EXPECT_EQ(expression_named("mouthSmile.l", names), -1);
  EXPECT_EQ(expression_named("browDownRight", names), 3);
  EXPECT_EQ(expression_named("brow", names), -1);
}

TEST(KnownPairs, AreLeftAndRightHoweverTheyAreNamed) {
  for (const auto& [left, right] :
       std::vector<std::array<std::string, 2>>{{"smileLeft", "smileRight"},
                                               {"smile_L", "smile_R"},
                                               {"smile_left", "smile_right"},
                                               {"smile.l", "smile.r"}}) {
    EXPECT_THAT(known_pairs({"jawOpen", right, left}), ElementsAre(Pair{2, 1})) << left;
  }
}

TEST(KnownPairs, NeedBothHalves) {
  EXPECT_THAT(known_pairs({"smile_L", "frown_R", "left", "right"}), IsEmpty());
}

TEST(KnownPairs, AreNoMovesToASide) {
  EXPECT_THAT(known_pairs({"jawLeft", "jawRight", "mouthLeft", "mouthRight"}), IsEmpty());
}

TEST(KnownPairs, HaveEyesLookToOneSide) {
  const std::vector<std::string> names = {"eyeLookInLeft", "eyeLookInRight", "eyeLookOutLeft",
                                          "eyeLookOutRight"};
  EXPECT_THAT(known_pairs(names), ElementsAre(Pair{0, 3}, Pair{2, 1}));
}

TEST(KnownExclusives, AreTheLooksOfEachEye) {
  const std::vector<std::string> names = {"eyeLookDown_L", "eyeLookDown_R", "eyeLookIn_L",
                                          "eyeLookOut_L",  "eyeLookUp_L",   "eyeLookUp_R",
                                          "jawOpen",       "mouthClose"};
  EXPECT_THAT(known_exclusives(names, Exclusive::none), IsEmpty());
  EXPECT_THAT(known_exclusives(names, Exclusive::eyes),
              ElementsAre(ElementsAre(0, 4), ElementsAre(1, 5), ElementsAre(2, 3)));
  EXPECT_THAT(known_exclusives(names, Exclusive::all).back(), ElementsAre(6, 7));
}

TEST(KnownExclusives, NeedAllOfAGroup) {
  EXPECT_THAT(known_exclusives({"eyeLookUpLeft", "jawOpen"}, Exclusive::all), IsEmpty());
}

TEST(ExpressionNames, MayBeginWithTheirSide) {
  EXPECT_EQ(spelled_out("L_smile"), "smileLeft");
  EXPECT_EQ(spelled_out("right_smile"), "smileRight");
  EXPECT_EQ(without_side("r_smile"), "smile");
  EXPECT_THAT(known_pairs({"R_smile", "L_smile", "l_frown", "jawOpen", "L_jaw", "R_jaw"}),
              testing::ElementsAre(std::array{1, 0}));
}

}  // namespace
}  // namespace mimetra
