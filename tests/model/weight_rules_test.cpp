#include "toolkit/model/weight_rules.h"

#include <gmock/gmock.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;
using Pair = std::array<int, 2>;

const std::vector<std::string> kNames = {"jawOpen", "smile_L", "smile_R", "brow_L", "brow_R"};

ExpressionRules with_rule(const ExpressionRule& rule) {
  WeightRules rules;
  rules.expressions["jawOpen"] = rule;
  return ExpressionRules(kNames, rules);
}

TEST(ExpressionRules, LeaveWeightsAsTheyAreWhereThereAreNone) {
  const ExpressionRules rules(kNames);
  EXPECT_EQ(rules.unknowns().lower, Eigen::VectorXd::Zero(5));
  EXPECT_EQ(rules.unknowns().upper, Eigen::VectorXd::Ones(5));
  EXPECT_THAT(rules.unknowns().exclusive, IsEmpty());
  const Eigen::MatrixXd beta = Eigen::MatrixXd::Random(4, 5).cwiseAbs();
  EXPECT_EQ(rules.written(beta), beta);
  EXPECT_EQ(rules.solved(beta), beta);
}

TEST(ExpressionRules, BoundWhatIsWritten) {
  const ExpressionRules rules =
      with_rule({.minimum = -0.1, .maximum = 0.8, .gain = 1.2, .offset = 0.2});
  Eigen::MatrixXd ends = Eigen::MatrixXd::Zero(2, 5);
  ends(0, 0) = rules.unknowns().lower[0];
  ends(1, 0) = rules.unknowns().upper[0];
  const Eigen::MatrixXd written = rules.written(ends);
  // The last bit of (limit - offset) / gain * gain + offset is cut off at the limit.
  EXPECT_NEAR(written(0, 0), -0.1, 1e-15);
  EXPECT_NEAR(written(1, 0), 0.8, 1e-15);
  EXPECT_GE(written(0, 0), -0.1);
  EXPECT_LE(written(1, 0), 0.8);
  EXPECT_LT((rules.solved(written) - ends).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(ExpressionRules, WriteExactlyZeroWhereAGroupsExpressionIsOff) {
  WeightRules given;
  given.exclusive = {{"jawOpen", "smile_L"}};
  given.expressions["jawOpen"] = {.gain = 0.7, .offset = 0.1};
  const ExpressionRules rules(kNames, given);
  EXPECT_EQ(rules.written(rules.unknowns().off.transpose())(0, 0), 0);
}

TEST(ExpressionRules, TakeTheirPairsBeforeThoseThatNamesTell) {
  WeightRules given;
  given.pairs = {{"smile_L", "brow_R"}};
  EXPECT_THAT(ExpressionRules(kNames, given).unknowns().pairs, ElementsAre(Pair{1, 4}));
  EXPECT_THAT(ExpressionRules(kNames).unknowns().pairs, ElementsAre(Pair{1, 2}, Pair{3, 4}));
}

TEST(ExpressionRules, NameTheNearestExpression) {
  WeightRules given;
  given.name = "r.json";
  given.exclusive = {{"jawOpn", "smile_L"}};
  EXPECT_THAT([&] { ExpressionRules(kNames, given); },
              ThrowsMessage<MismatchError>(
                  "r.json: the model has no expression 'jawOpn'; did you mean 'jawOpen'?"));
}

TEST(ExpressionRules, NeedZeroWithinTheLimitsOfAGroup) {
  WeightRules given;
  given.exclusive = {{"jawOpen", "smile_L"}};
  given.expressions["smile_L"] = {.minimum = 0.2};
  EXPECT_THAT([&] { ExpressionRules(kNames, given); },
              ThrowsMessage<MismatchError>(HasSubstr("'smile_L' excludes others")));
}

TEST(ExpressionRules, RefuseWhatIsNoRule) {
  EXPECT_THROW(with_rule({.gain = 0}), std::invalid_argument);
  EXPECT_THROW(with_rule({.minimum = 0.6, .maximum = 0.5}), std::invalid_argument);
}

TEST(UnknownRules, HoldAnUnknownOffWhereItIsInAGroupElseNearZero) {
  UnknownRules rules = UnknownRules::box(4);
  rules.lower << 0.2, -1, 0, 0;
  rules.off << 0, -0.5, 0, 0;
  rules.pairs = {{0, 2}, {2, 3}};
  rules.exclusive = {{1, 2}, {1, 2, 3}};
  rules.hold(0);
  rules.hold(1);
  EXPECT_EQ(rules.lower[0], 0.2);
  EXPECT_EQ(rules.upper[0], 0.2);
  EXPECT_EQ(rules.lower[1], -0.5);
  EXPECT_EQ(rules.upper[1], -0.5);
  EXPECT_THAT(rules.pairs, ElementsAre(Pair{2, 3}));
  EXPECT_THAT(rules.exclusive, ElementsAre(ElementsAre(2, 3)));
}

}  // namespace
}  // namespace mimetra
