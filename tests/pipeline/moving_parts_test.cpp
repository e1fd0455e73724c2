#include "toolkit/pipeline/moving_parts.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/shapes.h"

namespace mimetra {
namespace {

using test::Noted;
using test::take;
using testing::ElementsAre;
using testing::HasSubstr;

/// A plate of 40 x 3 whose first `columns` of vertices rise, each frame more of them.
MeshSequence rising(const std::vector<int>& columns) {
  const test::Shape plate = test::grid(41, 4);
  Frames frames(std::ssize(columns), plate.positions.size());
  for (Eigen::Index f = 0; f < frames.rows(); ++f) {
    Positions pose = plate.positions;
    for (Eigen::Index v = 0; v < pose.rows(); ++v) {
      if (pose(v, 0) < columns[static_cast<std::size_t>(f)]) pose(v, 2) += 1;
    }
    frames.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
  }
  return {Connectivity::from_triangles(static_cast<int>(plate.positions.rows()), plate.triangles),
          frames,
          {},
          plate.positions};
}

/// The take with a body beside it, ten times as large, that keeps still.
MeshSequence with_still_body(const MeshSequence& sequence) {
  test::Shape body = test::grid(12, 12);
  body.positions *= sequence.diameter();
  body.positions.col(1).array() -= 20 * sequence.diameter();
  const test::Shape shape = both({sequence.rest(), sequence.triangles()}, body);
  Frames frames(sequence.frames(), shape.positions.size());
  frames.leftCols(sequence.positions().cols()) = sequence.positions();
  frames.rightCols(body.positions.size()).rowwise() =
      body.positions.reshaped<Eigen::RowMajor>().transpose();
  return {Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
          std::move(frames), sequence.times(), shape.positions};
}

TEST(MovingParts, AloneCountForTheSize) {
  const MeshSequence sequence = take();
  EXPECT_EQ(moving_parts(sequence, sequence.rest()).diameter, sequence.diameter());
  const MeshSequence beside = with_still_body(sequence);
  EXPECT_EQ(moving_parts(beside, beside.rest()).diameter, sequence.diameter());
  EXPECT_GT(beside.diameter(), 10 * sequence.diameter());
}

TEST(MovingParts, HaveOneSizeInBothHalvesOfAClip) {
  const MeshSequence clip = with_still_body(take(8));
  const auto shared = std::make_shared<const MeshSequence>(clip);
  const auto size_of = [&](std::vector<int> frames) {
    return moving_parts(*with_rest(selected(shared, std::move(frames)), clip.rest()), clip.rest())
        .diameter;
  };
  EXPECT_EQ(size_of({0, 1, 2, 3}), size_of({4, 5, 6, 7}));
}

TEST(MovingParts, AreMeasuredByWhatMovesInASmallSection) {
  Noted noted;
  // Of 40: 9, and at last 14.
  const MeshSequence small = rising({0, 5, 10, 3}), large = rising({0, 5, 10, 3, 15});
  const MovingParts size = moving_parts(small, small.rest());
  EXPECT_TRUE(size.is_section);
  EXPECT_DOUBLE_EQ(size.diameter, 1.5 * std::hypot(9, 3));
  EXPECT_EQ(moving_parts(small, small.rest(), noted.sink()).diameter, size.diameter);
  ASSERT_EQ(noted.notes.size(), 1U);
  EXPECT_THAT(noted.notes.front().text, HasSubstr("less than a third"));
  EXPECT_EQ(moving_parts(large, large.rest(), noted.sink()).diameter, large.diameter());
  EXPECT_EQ(noted.notes.size(), 1U);
}

TEST(MovingParts, AreAllWhereNothingMoves) {
  const MeshSequence still = rising({0, 0});
  EXPECT_EQ(moving_parts(still, still.rest()).diameter, still.diameter());
}

TEST(MovingParts, GiveTheRegionsThatAreThereWithoutAStillBody) {
  const MeshSequence alone = take(), beside = with_still_body(alone);
  const auto regions_of = [](const MeshSequence& sequence) {
    const Source source = prepare_source(sequence, {.head_motion = HeadMotion::none});
    return choose_regions(analyse(source, {.decomposition = {.count = 5}}));
  };
  const Regions expected = regions_of(alone), found = regions_of(beside);
  ASSERT_EQ(found.regions.size(), expected.regions.size());
  for (std::size_t k = 0; k < expected.regions.size(); ++k) {
    EXPECT_EQ(found.regions[k].vertices, expected.regions[k].vertices) << k;
  }
  EXPECT_EQ(found.triangles, expected.triangles);
}

}  // namespace
}  // namespace mimetra
