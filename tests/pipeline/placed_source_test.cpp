// Source and target that stand in other units, places and axes: the result follows.

#include <random>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::frames_of;
using test::nodding;
using test::take;
using testing::HasSubstr;

/// x -> scale rotation x + translation, as a user's other program might have it.
struct Stand {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::RowVector3d translation = Eigen::RowVector3d::Zero();

  Positions of(const Positions& points) const {
    return (scale * points * rotation.transpose()).rowwise() + translation;
  }
  Frames of(const Frames& frames) const {
    Frames moved = frames;
    for (Eigen::Index f = 0; f < frames.rows(); ++f) {
      Eigen::Map<Positions> pose(moved.row(f).data(), frames.cols() / 3, 3);
      pose = of(Positions(pose));
    }
    return moved;
  }
  MeshSequence of(const MeshSequence& sequence) const {
    return {sequence.shared_connectivity(), of(sequence.positions()), sequence.times(),
            of(sequence.rest())};
  }
  BlendshapeModel of(const BlendshapeModel& model) const {
    ShapeBasis expressions = model.expressions();
    for (Eigen::Index j = 0; j < expressions.displacements.cols(); ++j) {
      Eigen::Map<Positions> field(expressions.displacements.col(j).data(), model.vertices(), 3);
      field = Positions(scale * field * rotation.transpose());
    }
    return {model.shared_connectivity(), of(model.neutral()), std::move(expressions)};
  }
  RigidTransform of(const RigidTransform& motion) const {
    RigidTransform moved;
    moved.rotation = rotation * motion.rotation * rotation.transpose();
    moved.translation = scale * rotation * motion.translation + translation.transpose() -
                        moved.rotation * translation.transpose();
    return moved;
  }
};

Stand some_stand(unsigned seed, double scale) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
  const Eigen::AngleAxisd turn(2 * normal(random), axis.normalized());
  // Ten sizes of a patch away.
  return {scale, turn.toRotationMatrix(),
          10 * scale * Eigen::RowVector3d(normal(random), normal(random), normal(random))};
}

class PlacedSourceTest : public testing::Test {
 protected:
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const std::vector<RigidTransform> nod_ = nodding(8);
  const MeshSequence source_ = with_motion(take(), nod_);
  TransferOptions options_{.full = true};

  BlendshapeModel mesh_of(const BlendshapeModel& model) const {
    return {model.shared_connectivity(),
            model.neutral(),
            {{}, Eigen::MatrixXd(3 * model.vertices(), 0)}};
  }

  TransferredTarget transferred(const Stand& source, const BlendshapeModel& target) {
    std::vector<RigidTransform> motion;
    for (const RigidTransform& each : nod_) motion.push_back(source.of(each));
    options_.source.head_motion = motion;
    return transfer(source.of(source_), {{"actor", target}}, options_).targets.front();
  }

  double size() const { return diameter(actor_.neutral()); }
};

TEST_F(PlacedSourceTest, FollowsItsUnitPlaceAndAxesInBothSpaces) {
  for (const bool in_vertices : {false, true}) {
    const BlendshapeModel target = in_vertices ? mesh_of(actor_) : actor_;
    const TransferredTarget plain = transferred({}, target);
    const Frames expected = frames_of(plain.solution.sequence);
    const double error = plain.error.de_all;
    for (const double scale : {1e-3, 1.0, 1e3}) {
      const Stand of_source = some_stand(1, scale), of_target = some_stand(2, 1 / scale);
      const TransferredTarget by_source = transferred(of_source, target);
      EXPECT_LT((frames_of(by_source.solution.sequence) - expected).cwiseAbs().maxCoeff(),
                1e-9 * size());
      EXPECT_NEAR(by_source.error.de_all, error, 1e-9 * error);
      const TransferredTarget both = transferred(of_source, of_target.of(target));
      EXPECT_LT((frames_of(both.solution.sequence) - of_target.of(expected)).cwiseAbs().maxCoeff(),
                1e-9 * of_target.scale * size());
    }
  }
}

TEST_F(PlacedSourceTest, ThatIsTheMirrorImageMovesMirrored) {
  const Stand mirror{1, Eigen::Vector3d(-1, 1, 1).asDiagonal(), {0, 0, 0}};
  test::Noted noted;
  const MeshSequence source = mirror.of(take());
  // The mirror image has the same faces, which look inwards now.
  const auto onto = [&](const BlendshapeModel& target, const MeshSequence& performance) {
    return transfer(performance, {{"actor", target}}, options_, noted.context()).targets.front();
  };
  const BlendshapeModel self = test::model_on(test::patch(), 5);
  const TransferredTarget result = onto(self, source);
  EXPECT_TRUE(result.similarity.mirrors());
  EXPECT_LT((frames_of(result.solution.sequence) - take().positions()).cwiseAbs().maxCoeff(),
            1e-9 * size());
  ASSERT_FALSE(noted.notes.empty());
  EXPECT_THAT(noted.notes.front().text, HasSubstr("actor: is the source's mirror image"));
}

TEST_F(PlacedSourceTest, WithoutAxesKeepsTheGradientsOfThePaper) {
  options_.solve.axes = Axes::none;
  const MeshSequence source = take();
  const TransferredTarget result = transfer(source, {{"actor", actor_}}, options_).targets.front();
  EXPECT_EQ(result.similarity.angle(), 0);
  const BlendshapeTransfer by_hand(source.rest(), actor_, all_triangles(source.triangles()));
  EXPECT_TRUE(result.solution.weights().isApprox(by_hand.weights(source), 1e-9));
}

TEST_F(PlacedSourceTest, IsTheSourceItselfWhereTheRestPosesAreEqual) {
  const BlendshapeModel self = test::model_on(test::patch(), 5);
  const Source source = prepare_source(take());
  const PlacedSource placed = placed_at({"self", self}, source);
  EXPECT_TRUE(placed.similarity.is_identity());
  EXPECT_EQ(placed.source.sequence, source.sequence);
}

TEST_F(PlacedSourceTest, ThatLeavesItsRotationOpenIsRefused) {
  const auto faces =
      std::make_shared<Connectivity>(Connectivity::from_triangles(3, Eigen::RowVector3i(0, 1, 2)));
  Positions line(3, 3), bent(3, 3);
  line << 0, 0, 0, 1, 0, 0, 2, 0, 0;
  bent << 0, 0, 0, 1, 0, 0, 2, 1, 0;
  const MeshSequence source(faces, line.reshaped<Eigen::RowMajor>().transpose(), {}, line);
  const BlendshapeModel target(faces, bent, {{}, Eigen::MatrixXd(9, 0)});
  EXPECT_EQ(test::topic_of([&] {
              placed_at({"target", target}, prepare_source(source));
            }),
            Topic::undetermined_axes);
}

}  // namespace
}  // namespace mimetra
