#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/thread_ranks.h"
#include "toolkit/pipeline/measure.h"

/// Transfers and evaluations on several ranks, to which frames are dealt out, against those of one:
/// the same bytes on all.
namespace mimetra::test {
namespace {

constexpr int kFrames = 75;  // blocks of every kernel on every rank, the last of them shorter

/// Frames of which some were not read by this process.
class Watched : public FrameSource {
 public:
  explicit Watched(const MeshSequence& sequence)
      : FrameSource(sequence.header()), sequence_(sequence), seen_(sequence.frames(), false) {}

  int frames_seen() const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(std::ranges::count(seen_, true));
  }

 private:
  void read_frames(int first, FramesView poses) const override {
    sequence_.read(first, poses);
    const std::lock_guard lock(mutex_);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) seen_[first + row] = true;
  }

  MeshSequence sequence_;
  mutable std::mutex mutex_;
  mutable std::vector<bool> seen_;
};

class DealtTransfer : public testing::Test {
 protected:
  const MeshSequence source_ = take(kFrames);
  const BlendshapeModel actor_ = model_on(bent_patch(), 5);
  TransferOptions options_{.analysis = {.count = 4}, .regions = {.radius = Length::share(0.3)}};
  const Context context_ = Context().with_threads(2);

  static void expect_equal(const TransferResult& found, const TransferResult& expected) {
    const TransferredTarget& one = found.targets.front();
    const TransferredTarget& other = expected.targets.front();
    EXPECT_TRUE(frames_of(one.solution.sequence) == frames_of(other.solution.sequence));
    EXPECT_TRUE(one.solution.weights() == other.solution.weights());
    EXPECT_TRUE(one.error.per_triangle == other.error.per_triangle);
    EXPECT_TRUE(one.error.per_frame == other.error.per_frame);
    EXPECT_EQ(one.error.de_share, other.error.de_share);
    EXPECT_EQ(one.error.leak, other.error.leak);
    EXPECT_EQ(one.error.flipped, other.error.flipped);
    EXPECT_EQ(one.error.largest_crease, other.error.largest_crease);
    EXPECT_EQ(found.head_motion.angle, expected.head_motion.angle);
  }

  void expect_same_on_ranks(const MeshSequence& source,
                            const std::vector<int>& numbers_of_ranks = {3}) const {
    const std::vector<Target> targets = {{"actor", actor_}};
    const TransferResult alone = transfer(Watched(source), targets, options_, context_);
    for (const int ranks : numbers_of_ranks) {
      on_ranks(ranks, [&](const Ranks& rank) {
        const Watched watched(source);
        expect_equal(transfer(watched, targets, options_, context_.with_ranks(rank)), alone);
        EXPECT_LT(watched.frames_seen(), kFrames) << rank.rank() << " of " << ranks;
      });
    }
  }
};

TEST_F(DealtTransfer, FindsTheSameWeights) {
  expect_same_on_ranks(source_, {2, 3});
}

TEST_F(DealtTransfer, FindsTheSameSmoothWeights) {
  options_.solve.smoothness = 0.05;
  expect_same_on_ranks(source_);
}

TEST_F(DealtTransfer, FindsTheSameWeightsOfEachRegion) {
  options_.solve.per_region = true;
  expect_same_on_ranks(source_);
}

TEST_F(DealtTransfer, FindsTheSamePositions) {
  options_.solve.space = Space::vertex;
  expect_same_on_ranks(source_);
}

TEST_F(DealtTransfer, TakesOutTheSameHeadMotion) {
  const MeshSequence nods = with_motion(bare(source_), nodding(kFrames));
  options_.full = true;
  for (const HeadMotion motion : {HeadMotion::stable, HeadMotion::all}) {
    options_.source.head_motion = motion;
    expect_same_on_ranks(nods);
  }
}

TEST(DealtEvaluation, FindsTheSameRows) {
  const MeshSequence source = take(kFrames);
  const BlendshapeModel actor = model_on(bent_patch(), 5);
  const Target target = {"actor", actor};
  const EvaluationOptions options{.counts = {2, 4}, .regions = {.radius = Length::share(0.3)}};
  const std::vector<EvaluationRow> alone = evaluate(source, target, options);
  on_ranks(3, [&](const Ranks& rank) {
    const std::vector<EvaluationRow> rows =
        evaluate(source, target, options, Context().with_ranks(rank));
    ASSERT_EQ(rows.size(), alone.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].de_all, alone[i].de_all);
      EXPECT_EQ(rows[i].de_region, alone[i].de_region);
      EXPECT_EQ(rows[i].mpe_all, alone[i].mpe_all);
      EXPECT_EQ(rows[i].leak, alone[i].leak);
    }
  });
}

}  // namespace
}  // namespace mimetra::test
