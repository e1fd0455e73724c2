#include <set>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/streams.h"

namespace mimetra {
namespace {

using test::bare;
using test::frames_of;
using test::nodding;
using test::take;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

/// A transfer of a stream, beside the one of the same frames in memory. The parts of the latter are
/// done by hand on whole arrays in tests/pipeline/transfer_test.cpp.
class StreamedTransferTest : public testing::Test {
 protected:
  static constexpr int kFrames = 43;

  const MeshSequence source_ = take(kFrames);
  const MeshSequence moved_ = with_motion(bare(source_), nodding(kFrames));
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const BlendshapeModel mesh_{actor_.shared_connectivity(),
                              actor_.neutral(),
                              {{}, Eigen::MatrixXd(3 * actor_.vertices(), 0)}};
  const std::vector<Target> targets_ = {{"actor", actor_}, {"mesh", mesh_}, {"again", actor_}};
  TransferOptions options_{.given = some_regions()};

  GivenRegions some_regions() const {
    std::vector<VertexIndex> low(40);
    for (int v = 0; v < 40; ++v) low[v] = v;
    return {"rois", regions_from_vertices(81, source_.triangles(), {low})};
  }

  /// Compares every number of both, and returns how often each frame was read.
  void expect_the_same(const MeshSequence& sequence, const Context& context = {}) const {
    const test::Stream stream(sequence);
    const TransferResult expected = transfer(sequence, targets_, options_, context);
    const TransferResult found = transfer(stream, targets_, options_, context);
    ASSERT_EQ(found.targets.size(), expected.targets.size());
    for (std::size_t t = 0; t < found.targets.size(); ++t) {
      const Solution &one = found.targets[t].solution, &other = expected.targets[t].solution;
      EXPECT_TRUE(frames_of(one.sequence) == frames_of(other.sequence)) << t;
      EXPECT_TRUE(one.sequence->read(17, 5) == other.sequence->read(17, 5)) << t;
      EXPECT_TRUE(one.sequence->rest() == other.sequence->rest()) << t;
      EXPECT_EQ(one.sequence->rest_is_known(), other.sequence->rest_is_known()) << t;
      EXPECT_TRUE(one.weights() == other.weights()) << t;
      const TransferError &error = found.targets[t].error, &right = expected.targets[t].error;
      EXPECT_EQ(error.de_all, right.de_all) << t;
      EXPECT_EQ(error.de_region, right.de_region) << t;
      EXPECT_EQ(error.leak, right.leak) << t;
      EXPECT_EQ(error.flipped, right.flipped) << t;
    }
    // All that is read again comes from the store.
    EXPECT_EQ(stream.frames_read(), kFrames);
  }
};

TEST_F(StreamedTransferTest, IsTheOneInMemoryBitByBit) {
  expect_the_same(source_);
}

TEST_F(StreamedTransferTest, ByAllTrianglesIsTheOneInMemoryBitByBit) {
  options_.full = true;
  for (const int threads : {1, 3}) expect_the_same(source_, Context().with_threads(threads));
}

TEST_F(StreamedTransferTest, WithHeadMotionIsTheOneInMemoryBitByBit) {
  for (const HeadMotion motion : choices<HeadMotion>()) {
    options_.source.head_motion = motion;
    expect_the_same(moved_);
  }
  options_.source.head_motion = nodding(kFrames);
  for (const RemovedMotion removed : choices<RemovedMotion>()) {
    options_.head_motion = removed;
    expect_the_same(moved_);
  }
}

TEST_F(StreamedTransferTest, FromEveryRestPoseIsTheOneInMemoryBitByBit) {
  for (const SourceRest rest : {SourceRest::first, SourceRest::mean}) {
    options_.source.rest = rest;
    expect_the_same(source_);
  }
  options_.source.rest = Positions(1.5 * source_.rest());
  expect_the_same(source_);
}

TEST_F(StreamedTransferTest, ThatLooksForRegionsIsTheOneInMemoryBitByBit) {
  options_.given = {};
  options_.analysis.count = 3;
  options_.regions.radius = Length::share(0.3);
  expect_the_same(source_);
}

TEST_F(StreamedTransferTest, NeedsItsSourceAndTargetNoMore) {
  const auto made = [this] {
    const test::Stream stream(source_);
    const BlendshapeModel actor = actor_;
    const TransferResult result = transfer(stream, {{"actor", actor}, {"mesh", mesh_}}, options_);
    return std::pair(result.targets[0].solution.sequence, result.targets[1].solution.sequence);
  }();
  const TransferResult expected = transfer(source_, targets_, options_);
  EXPECT_TRUE(frames_of(made.first) == frames_of(expected.targets[0].solution.sequence));
  EXPECT_TRUE(frames_of(made.second) == frames_of(expected.targets[1].solution.sequence));
}

TEST_F(StreamedTransferTest, OfAStreamThatBreaksThrowsWhatReadingThrows) {
  EXPECT_THAT([this] { transfer(test::Stream(source_, 30), targets_, options_); },
              ThrowsMessage<std::runtime_error>("frame 30 is broken"));
}

TEST_F(StreamedTransferTest, EndsWhereverProgressAsksForIt) {
  std::vector<double> shares;
  options_.source.head_motion = HeadMotion::stable;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  const test::Stream stream(moved_);
  transfer(stream, targets_, options_, Context().with_progress(keep));
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  for (const double last : std::set<double>(shares.begin(), shares.end())) {
    const Context context = Context().with_progress([last](double share) { return share < last; });
    EXPECT_THROW(transfer(stream, targets_, options_, context), Cancelled) << last;
  }
}

}  // namespace
}  // namespace mimetra
