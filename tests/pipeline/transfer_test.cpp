#include "toolkit/pipeline/transfer.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::bare;
using test::nodding;
using test::take;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class TransferTest : public testing::Test {
 protected:
  const MeshSequence source_ = take();
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const BlendshapeModel mesh_{actor_.shared_connectivity(),
                              actor_.neutral(),
                              {{}, Eigen::MatrixXd(3 * actor_.vertices(), 0)}};
  TransferOptions options_{.analysis = {.count = 4}, .regions = {.radius = Length::share(0.3)}};

  TransferredTarget to(const BlendshapeModel& model, const Context& context = {}) const {
    return transfer(source_, {{"actor", model}}, options_, context).targets.front();
  }

  /// The source where the target stands.
  std::shared_ptr<const FrameSource> placed() const {
    return carried(std::make_shared<const MeshSequence>(source_),
                   similarity_fit(source_.rest(), actor_.neutral()));
  }

  static Frames frames_of(const TransferredTarget& target) {
    return test::frames_of(target.solution.sequence);
  }

  /// The regions, found by hand.
  Regions regions() const {
    return find_regions(decompose(source_, {.count = 4}), {.radius = 0.3 * source_.diameter()});
  }
};

TEST_F(TransferTest, IsItsPartsDoneByHand) {
  const TransferResult result = transfer(source_, {{"actor", actor_}}, options_);
  const Regions regions = this->regions();
  ASSERT_TRUE(result.regions);
  EXPECT_EQ(result.regions->triangles, regions.triangles);
  EXPECT_EQ(result.components->count(), 4);

  const BlendshapeTransfer by_hand(placed()->rest(), actor_, regions.triangles);
  const Eigen::MatrixXd weights = by_hand.weights(*placed());
  const MeshSequence expected = actor_.animate(weights, source_.times());
  EXPECT_TRUE(result.targets.front().solution.weights() == weights);
  EXPECT_TRUE(frames_of(result.targets.front()) == expected.positions());
  // No head motion is given back, since none was looked for.
  EXPECT_TRUE(result.targets.front().solution.sequence->rest_is_known());
  EXPECT_EQ(result.targets.front().error.de_all,
            transfer_error(*placed(), expected, regions.triangles).de_all);
}

TEST_F(TransferTest, NeedsMotionOnlyWhereItDecomposes) {
  const Frames at_rest = source_.rest().reshaped<Eigen::RowMajor>().transpose().replicate(8, 1);
  const MeshSequence still = source_.with_frames(at_rest);
  EXPECT_THAT(
      [&] {
        transfer(still, {{"actor", actor_}}, options_);
      },
      ThrowsMessage<MismatchError>(HasSubstr("nothing moves: all 8 frames")));
  options_.full = true;
  EXPECT_NO_THROW(transfer(still, {{"actor", actor_}}, options_));
}

TEST_F(TransferTest, SolvesForTheVerticesInsideTheRegionsOfAMesh) {
  const Regions regions = this->regions();
  const VertexTransfer by_hand(placed()->rest(), mesh_.neutral(), mesh_.triangles(),
                               regions.triangles, {.inside = regions.inside});
  EXPECT_TRUE(frames_of(to(mesh_)) == by_hand.frames(*placed()));
}

TEST_F(TransferTest, OntoItselfReturnsTheSource) {
  options_.full = true;
  const BlendshapeModel self = test::model_on(test::patch(), 5);
  // The weights are exact to the rounding of a system whose condition is below 1e3.
  EXPECT_LT((frames_of(to(self)) - source_.positions()).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(TransferTest, ByAllTrianglesHasNoRegions) {
  options_.full = true;
  const TransferResult result = transfer(source_, {{"actor", actor_}}, options_);
  EXPECT_FALSE(result.regions);
  EXPECT_FALSE(result.components);
  const BlendshapeTransfer by_hand(placed()->rest(), actor_, all_triangles(source_.triangles()));
  EXPECT_TRUE(result.targets.front().solution.weights() == by_hand.weights(*placed()));
}

TEST_F(TransferTest, ByRegionsThatAreGivenDecomposesNothing) {
  options_.given = GivenRegions{"rois.json", regions()};
  const TransferResult result = transfer(source_, {{"actor", actor_}}, options_);
  EXPECT_FALSE(result.components);
  options_.given = {};
  EXPECT_TRUE(frames_of(result.targets.front()) == frames_of(to(actor_)));
}

TEST_F(TransferTest, ByComponentsThatAreGivenIsTheOneThatFoundThem) {
  const TransferResult found = transfer(source_, {{"actor", actor_}}, options_);
  options_.given = GivenComponents{"take.h5", *found.components};
  EXPECT_TRUE(frames_of(to(actor_)) == frames_of(found.targets.front()));
}

TEST_F(TransferTest, ToManyTargetsIsTheOneToEach) {
  const TransferResult both = transfer(source_, {{"actor", actor_}, {"mesh", mesh_}}, options_);
  ASSERT_EQ(both.targets.size(), 2U);
  EXPECT_TRUE(frames_of(both.targets[0]) == frames_of(to(actor_)));
  EXPECT_TRUE(frames_of(both.targets[1]) == frames_of(to(mesh_)));
}

TEST_F(TransferTest, SaysWhereTheResultIsNotUsable) {
  test::Noted noted;
  options_.full = true;
  to(mesh_, noted.context());
  EXPECT_TRUE(noted.notes.empty());
  // Few triangles whose surroundings are held where they are.
  options_.full = false;
  options_.given = GivenRegions{
      "rois", regions_from_vertices(actor_.vertices(), actor_.triangles(), {{10, 11, 12}})};
  const TransferredTarget torn = to(mesh_, noted.context());
  EXPECT_GT(missed_share(torn.error), 0.5);
  const auto found = std::ranges::find(noted.notes, Topic::poor_condition, &Note::topic);
  ASSERT_NE(found, noted.notes.end());
  EXPECT_THAT(found->text, HasSubstr("actor: the result may not be usable: "));
  EXPECT_THAT(found->text, HasSubstr("% of the deformation is missing"));
  EXPECT_TRUE(noted.has(Topic::visible_crease));
}

TEST_F(TransferTest, SaysWhatWouldBeMissingWithoutTheOptionsThatHoldIt) {
  test::Noted noted;
  options_.full = true;
  options_.solve.smoothness = 1e-3;
  Target held{"actor", actor_};
  held.rules.name = "low.json";
  for (const std::string& name : actor_.expressions().names) {
    held.rules.expressions[name].maximum = 0.01;
  }
  const TransferResult result = transfer(source_, {held}, options_, noted.context());
  EXPECT_GT(missed_share(result.targets.front().error), 0.5);
  ASSERT_FALSE(noted.notes.empty());
  EXPECT_THAT(noted.notes.back().text,
              HasSubstr("; without option 'smoothness' and option 'rules' "));
  EXPECT_THAT(noted.notes.back().text, HasSubstr("the result is usable"));
}

/// Regions that show little of most expressions.
GivenRegions a_corner(const BlendshapeModel& model) {
  return {"rois", regions_from_vertices(model.vertices(), model.triangles(), {{10, 11, 12}})};
}

TEST_F(TransferTest, CompletesRegionsThatLeaveExpressionsUnseen) {
  test::Noted noted;
  options_.given = a_corner(actor_);
  options_.regions.complete_limit = 1;
  const TransferResult result = transfer(source_, {{"actor", actor_}}, options_, noted.context());
  const TransferredTarget& target = result.targets.front();
  ASSERT_TRUE(target.regions);
  EXPECT_GT(target.regions->regions.size(), 1U);
  EXPECT_EQ(result.regions->triangles, target.regions->triangles);
  EXPECT_TRUE(target.solution.conditions.weakly_seen.empty());
  EXPECT_LT(missed_share(target.error), 0.1);
  EXPECT_FALSE(noted.has(Topic::completion_limit));
  ASSERT_TRUE(noted.has(Topic::completed_regions));
  EXPECT_THAT(noted.notes.front().text, AllOf(HasSubstr("added to the regions ("),
                                              HasSubstr("of the triangles), which hardly see")));

  options_.regions.complete_limit = 0;
  to(actor_, noted.context());
  EXPECT_TRUE(noted.has(Topic::completion_limit));

  options_.regions.complete = 0;
  const TransferredTarget as_given = to(actor_, noted.context());
  EXPECT_EQ(as_given.regions->regions.size(), 1U);
  EXPECT_GT(as_given.error.de_all, target.error.de_all);
}

TEST_F(TransferTest, CompletesRegionsForEachTargetByItself) {
  options_.given = a_corner(actor_);
  const BlendshapeModel other = test::model_on(test::patch(), 3);
  const TransferResult both =
      transfer(source_, {{"actor", actor_}, {"other", other}, {"mesh", mesh_}}, options_);
  EXPECT_TRUE(frames_of(both.targets[0]) == frames_of(to(actor_)));
  EXPECT_TRUE(frames_of(both.targets[1]) == frames_of(to(other)));
  EXPECT_EQ(both.targets[2].regions->regions.size(), 1U);
  // All of them together.
  for (const TransferredTarget& target : both.targets) {
    EXPECT_TRUE(std::ranges::includes(both.regions->triangles, target.regions->triangles));
  }
}

TEST_F(TransferTest, SumsOverTwoEdgesWhereItIsToBeAsThePaper) {
  options_.full = true;
  options_.analysis.compatibility = Compatibility::paper;
  const BlendshapeTransfer by_hand(placed()->rest(), actor_, all_triangles(source_.triangles()),
                                   {.edges = EdgeSum::two});
  const TransferredTarget target = to(actor_);
  EXPECT_TRUE(target.solution.weights() == by_hand.weights(*placed()));
  EXPECT_EQ(
      target.error.de_all,
      transfer_error(*placed(), *target.solution.sequence, {}, {.edges = EdgeSum::two}).de_all);
}

TEST_F(TransferTest, DoesNotDependOnTheNumberOfThreads) {
  EXPECT_TRUE(frames_of(to(actor_, Context().with_threads(1))) ==
              frames_of(to(actor_, Context().with_threads(3))));
}

TEST_F(TransferTest, GivesHeadMotionBackUnlessItIsDropped) {
  const MeshSequence moved = with_motion(source_, nodding(8));
  options_.source.head_motion = nodding(8);
  const auto result = [&](RemovedMotion removed) {
    options_.head_motion = removed;
    return transfer(moved, {{"actor", actor_}}, options_).targets.front().solution.sequence;
  };
  const auto kept = result(RemovedMotion::keep), dropped = result(RemovedMotion::drop);
  const Similarity similarity = similarity_fit(source_.rest(), actor_.neutral());
  std::vector<RigidTransform> carried = nodding(8);
  for (RigidTransform& motion : carried) motion = similarity.carry(motion);
  EXPECT_TRUE(test::frames_of(kept) == test::frames_of(with_motion(dropped, carried)));
  EXPECT_TRUE(dropped->rest() == actor_.neutral());
  EXPECT_TRUE(dropped->rest_is_known());
  EXPECT_FALSE(kept->rest_is_known());
}

TEST_F(TransferTest, RefusesATargetBeforeAnythingIsComputed) {
  const BlendshapeModel other = test::model_on(test::grid(3, 3), 1);
  int reports = 0;
  const Context context = Context().with_progress([&reports](double) { return ++reports > 0; });
  EXPECT_THAT(
      [&] {
        transfer(source_, {{"actor", actor_}, {"small", other}}, options_, context);
      },
      ThrowsMessage<MismatchError>("small: 9 vertices, expected 81 as in the source"));
  EXPECT_EQ(reports, 0);
}

TEST_F(TransferTest, TellsATargetThatIsOnlyNumberedDifferently) {
  const int last = source_.vertices() - 1;
  const BlendshapeModel backwards =
      test::model_on({Positions(actor_.neutral().colwise().reverse()),
                      Triangles((last - source_.triangles().array()).matrix())},
                     1);
  EXPECT_THAT([&] { to(backwards); },
              ThrowsMessage<MismatchError>(HasSubstr(
                  "has the same faces, " + std::to_string(last % 2 == 0 ? last : last + 1) +
                  " vertices renumbered against the source; write the source in its numbering")));
}

/// A sheet of quads; of the other, each begins at another corner, which is the same face.
Connectivity quads(int first) {
  Polygons polygons;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const int at = 9 * row + column;
      const std::vector<int> corners = {at, at + 1, at + 10, at + 9};
      for (int c = 0; c < 4; ++c) polygons.corners.push_back(corners[(c + first + at % 2) % 4]);
      polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
    }
  }
  return Connectivity::from_polygons(81, std::move(polygons));
}

TEST_F(TransferTest, CutsQuadsThatBeginAtAnotherCornerAsTheSourceDoes) {
  const auto of_source = std::make_shared<Connectivity>(quads(0));
  const auto rolled = std::make_shared<Connectivity>(quads(1));
  ASSERT_NE(of_source->triangles, rolled->triangles);
  const MeshSequence source(of_source, source_.positions(), source_.times(), source_.rest());
  for (const BlendshapeModel& target : {actor_, mesh_}) {
    const BlendshapeModel alike(of_source, target.neutral(), target.expressions());
    const BlendshapeModel other(rolled, target.neutral(), target.expressions());
    const auto onto = [&](const BlendshapeModel& model) {
      return transfer(source, {{"actor", model}}, options_).targets.front();
    };
    const TransferredTarget result = onto(other), expected = onto(alike);
    EXPECT_TRUE(frames_of(result) == frames_of(expected));
    EXPECT_EQ(result.error.de_all, expected.error.de_all);
    // The polygons are written as the target has them.
    EXPECT_EQ(result.solution.sequence->connectivity().polygons, rolled->polygons);
  }
}

TEST_F(TransferTest, RefusesRegionsOfAnotherMeshOrWithoutATriangle) {
  const Regions regions = a_corner(actor_).regions;
  Regions other = regions, empty = regions;
  other.all_triangles = 7;
  options_.given = GivenRegions{"rois.json", other};
  EXPECT_THAT([&] { to(actor_); },
              ThrowsMessage<MismatchError>(HasSubstr("rois.json: regions of a mesh with 81")));
  empty.triangles.clear();
  options_.given = GivenRegions{"rois.json", empty};
  EXPECT_THAT([&] { to(actor_); },
              ThrowsMessage<MismatchError>(HasSubstr("hold no triangle of the mesh")));
}

TEST_F(TransferTest, ReportsProgressThatRisesAndEndsWhereItIsAskedTo) {
  std::vector<double> shares;
  const auto keep = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  to(actor_, Context().with_progress(keep));
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.back(), 1);
  const auto stop = [](double share) { return share < 0.5; };
  EXPECT_THROW(to(actor_, Context().with_progress(stop)), Cancelled);
}

TEST_F(TransferTest, ChecksItsRangesBeforeItComputes) {
  options_.analysis.rho = 0;
  EXPECT_THAT([&] { to(actor_); }, ThrowsMessage<std::invalid_argument>(HasSubstr("rho is 0")));
}

TEST_F(TransferTest, FindsHeadMotionTogetherWithTheExpressionsWhereverTheTargetStands) {
  const BlendshapeModel model = test::model_on(test::patch(), 5);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  ShapeBasis basis = model.expressions();
  for (int j = 0; j < basis.size(); ++j) {
    for (int v = 0; v < model.vertices(); ++v) {
      basis.displacements.col(j).segment<3>(3 * v).applyOnTheLeft(10 * turn);
    }
  }
  const Positions neutral =
      (10 * model.neutral() * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -7, 2);
  const BlendshapeModel elsewhere(model.shared_connectivity(), neutral, basis);
  const Eigen::MatrixXd weights = test::random_weights(8, 5);
  options_ = {.full = true, .head_motion = RemovedMotion::drop};
  options_.source = {.rest = model.neutral(), .head_motion = HeadMotion::joint};
  const TransferResult result = transfer(bare(with_motion(model.animate(weights), nodding(8))),
                                         {{"actor", elsewhere}}, options_);
  EXPECT_LT((result.targets[0].solution.weights() - weights).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(result.head_motion.angle, nodding(8).back().angle(), 1e-5);
  EXPECT_TRUE(result.head_motion.held_out);
}

TEST_F(TransferTest, FindsNoJointHeadMotionForVertices) {
  options_.source.head_motion = HeadMotion::joint;
  EXPECT_EQ(test::topic_of([&] { to(mesh_); }), Topic::no_joint_motion);
}

}  // namespace
}  // namespace mimetra
