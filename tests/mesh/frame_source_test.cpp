#include "toolkit/mesh/frame_source.h"

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(FrameSource, NamesFramesThatAreNotThere) {
  const Counted source(5, 1);
  EXPECT_THAT([&] { source.read(3, 3); },
              ThrowsMessage<std::out_of_range>(HasSubstr("frames 3 to 5 of a sequence of 5")));
  EXPECT_THROW(source.read(-1, 1), std::out_of_range);
}

TEST(FrameSource, NeedsRoomForAllCoordinates) {
  const Counted source(5, 2);
  Frames room(1, 5);
  EXPECT_THAT([&] { source.read(0, FramesView(room.data(), 1, 5)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 x 2 vertices")));
}

TEST(FrameSource, BlocksHoldEachFrameOnceAndAreBounded) {
  // A frame of 0.6 MB, so that a block holds few.
  const int vertices = 25000;
  const Counted source(40, vertices);
  std::mutex mutex;
  std::multiset<int> seen;
  for_each_block(source, {.threads = 3}, [&](int first, const Frames& poses) {
    const std::lock_guard lock(mutex);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      seen.insert(first + static_cast<int>(row));
      EXPECT_EQ(poses(row, 0), 1000.0 * static_cast<double>(first + row));
    }
  });
  EXPECT_EQ(seen.size(), 40u);
  EXPECT_EQ(std::set<int>(seen.begin(), seen.end()).size(), 40u);
  EXPECT_LE(source.most_bytes(), kBlockBytes);
}

TEST(FrameSource, AFrameLargerThanABlockIsABlock) {
  const Counted source(2, static_cast<int>(kBlockBytes / 24) + 1);
  int blocks = 0;
  for_each_block(source, {.threads = 1}, [&](int, const Frames& poses) {
    EXPECT_EQ(poses.rows(), 1);
    ++blocks;
  });
  EXPECT_EQ(blocks, 2);
}

TEST(FrameSource, BecomesASequenceInMemory) {
  const Counted source(70, 3);
  const MeshSequence sequence(source, {.threads = 2});
  EXPECT_EQ(sequence.positions(), source.read(0, 70));
  EXPECT_EQ(sequence.times(), source.times());
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(sequence.shared_connectivity(), source.shared_connectivity());
}

TEST(FrameSource, ASequenceInMemoryIsOne) {
  const MeshSequence sequence(Counted(9, 2));
  const FrameSource& source = sequence;
  EXPECT_EQ(source.read(4, 2), sequence.positions().middleRows(4, 2));
}

TEST(FrameSource, MotionIsTheRootMeanSquareForEveryNumberOfThreads) {
  const Counted source(130, 3);
  double sum = 0;
  for (int f = 0; f < 130; ++f) sum += source.read(f, 1).squaredNorm();
  EXPECT_EQ(motion(source, {.threads = 1}), motion(source, {.threads = 3}));
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

TEST(SelectedFrames, NamesAFrameThatIsNotThere) {
  EXPECT_THROW(selected(std::make_shared<const Counted>(5, 1), {4, 5}), std::out_of_range);
}

}  // namespace
}  // namespace mimetra
