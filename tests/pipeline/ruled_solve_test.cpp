#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/streams.h"
#include "tests/transfer/seamed_face.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {
namespace {

using test::frames_of;
using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// What is known of a target besides its shapes, and smoothness in both spaces.
class RuledSolveTest : public testing::Test {
 protected:
  Frames solved(const Target& target, const SolveOptions& options) const {
    return frames_of(solve(source_, target, some_, options).sequence);
  }

  const MeshSequence take_ = take(12);
  const Source source_ = prepare_source(take_);
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const BlendshapeModel mesh_{actor_.shared_connectivity(),
                              actor_.neutral(),
                              {{}, Eigen::MatrixXd(3 * actor_.vertices(), 0)}};
  const Selection some_ =
      selection_of(regions_from_vertices(81, actor_.triangles(), {{30, 31, 32, 39, 40, 41, 49}}));
  SolveOptions options_;
};

TEST_F(RuledSolveTest, SmoothsTheSolvedPositionsInVertexSpace) {
  const Frames rough = solved({"mesh", mesh_}, options_);
  options_.smoothness = 0.1;
  EXPECT_EQ(solved({"mesh", mesh_}, options_), MotionFilter(take_.times(), 0.1)(rough));
}

TEST_F(RuledSolveTest, KeepsVerticesOutsideBitByBitWhenItSmooths) {
  options_.smoothness = 0.1;
  const Frames smooth = solved({"mesh", mesh_}, options_);
  int outside = 0;
  for (VertexIndex v = 0; v < 81; ++v) {
    if (some_.inside[v]) continue;
    ++outside;
    for (Eigen::Index f = 0; f < smooth.rows(); ++f) {
      EXPECT_EQ(smooth.row(f).segment<3>(3 * v), actor_.neutral().row(v)) << v;
    }
  }
  EXPECT_GT(outside, 0);
}

TEST_F(RuledSolveTest, SmoothsTheWeightsWhereTheyAreSolvedFor) {
  options_.smoothness = 0.1;
  BlendshapeTransferOptions of_weights{.smoothness = 0.1};
  const PlacedSource placed = placed_at({"actor", actor_}, source_);
  const BlendshapeTransfer transfer(placed.source.sequence->rest(), actor_, some_.triangles,
                                    of_weights);
  EXPECT_EQ(solve(placed.source, {"actor", actor_}, some_, options_).weights(),
            transfer.weights(*placed.source.sequence));
}

TEST_F(RuledSolveTest, LeavesOneAndTwoFramesAsTheyAre) {
  for (const int frames : {1, 2}) {
    const Source few = prepare_source(take(frames));
    for (const BlendshapeModel* model : {&actor_, &mesh_}) {
      const Target target{"target", *model};
      const Frames expected = frames_of(solve(few, target, some_).sequence);
      EXPECT_EQ(frames_of(solve(few, target, some_, {.smoothness = 1}).sequence), expected);
    }
  }
}

TEST_F(RuledSolveTest, IsTheSameForAnyThreadsAndOfAStream) {
  const SolveOptions options{.smoothness = 0.1};
  for (const BlendshapeModel* model : {&actor_, &mesh_}) {
    const Target target{"target", *model};
    const auto frames = [&](const Source& source, int threads) {
      const Context context = Context().with_threads(threads);
      return frames_of(solve(source, target, some_, options, context).sequence);
    };
    EXPECT_EQ(frames(prepare_source(test::streamed(take_)), 3), frames(source_, 1));
  }
}

TEST_F(RuledSolveTest, KeepsSeamsClosedWhenItSmooths) {
  const test::SeamedFace face;
  const MeshSequence talking = face.with_copies(test::SeamedFace::talking(face.whole, 20, 17));
  const test::Shape bent = face.with_copies(face.bent());
  const BlendshapeModel target(test::connectivity_of(bent), bent.positions,
                               {{}, Eigen::MatrixXd(bent.positions.size(), 0)});
  const Frames frames = frames_of(
      solve(prepare_source(talking), {"mesh", target}, whole(talking), {.smoothness = 0.1})
          .sequence);
  for (std::size_t v = 0; v < face.original.size(); ++v) {
    EXPECT_EQ(frames.middleCols<3>(3 * v), frames.middleCols<3>(3 * face.original[v])) << v;
  }
}

TEST_F(RuledSolveTest, CountsWhatItSmoothsAsMemory) {
  const auto bytes = [this](const BlendshapeModel& model, double smoothness) {
    return solution_bytes(take_, model, {.smoothness = smoothness}, Context());
  };
  EXPECT_GT(bytes(actor_, 0.1), bytes(actor_, 0));
  EXPECT_GT(bytes(mesh_, 0.1), bytes(mesh_, 0));
  EXPECT_EQ(bytes(mesh_, 0.1) - bytes(mesh_, 0), frame_bytes(take_));
}

TEST_F(RuledSolveTest, HasTheTargetsRulesInItsMeshAndItsWeights) {
  Target target{"actor", actor_};
  target.rules.expressions["shape2"] = {.maximum = 0.9, .gain = 1.3, .offset = 0.1};
  const Solution ruled = solve(source_, target, some_, options_);
  EXPECT_LE(ruled.weights().col(2).maxCoeff(), 0.9);
  EXPECT_GE(ruled.weights().col(2).minCoeff(), 0.0);
  EXPECT_NE(ruled.weights(), solve(source_, {"actor", actor_}, some_).weights());
  EXPECT_EQ(frames_of(ruled.sequence), actor_.animate(ruled.weights()).positions());
}

TEST_F(RuledSolveTest, RefusesRulesOfOtherExpressionsBeforeItComputes) {
  Target target{"actor", actor_};
  target.rules.name = "r.json";
  target.rules.expressions["shape22"] = {};
  const auto says = ThrowsMessage<MismatchError>(
      HasSubstr("r.json: the model has no expression 'shape22'; did you mean 'shape2'?"));
  const test::Stream stream(take_);
  EXPECT_THAT([&] { transfer(stream, {target}, {.full = true}); }, says);
  EXPECT_EQ(stream.frames_read(), 0);
  EXPECT_THAT([&] { evaluate(take_, target, {.counts = {2}}); }, says);
}

TEST_F(RuledSolveTest, RefusesWhatCannotActOnTheTarget) {
  options_.symmetry = 1;
  EXPECT_EQ(test::topic_of([&] { check_rules({"actor", actor_}, options_); }), Topic::no_pairs);
  options_.symmetry = 0;
  options_.exclusive = Exclusive::eyes;
  EXPECT_EQ(test::topic_of([&] {
              check_rules({"actor", actor_}, options_);
            }),
            Topic::no_exclusives);
  Target paired{"actor", actor_};
  paired.rules.pairs = {{"shape0", "shape1"}};
  options_ = {.symmetry = 1};
  EXPECT_NO_THROW(check_rules(paired, options_));
}

}  // namespace
}  // namespace mimetra
