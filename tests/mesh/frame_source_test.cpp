#include "toolkit/mesh/frame_source.h"

#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/thread_ranks.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::shared_ptr<const Connectivity> points(int count) {
  return std::make_shared<const Connectivity>(Connectivity::from_triangles(count, Triangles(0, 3)));
}

/// Frame f, coordinate i: 1000 f + i. Counts the frames that were read.
class Counted : public FrameSource {
 public:
  Counted(int frames, int vertices)
      : FrameSource({points(vertices), default_times(frames), Positions::Zero(vertices, 3), true}) {
  }
  Counted(int frames, int vertices, const Positions& rest)
      : FrameSource({points(vertices), default_times(frames), rest, false}) {}

  int frames_read() const { return frames_read_; }
  std::size_t most_bytes() const { return most_bytes_; }

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const double start = 1000.0 * static_cast<double>(first + row);
      poses.row(row).setLinSpaced(start, start + static_cast<double>(poses.cols() - 1));
    }
    const std::lock_guard lock(mutex_);
    frames_read_ += static_cast<int>(poses.rows());
    most_bytes_ = std::max(most_bytes_, sizeof(double) * static_cast<std::size_t>(poses.size()));
  }

  mutable std::mutex mutex_;
  mutable int frames_read_ = 0;
  mutable std::size_t most_bytes_ = 0;
};

TEST(FrameSource, ReadsNothingUntilItIsAsked) {
  const Counted source(100, 2);
  EXPECT_EQ(source.frames(), 100);
  EXPECT_EQ(source.vertices(), 2);
  EXPECT_EQ(source.frames_read(), 0);
  EXPECT_EQ(source.read(7, 3)(2, 1), 9001);
  EXPECT_EQ(source.frames_read(), 3);
}

TEST(FrameSource, NamesFramesThatAreNotThereAndNeedsRoomForAllCoordinates) {
  const auto source = std::make_shared<const Counted>(5, 2);
  EXPECT_THAT([&] { source->read(3, 3); },
              ThrowsMessage<std::out_of_range>(HasSubstr("frames 3 to 5 of a sequence of 5")));
  EXPECT_THROW(source->read(-1, 1), std::out_of_range);
  EXPECT_THROW(selected(source, {4, 5}), std::out_of_range);
  Frames room(1, 5);
  EXPECT_THAT([&] { source->read(0, FramesView(room.data(), 1, 5)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 x 2 vertices")));
}

TEST(FrameSource, BlocksHoldEachFrameOnceAndAreBounded) {
  // A frame of 0.6 MB, so that a block holds few.
  const int vertices = 25000;
  const Counted source(40, vertices);
  std::mutex mutex;
  std::multiset<int> seen;
  const auto see = [&](int first, const Frames& poses) {
    const std::lock_guard lock(mutex);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      seen.insert(first + static_cast<int>(row));
      EXPECT_EQ(poses(row, 0), 1000.0 * static_cast<double>(first + row));
    }
  };
  for_each_block(source, see, Context().with_threads(3));
  EXPECT_EQ(seen.size(), 40u);
  EXPECT_EQ(std::set<int>(seen.begin(), seen.end()).size(), 40u);
  EXPECT_LE(source.most_bytes(), kBlockBytes);
}

TEST(FrameSource, AFrameLargerThanABlockIsABlock) {
  const Counted source(2, static_cast<int>(kBlockBytes / 24) + 1);
  int blocks = 0;
  const auto count = [&blocks](int, const Frames& poses) {
    EXPECT_EQ(poses.rows(), 1);
    ++blocks;
  };
  for_each_block(source, count, Context().with_threads(1));
  EXPECT_EQ(blocks, 2);
}

TEST(FrameSource, BecomesASequenceInMemory) {
  const Counted source(70, 3);
  const MeshSequence sequence(source, Context().with_threads(2));
  EXPECT_EQ(sequence.positions(), source.read(0, 70));
  EXPECT_EQ(sequence.times(), source.times());
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(sequence.shared_connectivity(), source.shared_connectivity());
}

TEST(FrameSource, InMemoryIsSharedAndNotCopied) {
  const auto sequence = std::make_shared<const MeshSequence>(Counted(9, 2));
  const auto rested = with_rest(sequence, Positions::Ones(2, 3));
  EXPECT_EQ(MeshSequence(*rested).positions().data(), sequence->positions().data());
  EXPECT_EQ(MeshSequence(*rested).rest(), Positions::Ones(2, 3));
}

TEST(FrameBlock, IsAViewOfFramesInMemoryAndReadsOthers) {
  const Counted source(9, 2);
  const MeshSequence sequence(source);
  const FrameBlock view(sequence, 4, 3), read(source, 4, 3);
  EXPECT_EQ(view.poses().data(), sequence.positions().row(4).data());
  for (const FrameBlock* block : {&view, &read}) {
    EXPECT_EQ(block->frames(), 3);
    EXPECT_EQ(block->poses(), sequence.positions().middleRows(4, 3));
    EXPECT_EQ(block->frame(2), sequence.frame(6));
  }
  EXPECT_THROW(FrameBlock(sequence, 8, 2), std::out_of_range);
  EXPECT_THROW(FrameBlock(source, 8, 2), std::out_of_range);
}

TEST(WithRest, ChangesTheRestPoseOnly) {
  const auto source = std::make_shared<const Counted>(9, 2);
  const auto rested = with_rest(source, Positions::Ones(2, 3));
  EXPECT_EQ(rested->rest(), Positions::Ones(2, 3));
  EXPECT_TRUE(rested->rest_is_known());
  EXPECT_EQ(rested->times(), source->times());
  EXPECT_EQ(rested->read(3, 4), source->read(3, 4));
  // To none: the first frame, which is not known to be it.
  const auto unknown = with_rest(source, {});
  EXPECT_EQ(unknown->rest().row(0), Eigen::RowVector3d(0, 1, 2));
  EXPECT_FALSE(unknown->rest_is_known());
  EXPECT_THAT(
      [&] { with_rest(source, Positions::Ones(3, 3)); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("the rest pose has 3 vertices, expected 2")));
}

/// What frame f adds: next to 1e16 every second number is rounded away, so that another order gives
/// another sum.
double added_by(int frame) {
  if (frame == 7) return 1e16;
  return frame == 23 ? -1e16 : 1.0 + frame;
}

/// The sum of what frames add, and of each its number.
FrameNumbers numbers_of(const FrameSource& source, const Context& context) {
  const auto work = [](int first, const FrameBlock& block, FrameRows& numbers) {
    ASSERT_TRUE((numbers.array() == 0).all());
    ASSERT_EQ(numbers.rows(), block.frames());
    for (int row = 0; row < block.frames(); ++row) {
      numbers.row(row) << added_by(first + row), first + row, block.poses()(row, 0);
    }
  };
  return over_frames(source, 1, 2, work, context);
}

/// Frames of 0.6 MB, so that it takes several blocks.
constexpr int kFrames = 31, kVertices = 25000;

void expect_all_frames(const FrameNumbers& found) {
  double expected = 0;
  for (int f = 0; f < kFrames; ++f) expected += added_by(f);
  EXPECT_THAT(found.sum, ElementsAre(expected));
  ASSERT_EQ(found.of_each.rows(), kFrames);
  for (int f = 0; f < kFrames; ++f) {
    EXPECT_THAT(found.of_each.row(f), ElementsAre(f, 1000.0 * f));
  }
}

TEST(OverFrames, AddsInTheOrderOfTheFramesAndKeepsWhatIsOfEach) {
  const Counted source(kFrames, kVertices);
  for (const int threads : {1, 3}) {
    expect_all_frames(numbers_of(source, Context().with_threads(threads)));
  }
  EXPECT_LE(source.most_bytes(), kBlockBytes);
}

TEST(OverFrames, GivesTheSameOnAllRanksOfWhichEachReadsItsShare) {
  for (const int ranks : {1, 2, 3, 7, 40}) {
    std::vector<int> read(ranks);
    test::on_ranks(ranks, [&](const Ranks& rank) {
      const Counted source(kFrames, kVertices);
      expect_all_frames(numbers_of(source, Context().with_threads(2).with_ranks(rank)));
      read[rank.rank()] = source.frames_read();
    });
    EXPECT_EQ(std::accumulate(read.begin(), read.end(), 0), kFrames);
    // Blocks are of one frame to four.
    EXPECT_LE(std::ranges::max(read), kFrames / ranks + 4) << ranks;
  }
}

TEST(OverFrames, ThrowsWhatWorkThrowsAndEndsWhereProgressAsksForIt) {
  const auto work = [](int, const FrameBlock&, FrameRows&) { throw std::runtime_error("broken"); };
  EXPECT_THAT([&] { over_frames(Counted(9, 2), 1, 0, work); },
              ThrowsMessage<std::runtime_error>("broken"));
  const auto none = [](int, const FrameBlock&, FrameRows&) {};
  const auto until_done = [](double share) { return share < 1; };
  EXPECT_THROW(over_frames(Counted(9, 2), 1, 0, none, Context().with_progress(until_done)),
               Cancelled);
}

TEST(ForEachBlock, GivesEveryFrameToAllRanksOfWhichEachReadsItsShare) {
  constexpr int kMany = 401;  // more blocks than are exchanged at a time
  for (const int ranks : {2, 3}) {
    std::atomic<int> read = 0;
    test::on_ranks(ranks, [&](const Ranks& rank) {
      const Counted source(kMany, 30000);
      std::set<int> seen;
      const auto see = [&seen](int first, const Frames& poses) {
        for (int row = 0; row < poses.rows(); ++row) {
          EXPECT_EQ(poses(row, 1), 1000.0 * (first + row) + 1);
          EXPECT_TRUE(seen.insert(first + row).second);
        }
      };
      for_each_block(source, see, Context().with_threads(1).with_ranks(rank));
      EXPECT_EQ(seen.size(), kMany);
      EXPECT_LE(source.frames_read(), kMany / ranks + 2);
      read += source.frames_read();
    });
    EXPECT_EQ(read, kMany);
  }
}

/// Whatever a source is made of, some vertices of it are those of whole frames.
void expect_vertices_of(const FrameSource& source) {
  const Frames all = source.read(1, 3);
  for (const auto& [vertex, count] : {std::pair(0, 5), std::pair(1, 2), std::pair(4, 1)}) {
    Frames some(3, 3 * count);
    source.read_vertices(1, vertex, FramesView(some.data(), 3, some.cols()));
    EXPECT_TRUE(some == all.middleCols(3 * vertex, some.cols())) << vertex;
  }
}

TEST(FrameSource, ReadsSomeVertices) {
  const auto source = std::make_shared<const Counted>(6, 5);
  const auto in_memory = std::make_shared<const MeshSequence>(*source);
  expect_vertices_of(*source);
  expect_vertices_of(*in_memory);
  expect_vertices_of(*with_rest(in_memory, Positions::Ones(5, 3)));
  expect_vertices_of(*selected(in_memory, {5, 0, 1, 3}));
  expect_vertices_of(*some_vertices(source, 0, 5));
  EXPECT_TRUE(in_memory->reads_vertices());
  EXPECT_FALSE(source->reads_vertices());
}

TEST(FrameSource, NamesVerticesThatAreNotThere) {
  const auto source = std::make_shared<const Counted>(5, 4);
  Frames room(1, 6);
  EXPECT_THAT([&] { source->read_vertices(0, 3, FramesView(room.data(), 1, 6)); },
              ThrowsMessage<std::out_of_range>(HasSubstr("vertices 3 to 4 of a mesh of 4")));
  EXPECT_THAT([&] { source->read_vertices(0, 0, FramesView(room.data(), 1, 5)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("three a vertex")));
  EXPECT_THROW(some_vertices(source, 2, 3), std::out_of_range);
}

TEST(SomeVertices, AreASourceOfTheirOwn) {
  const auto source = std::make_shared<const Counted>(6, 5, Positions::Random(5, 3));
  const auto some = some_vertices(source, 1, 3);
  EXPECT_EQ(some->vertices(), 3);
  EXPECT_EQ(some->frames(), 6);
  EXPECT_TRUE(some->rest() == source->rest().middleRows(1, 3));
  EXPECT_TRUE(some->read(2, 2) == source->read(2, 2).middleCols(3, 9));
  Frames last(1, 3);
  some->read_vertices(4, 2, FramesView(last.data(), 1, 3));
  EXPECT_TRUE(last == source->read(4, 1).middleCols(9, 3));
}

/// Numbers of all sizes, so that every order of adding them gives other digits.
class Uneven : public FrameSource {
 public:
  Uneven(int frames, int vertices)
      : FrameSource({points(vertices), default_times(frames), Positions::Zero(vertices, 3), true}) {
  }

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      for (Eigen::Index i = 0; i < poses.cols(); ++i) {
        const double frame = static_cast<double>(1 + first + row);
        poses(row, i) = std::sin(frame * (1 + std::sqrt(static_cast<double>(i))));
      }
    }
  }
};

TEST(MeanPose, OfAStreamIsBitByBitTheOneInMemory) {
  // One frame, less than a group of four, and several blocks of 0.9 MB frames; 3N is no multiple of
  // the four numbers that a register holds.
  for (const auto& [frames, vertices] : {std::pair(1, 5), std::pair(4, 5), std::pair(7, 5),
                                         std::pair(40, 7), std::pair(22, 37001)}) {
    const Uneven source(frames, vertices);
    const Eigen::RowVectorXd expected = source.read(0, frames).colwise().mean();
    const Positions mean = mean_pose(source);
    EXPECT_TRUE(Eigen::Map<const Eigen::RowVectorXd>(mean.data(), mean.size()) == expected)
        << frames;
    EXPECT_TRUE(mean_pose(MeshSequence(source)) == mean);
  }
}

TEST(FrameSource, MotionIsTheRootMeanSquareForEveryNumberOfThreads) {
  const Counted source(130, 3);
  double sum = 0;
  for (int f = 0; f < 130; ++f) sum += source.read(f, 1).squaredNorm();
  EXPECT_EQ(motion(source, Context().with_threads(1)), motion(source, Context().with_threads(3)));
  EXPECT_NEAR(motion(source), std::sqrt(sum / (130 * 3)), 1e-9);
}

TEST(SelectedFrames, KeepTheirTimesAndAreReadAlone) {
  const auto source = std::make_shared<const Counted>(100, 2);
  const auto some = selected(source, {10, 11, 50});
  EXPECT_EQ(some->frames(), 3);
  EXPECT_THAT(std::vector<double>(some->times().begin(), some->times().end()),
              ElementsAre(source->times()[10], source->times()[11], source->times()[50]));
  const Frames poses = some->read(0, 3);
  EXPECT_EQ(poses.col(0), Eigen::Vector3d(10000, 11000, 50000));
  EXPECT_EQ(source->frames_read(), 3);
}

TEST(SelectedFrames, RestInTheFirstOneWhereTheRestIsNotKnown) {
  const auto unknown = std::make_shared<const Counted>(5, 1, Positions::Zero(1, 3));
  EXPECT_EQ(selected(unknown, {3, 4})->rest(), Eigen::RowVector3d(3000, 3001, 3002));
  const auto known = std::make_shared<const Counted>(5, 1);
  EXPECT_EQ(selected(known, {3, 4})->rest(), Positions::Zero(1, 3));
}

}  // namespace
}  // namespace mimetra
