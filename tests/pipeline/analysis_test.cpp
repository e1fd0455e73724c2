#include "toolkit/pipeline/analysis.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/shapes.h"
#include "toolkit/pipeline/source.h"

namespace mimetra {
namespace {

using test::bare;
using test::Noted;
using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

Source source_of(const MeshSequence& sequence) {
  return prepare_source(sequence, {.head_motion = HeadMotion::none});
}

AnalysisOptions three_components() {
  return {.count = 3};
}

TEST(Analysis, IsTheDecompositionFromTheRestPoseOfTheSource) {
  const MeshSequence sequence = take();
  const Analysis analysis = analyse(source_of(sequence), three_components());
  const Components expected = decompose(sequence, {.count = 3});
  EXPECT_TRUE(analysis.components.displacements == expected.displacements);
  EXPECT_TRUE(analysis.components.weights == expected.weights);
}

TEST(Analysis, HasTheRestPoseThatIsAskedFor) {
  const MeshSequence sequence = take();
  AnalysisOptions options = three_components();
  options.rest = RestPose::mean;
  EXPECT_TRUE(analyse(source_of(sequence), options).components.rest == mean_pose(sequence));
  options.rest = RestPose::first;
  EXPECT_TRUE(analyse(source_of(sequence), options).components.rest == sequence.frame(0));
  options.rest = 2 * sequence.rest();
  EXPECT_TRUE(analyse(source_of(sequence), options).components.rest == 2 * sequence.rest());
}

TEST(Analysis, AlignsARestPoseThatIsTurnedAgainstTheSource) {
  const MeshSequence sequence = take();
  std::vector<RigidTransform> motion = test::nodding(8);
  const Source source = prepare_source(with_motion(sequence, motion), {.head_motion = motion});
  AnalysisOptions options = three_components();
  options.rest = motion.back().apply(sequence.rest());
  EXPECT_LT((analyse(source, options).components.rest - sequence.rest()).cwiseAbs().maxCoeff(),
            1e-12);
}

TEST(Analysis, NotesSeamsThatRoundingOpened) {
  const test::Shape halves = test::both(test::grid(3, 3), test::grid(3, 3));
  const auto notes_of = [](const Positions& positions, const Triangles& triangles,
                           Welding welding) {
    std::vector<std::string> said;
    const auto keep = [&said](const Note& note) { said.push_back(note.text); };
    distances_along(positions, triangles, {.welding = welding}, Context().with_notes(keep));
    return said;
  };
  Positions rest = halves.positions;
  EXPECT_THAT(notes_of(rest, halves.triangles, Welding::exact), testing::IsEmpty());
  rest(12, 2) += 1e-8;
  EXPECT_THAT(notes_of(rest, halves.triangles, Welding::exact),
              testing::ElementsAre(HasSubstr("2 places of vertices within a millionth")));
  EXPECT_THAT(notes_of(rest, halves.triangles, Welding::none), testing::IsEmpty());
}

TEST(Analysis, TakesLengthsAsSharesOrAsTheyAre) {
  const MeshSequence sequence = take();
  const double side = sequence.diameter();
  AnalysisOptions shares = three_components(), absolute = three_components();
  shares.d_min = Length::share(0.25);
  shares.d_max = Length::share(0.5);
  absolute.d_min = Length::of(0.25 * side);
  absolute.d_max = Length::of(0.5 * side);
  const Components one = analyse(source_of(sequence), shares).components;
  const Components other = analyse(source_of(sequence), absolute).components;
  EXPECT_EQ(one.d_min, 0.25 * side);
  EXPECT_TRUE(one.displacements == other.displacements);
}

TEST(Analysis, MeasuresAsTheReferenceDoesWhereItIsToBeCompatible) {
  const MeshSequence sequence = take();
  double largest = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    largest = std::max(largest, extent(sequence.frame(f)));
  }
  AnalysisOptions options = three_components();
  options.compatibility = Compatibility::splocs2013;
  const Components components = analyse(source_of(sequence), options).components;
  EXPECT_EQ(components.d_max, 0.7 * largest);
  EXPECT_EQ(components.energies.size(), 10U);
  EXPECT_EQ(components.iteration, 10);
  EXPECT_EQ(components.options.sign_rule, SignRule::literal);
  EXPECT_EQ(components.options.scale, MotionScale::standard_deviation);
  EXPECT_TRUE(components.rest == sequence.frame(0));
  options.tolerance = 1;
  EXPECT_THAT([&] { analyse(source_of(sequence), options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("tolerance: ")));
}

TEST(Analysis, RunsAsManyIterationsAsAreAskedForWithTheReferenceToo) {
  AnalysisOptions options = three_components();
  options.compatibility = Compatibility::splocs2013;
  options.iterations = 4;
  EXPECT_EQ(analyse(source_of(take()), options).components.energies.size(), 4U);
}

TEST(Analysis, MeasuresTheReferencesUnitBeforeHeadMotionIsTakenOut) {
  const MeshSequence moved = with_motion(take(), test::nodding(8));
  AnalysisOptions options = three_components();
  options.compatibility = Compatibility::splocs2013;
  const Source source = prepare_source(moved, {.head_motion = test::nodding(8)});
  double largest = 0;
  for (int f = 0; f < moved.frames(); ++f) largest = std::max(largest, extent(moved.frame(f)));
  EXPECT_EQ(analyse(source, options).components.d_max, 0.7 * largest);
}

TEST(Analysis, RefusesMoreComponentsThanVertices) {
  AnalysisOptions options;
  options.count = 82;
  const auto work = [&] { analyse(source_of(take()), options); };
  EXPECT_EQ(test::topic_of(work), Topic::component_count);
  EXPECT_THAT(work, ThrowsMessage<MismatchError>("82 components asked for, the mesh has 81 "
                                                 "vertices"));
}

TEST(Analysis, RefusesASupportMapThatDoesNotRise) {
  AnalysisOptions options = three_components();
  options.d_min = Length::of(1e6);
  EXPECT_EQ(test::topic_of([&] { analyse(source_of(take()), options); }), Topic::support_range);
}

TEST(Analysis, LeavesOutTheMotionOfVerticesWithoutATriangle) {
  const MeshSequence plain = take();
  const MeshSequence loose = test::with_loose_vertex(plain);
  const Components expected = analyse(source_of(plain), three_components()).components;
  const Components found = analyse(source_of(loose), three_components()).components;
  EXPECT_EQ(found.centers, expected.centers);
  EXPECT_EQ(found.displacements.leftCols(expected.displacements.cols()), expected.displacements);
  EXPECT_EQ(found.weights, expected.weights);
  EXPECT_TRUE((found.displacements.rightCols(3).array() == 0).all());
}

TEST(Analysis, RefusesAHeadThatOnlyTurns) {
  const MeshSequence still = take();
  const MeshSequence turning = with_motion(
      bare(still.with_frames(still.positions().row(0).replicate(8, 1))), test::nodding(8));
  const Source source = prepare_source(turning, {.head_motion = HeadMotion::all});
  // What is left are the alignment's last digits: the frames are not equal.
  EXPECT_GT((test::frames_of(source.sequence).row(7) - test::frames_of(source.sequence).row(0))
                .cwiseAbs()
                .maxCoeff(),
            0);
  EXPECT_THAT([&] { analyse(source, three_components()); },
              ThrowsMessage<MismatchError>(HasSubstr("nothing moves")));
}

/// Two triangles whose vertices 1 and 3 lie at one place in the first frame, and part.
MeshSequence parting() {
  Positions rest(4, 3);
  rest << 0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  Frames frames(2, 12);
  for (int f = 0; f < 2; ++f) frames.row(f) = Eigen::Map<Eigen::RowVectorXd>(rest.data(), 12);
  frames(1, 11) = 1;
  return {Connectivity::from_triangles(4, triangles), frames};
}

TEST(Analysis, NotesVerticesThatAreWeldedAndPart) {
  Noted noted;
  AnalysisOptions options{.count = 1};
  analyse(source_of(parting()), options, noted.context());
  EXPECT_TRUE(noted.has(Topic::parting_vertices));
  noted.notes.clear();
  options.distances.welding = Welding::none;
  analyse(source_of(parting()), options, noted.context());
  EXPECT_FALSE(noted.has(Topic::parting_vertices));
}

TEST(DistancesAlong, NoteWhatIsLeftOut) {
  Positions rest(4, 3);
  rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 0, 1;
  Noted noted;
  distances_along(rest, triangles, {}, noted.context());
  ASSERT_EQ(noted.notes.size(), 2U);
  EXPECT_THAT(noted.notes[0].text, HasSubstr("1 triangles without area"));
  EXPECT_THAT(noted.notes[1].text, HasSubstr("the first is vertex 3"));
}

class GivenComponentsTest : public testing::Test {
 protected:
  GivenComponents given_{"take.h5", analyse(source_of(take()), three_components()).components};

  void expect_refusal(const std::string& message) const {
    EXPECT_THAT([this] { analysis_of(given_, take(), moving_vertices(take())); },
                ThrowsMessage<MismatchError>(HasSubstr("take.h5: " + message)));
  }
};

TEST_F(GivenComponentsTest, AreTakenAsTheyAre) {
  const Analysis analysis = analysis_of(given_, take(), moving_vertices(take()));
  EXPECT_TRUE(analysis.components.displacements == given_.components.displacements);
  EXPECT_EQ(analysis.seconds, 0);
}

TEST_F(GivenComponentsTest, AreRefusedWithoutWeights) {
  given_.components.weights.resize(0, 0);
  expect_refusal("holds no weights W");
}

TEST_F(GivenComponentsTest, AreRefusedForAnotherMesh) {
  given_.components.triangles.row(0).reverseInPlace();
  expect_refusal("components of 81 vertices with other triangles");
}

TEST_F(GivenComponentsTest, AreRefusedWhereAllDied) {
  given_.components.centers.assign(3, -1);
  expect_refusal("no component moves a vertex");
}

}  // namespace
}  // namespace mimetra
