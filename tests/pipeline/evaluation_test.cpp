#include "toolkit/pipeline/measure.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

class EvaluationTest : public testing::Test {
 protected:
  const MeshSequence source_ = take();
  // With fewer expressions than the source has, no transfer is exact.
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 3);
  EvaluationOptions options_{.counts = {2, 4}, .regions = {.radius = Length::share(0.2)}};
};

TEST_F(EvaluationTest, HasARowForEachCountAndOneByAllTriangles) {
  const auto rows = evaluate(source_, {"actor", actor_}, options_);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].k, 2);
  EXPECT_EQ(rows[1].k, 4);
  EXPECT_FALSE(rows[2].k);
  EXPECT_FALSE(rows[2].mpe_all);
  EXPECT_EQ(rows[2].triangles, source_.triangles().rows());
  EXPECT_TRUE(rows[0].converged);
  EXPECT_FALSE(rows[2].converged);
  EXPECT_EQ(rows[0].radius, 0.2 * source_.diameter());
  EXPECT_FALSE(rows[2].radius);
  // All triangles have the least error over them.
  for (const EvaluationRow& row : rows) EXPECT_GE(row.de_all, rows[2].de_all);
  EXPECT_EQ(*rows[0].mpe_all, mean_percentage_error(rows[2].de_all, rows[0].de_all));
  EXPECT_LE(*rows[0].mpe_all, 0);
}

TEST_F(EvaluationTest, IsTheErrorOfTheTransferByTheSameRegions) {
  const auto rows = evaluate(source_, {"actor", actor_}, options_);
  TransferOptions options{.analysis = {.count = 2}, .regions = options_.regions};
  const TransferResult by_two = transfer(source_, {{"actor", actor_}}, options);
  EXPECT_EQ(rows[0].de_all, by_two.targets[0].error.de_all);
  EXPECT_EQ(rows[0].de_region, by_two.targets[0].error.de_region);
  EXPECT_EQ(rows[0].triangles, static_cast<int>(by_two.regions->triangles.size()));
  options.full = true;
  EXPECT_EQ(rows[2].de_all,
            transfer(source_, {{"actor", actor_}}, options).targets[0].error.de_all);
}

TEST_F(EvaluationTest, CompletesRegionsThatLeaveExpressionsUnseen) {
  options_.counts = {1};
  options_.regions = {.radius = Length::share(0.05), .complete_limit = 1};
  const auto completed = evaluate(source_, {"actor", actor_}, options_);
  options_.regions.complete = 0;
  const auto as_found = evaluate(source_, {"actor", actor_}, options_);
  EXPECT_GT(completed[0].triangles, as_found[0].triangles);
  EXPECT_GT(*completed[0].mpe_all, *as_found[0].mpe_all);
}

TEST_F(EvaluationTest, SaysWhichRowsMayNotBeUsable) {
  test::Noted noted;
  const auto said = [&noted] {
    std::string text;
    for (const Note& note : noted.notes) text += note.text + '\n';
    return text;
  };
  const BlendshapeModel same = test::model_on(test::patch(), 5);
  evaluate(source_, {"same", same}, options_, noted.context());
  EXPECT_EQ(said().find("may not be usable"), std::string::npos) << said();
  // One expression tells little of what the source does.
  const BlendshapeModel poor = test::model_on(test::bent_patch(), 1);
  evaluate(source_, {"actor", poor}, options_, noted.context());
  EXPECT_THAT(said(), HasSubstr("actor: rows of which the result may not be usable: K = 2: "));
  EXPECT_THAT(said(), HasSubstr("; 100.0 % of the triangles: "));
}

TEST_F(EvaluationTest, RefusesASourceThatDoesNotMove) {
  const Frames at_rest = source_.rest().reshaped<Eigen::RowMajor>().transpose().replicate(8, 1);
  const MeshSequence still = source_.with_frames(at_rest);
  EXPECT_THAT(
      [&] {
        evaluate(still, {"actor", actor_}, options_);
      },
      ThrowsMessage<MismatchError>(HasSubstr("nothing moves: all 8 frames")));
}

TEST_F(EvaluationTest, RefusesACountBelowOne) {
  options_.counts = {3, 0};
  EXPECT_THAT(
      [&] {
        evaluate(source_, {"actor", actor_}, options_);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("counts is 0; it must be at least 1")));
}

}  // namespace
}  // namespace mimetra
