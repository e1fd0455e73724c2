#include "toolkit/pipeline/source.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/shapes.h"

namespace mimetra {
namespace {

using test::Noted;
using test::take;

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

Source still(const MeshSequence& sequence) {
  return prepare_source(sequence, {.head_motion = HeadMotion::none});
}

MovingParts parts_of(const FrameSource& sequence) {
  return moving_parts(moving_vertices(sequence), sequence.rest(), sequence.triangles());
}

TEST(MovingParts, AloneCountForTheSize) {
  const MeshSequence sequence = take();
  EXPECT_EQ(parts_of(sequence).diameter, sequence.diameter());
  const MeshSequence beside = with_still_body(sequence);
  EXPECT_EQ(parts_of(beside).diameter, sequence.diameter());
  EXPECT_GT(beside.diameter(), 10 * sequence.diameter());
}

TEST(MovingParts, HaveOneSizeInBothHalvesOfAClip) {
  const MeshSequence clip = with_still_body(take(8));
  const auto shared = std::make_shared<const MeshSequence>(clip);
  const auto size_of = [&](std::vector<int> frames) {
    return parts_of(*with_rest(selected(shared, std::move(frames)), clip.rest())).diameter;
  };
  EXPECT_EQ(size_of({0, 1, 2, 3}), size_of({4, 5, 6, 7}));
}

TEST(MovingParts, AreMeasuredByWhatMovesInASmallSection) {
  // Of 40: 9, and at last 14.
  const MeshSequence small = rising({0, 5, 10, 3}), large = rising({0, 5, 10, 3, 15});
  const MovingParts size = parts_of(small);
  EXPECT_TRUE(size.is_section);
  EXPECT_DOUBLE_EQ(size.diameter, 1.5 * std::hypot(9, 3));
  EXPECT_EQ(parts_of(large).diameter, large.diameter());
  for (const MeshSequence* sequence : {&small, &large}) {
    Noted noted;
    const Analysis analysis = analyse(still(*sequence), {.count = 2}, noted.context());
    EXPECT_EQ(analysis.size, parts_of(*sequence).diameter);
    const bool is_noted = std::ranges::any_of(noted.notes, [](const Note& note) {
      return note.text.starts_with("a small section of a connected part moves");
    });
    EXPECT_EQ(is_noted, sequence == &small);
  }
}

TEST(MovingParts, AreAllWhereNothingMoves) {
  const MeshSequence sequence = rising({0, 0});
  EXPECT_EQ(parts_of(sequence).diameter, sequence.diameter());
}

TEST(MovingParts, GiveTheRegionsThatAreThereWithoutAStillBody) {
  const MeshSequence alone = take(), beside = with_still_body(alone);
  const auto regions_of = [](const MeshSequence& sequence) {
    return choose_regions(analyse(still(sequence), {.count = 5}));
  };
  const Regions expected = regions_of(alone), found = regions_of(beside);
  ASSERT_EQ(found.regions.size(), expected.regions.size());
  for (std::size_t k = 0; k < expected.regions.size(); ++k) {
    EXPECT_EQ(found.regions[k].vertices, expected.regions[k].vertices) << k;
  }
  EXPECT_EQ(found.triangles, expected.triangles);
}

TEST(MovingParts, HoldTheDiscsThatAreChosenForATransfer) {
  const MeshSequence alone = take(), beside = with_still_body(alone);
  const BlendshapeModel actor = test::model_on(test::bent_patch(), 3);
  const auto discs_of = [](const MeshSequence& sequence, const BlendshapeModel& model) {
    const RegionChoiceOptions options{.select = Selector::transfer, .triangles = 0.4};
    return transfer(sequence, {{"actor", model}}, {.regions = options}).regions->regions.size();
  };
  // The actor with the same body.
  const Eigen::Index body = beside.vertices() - alone.vertices();
  Positions neutral(beside.vertices(), 3);
  neutral << actor.neutral(), beside.rest().bottomRows(body);
  ShapeBasis expressions = actor.expressions();
  expressions.displacements.conservativeResize(3 * beside.vertices(), Eigen::NoChange);
  expressions.displacements.bottomRows(3 * body).setZero();
  const BlendshapeModel with_body(beside.shared_connectivity(), neutral, expressions);
  const std::size_t expected = discs_of(alone, actor);
  EXPECT_GT(expected, 2U);
  EXPECT_GE(discs_of(beside, with_body), expected);
}

}  // namespace
}  // namespace mimetra
