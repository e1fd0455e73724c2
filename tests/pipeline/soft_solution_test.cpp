#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/transfer/soft_border.h"

namespace mimetra {
namespace {

using test::frames_of;
using test::take;
using test::topic_of;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Regions whose weights fade from 1 around the patch's middle to 0.
class SoftSolutionTest : public testing::Test {
 protected:
  SoftSolutionTest() {
    Eigen::VectorXd weights(81);
    for (int v = 0; v < 81; ++v) {
      const double distance = (actor_.neutral().row(v) - actor_.neutral().row(40)).head<2>().norm();
      weights[v] = std::clamp((3.5 - distance) / 2, 0.0, 1.0);
    }
    soft_ = selected(weights);
  }

  Selection selected(const Eigen::VectorXd& weights) const {
    Selection selection;
    selection.weights = weights;
    for (int t = 0; t < actor_.triangles().rows(); ++t) {
      if (weights(actor_.triangles().row(t)).maxCoeff() > 0) selection.triangles.push_back(t);
    }
    for (const double weight : weights) selection.inside.push_back(weight > 0);
    return selection;
  }

  Frames solved(const Selection& selection, Space space) const {
    return frames_of(solve(source_, actor(), selection, {.space = space}).sequence);
  }

  Target actor() const { return {"actor", actor_}; }

  const Source source_ = prepare_source(take(12));
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  Selection soft_;
};

TEST_F(SoftSolutionTest, OfWeightsOneIsThatOfAllTrianglesBitByBit) {
  const Selection ones = selected(Eigen::VectorXd::Ones(81));
  for (const Space space : {Space::blendshape, Space::vertex}) {
    EXPECT_EQ(solved(ones, space), solved(whole(actor()), space));
  }
}

TEST_F(SoftSolutionTest, KeepsVerticesOfWeightZeroBitByBit) {
  for (const Space space : {Space::blendshape, Space::vertex}) {
    const Frames frames = solved(soft_, space);
    for (int v = 0; v < 81; ++v) {
      if (soft_.weights[v] > 0) continue;
      for (Eigen::Index f = 0; f < frames.rows(); ++f) {
        EXPECT_EQ(frames.row(f).segment<3>(3 * v), actor_.neutral().row(v)) << v;
      }
    }
    EXPECT_GT((frames.row(0) - frames.row(5)).norm(), 0.01);
  }
}

TEST_F(SoftSolutionTest, FindsAndFadesExpressionsByTheWeights) {
  const Solution solution = solve(source_, actor(), soft_, {.space = Space::blendshape});
  const Frames frames = frames_of(solution.sequence);
  for (Eigen::Index f = 0; f < frames.rows(); ++f) {
    const Positions pose = actor_.pose(solution.weights().row(f).transpose());
    const Positions expected =
        actor_.neutral() + (soft_.weights.asDiagonal() * (pose - actor_.neutral()));
    const Positions found = PositionsView(frames.row(f).data(), 81, 3);
    // Products of numbers below 10, added in another order.
    EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(), 1e-13);
  }
  EXPECT_EQ(solution.weight_names(), actor_.expressions().names);
  const BlendshapeTransfer transfer(
      source_.sequence->rest(), actor_, soft_.triangles,
      {.triangle_weights = triangle_weights(actor_.triangles(), soft_.weights)});
  EXPECT_EQ(solution.weights(), transfer.weights(*source_.sequence));
}

TEST_F(SoftSolutionTest, SmoothsAndFollowsRulesAsAnyOther) {
  SolveOptions options{.space = Space::blendshape, .smoothness = 0.1};
  options.sparsity = 0.01;
  const Solution solution = solve(source_, actor(), soft_, options);
  EXPECT_GE(solution.weights().minCoeff(), 0);
  EXPECT_LE(solution.weights().maxCoeff(), 1);
  EXPECT_EQ(error_of(solution, source_, actor(), soft_, options).leak, 0);
}

TEST_F(SoftSolutionTest, CreasesLessThanAHardBorder) {
  Eigen::VectorXd inside(81);
  for (int v = 0; v < 81; ++v) inside[v] = soft_.weights[v] >= 0.5 ? 1 : 0;
  Selection hard = selected(inside);
  hard.weights.resize(0);
  const auto error = [this](const Selection& selection) {
    const SolveOptions options{.space = Space::vertex};
    return error_of(solve(source_, actor(), selection, options), source_, actor(), selection,
                    options);
  };
  const TransferError of_soft = error(soft_);
  EXPECT_LT(of_soft.crease, error(hard).crease);
  EXPECT_EQ(of_soft.leak, 0);
  EXPECT_EQ(error(whole(actor())).crease, 0);
}

TEST_F(SoftSolutionTest, NotesACreaseThatIsSeen) {
  test::Noted noted;
  TransferError error;
  error.crease = 0.9 * kVisibleCrease;
  note_crease(error, actor(), noted.context());
  EXPECT_FALSE(noted.has(Topic::visible_crease));
  error.crease = 1.1 * kVisibleCrease;
  note_crease(error, actor(), noted.context());
  EXPECT_TRUE(noted.has(Topic::visible_crease));
}

TEST_F(SoftSolutionTest, RefusesWhatContradictsTheWeights) {
  SolveOptions options{.space = Space::vertex};
  const auto work = [&] { solve(source_, actor(), soft_, options); };
  options.outside = Outside::identity;
  EXPECT_EQ(topic_of(work), Topic::soft_outside);
  options.outside = Outside::fixed;
  options.anchor = Anchor::centroid;
  EXPECT_EQ(topic_of(work), Topic::anchor_and_weights);
  options = {.space = Space::blendshape};
  options.per_region = true;
  EXPECT_THAT(work, ThrowsMessage<std::invalid_argument>(HasSubstr("per_region: ")));
  options = {};
  soft_.weights[3] = -0.1;
  EXPECT_THAT(work, ThrowsMessage<std::invalid_argument>(HasSubstr("vertex 3 is -0.1")));
}

TEST_F(SoftSolutionTest, RowsOfAnEvaluationHaveLeakAndCrease) {
  const EvaluatedTransfer full = evaluate_full(source_, actor(), {.space = Space::vertex});
  EXPECT_EQ(full.row.crease, 0);
  const Regions regions =
      regions_from_vertices(81, actor_.triangles(), {{30, 31, 32, 39, 40, 41, 48, 49, 50}});
  const EvaluatedTransfer part =
      evaluate_by(regions, full, source_, actor(), {.space = Space::vertex});
  EXPECT_GT(part.row.crease, 0);
  EXPECT_GE(part.row.largest_crease, part.row.crease);
  EXPECT_EQ(part.row.crease, part.error.crease);
  EXPECT_EQ(part.row.leak, 0);
}

}  // namespace
}  // namespace mimetra
