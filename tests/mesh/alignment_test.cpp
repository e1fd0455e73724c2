#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/streams.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Rotations up to `degrees` about any axis, translations up to `shift` along each.
std::vector<RigidTransform> random_motion(int frames, double degrees, double shift) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<RigidTransform> motion(frames);
  for (RigidTransform& transform : motion) {
    const Eigen::Vector3d axis(uniform(random), uniform(random), uniform(random));
    const double angle = uniform(random) * degrees * std::numbers::pi / 180;
    transform.rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    transform.translation =
        shift * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  }
  return motion;
}

/// A sphere whose upper half is still and whose lower front opens downwards like a jaw.
MeshSequence opening_jaw(int frames) {
  const TriMesh head = test::mesh_of(test::sphere(4));
  Frames poses = head.positions.reshaped<Eigen::RowMajor>().transpose().replicate(frames, 1);
  for (int f = 0; f < frames; ++f) {
    const double open = std::pow(std::sin(0.4 * f), 2);
    for (int v = 0; v < head.connectivity.vertices; ++v) {
      const auto point = head.positions.row(v);
      const double share = std::max(0.0, -point.z()) * std::max(0.0, point.x() + 0.3);
      poses(f, 3 * v + 2) -= 0.5 * open * share;
      poses(f, 3 * v) -= 0.2 * open * share;
    }
  }
  return {head.connectivity, poses, {}, head.positions};
}

MeshSequence with_noise(const MeshSequence& sequence, double sigma) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, sigma);
  Frames frames = sequence.positions();
  for (double& coordinate : frames.reshaped()) coordinate += normal(random);
  return sequence.with_frames(frames);
}

/// Largest distance between corresponding points of two sequences.
double difference(const MeshSequence& a, const MeshSequence& b) {
  double largest = 0;
  for (int f = 0; f < a.frames(); ++f) {
    largest = std::max(largest, (a.frame(f) - b.frame(f)).rowwise().norm().maxCoeff());
  }
  return largest;
}

double largest_angle(const std::vector<RigidTransform>& a, const std::vector<RigidTransform>& b) {
  double largest = 0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    const Eigen::Matrix3d between = a[f].rotation.transpose() * b[f].rotation;
    largest = std::max(largest, Eigen::AngleAxisd(between).angle());
  }
  return largest;
}

MeshSequence bare(const MeshSequence& sequence) {
  return {sequence.shared_connectivity(), sequence.positions(), sequence.times()};
}

/// How far align(moved) is from align(unmoved), moved as the first frame was.
double change_by_motion(const MeshSequence& sequence, const std::vector<RigidTransform>& motion) {
  const MeshSequence moved = bare(with_motion(sequence, motion));
  const std::vector<RigidTransform> first(sequence.frames(), motion.front());
  return difference(rigidly_aligned(moved), with_motion(rigidly_aligned(bare(sequence)), first));
}

// Rounding of a few operations on coordinates of size 1.
constexpr double kRounding = 1e-14;

TEST(RigidTransform, FollowedByItsInverseIsNothing) {
  const RigidTransform transform = random_motion(1, 90, 2)[0];
  const Positions points = test::octahedron().positions;
  EXPECT_TRUE(transform.inverse().apply(transform.apply(points)).isApprox(points, kRounding));
}

TEST(RigidTransform, OfTheIdentityKeepsEveryBit) {
  const Positions points = -0.0 * Positions::Ones(2, 3);
  const Positions result = RigidTransform().apply(points);
  EXPECT_TRUE(std::signbit(result(1, 2)));
}

TEST(RigidFit, FindsTheMotionOfRigidPoints) {
  const RigidTransform motion = random_motion(1, 180, 5)[0];
  const Positions points = test::sphere(1).positions;
  const RigidTransform fit = rigid_fit(points, motion.apply(points));
  EXPECT_TRUE(fit.rotation.isApprox(motion.rotation, kRounding));
  EXPECT_TRUE(fit.translation.isApprox(motion.translation, kRounding));
}

TEST(RigidFit, NeverReflects) {
  const Positions points = test::sphere(1).positions;
  EXPECT_NEAR(rigid_fit(points, -points).rotation.determinant(), 1, kRounding);
  const RigidTransform motion = random_motion(1, 180, 5)[0];
  const Positions flat = test::grid(4, 3).positions;
  EXPECT_TRUE(rigid_fit(flat, motion.apply(flat)).rotation.isApprox(motion.rotation, 1e-13));
}

TEST(RigidFit, IgnoresPointsOfWeightZero) {
  const RigidTransform motion = random_motion(1, 60, 1)[0];
  const Positions points = test::sphere(1).positions;
  Positions moved = motion.apply(points);
  moved.row(0) << 100, 100, 100;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(points.rows());
  weights[0] = 0;
  EXPECT_TRUE(rigid_fit(points, moved, weights).rotation.isApprox(motion.rotation, kRounding));
}

TEST(RigidFit, HasTheLeastWeightedSumOfSquares) {
  const Positions from = test::sphere(1).positions;
  const Positions to = from + 0.3 * Positions::Random(from.rows(), 3);
  const Eigen::VectorXd weights = Eigen::VectorXd::Random(from.rows()).cwiseAbs();
  const auto energy = [&](const RigidTransform& transform) {
    return weights.dot((transform.apply(from) - to).rowwise().squaredNorm());
  };
  const RigidTransform best = rigid_fit(from, to, weights);
  for (const RigidTransform& step : random_motion(50, 1, 0.01)) {
    const RigidTransform other{step.rotation * best.rotation, step.translation + best.translation};
    EXPECT_LT(energy(best), energy(other));
  }
}

TEST(RigidFit, KeepsItsDigitsFarFromTheOrigin) {
  const Positions points = test::sphere(1).positions;
  const Positions far = points.array() + 1024;
  // 1024 costs 10 bits of the positions, the fit no more.
  EXPECT_TRUE(rigid_fit(points, far).rotation.isIdentity(1e3 * kRounding));
}

TEST(RigidFit, RefusesOtherSizesAndWeightsWithoutASum) {
  const Positions four = Positions::Random(4, 3), five = Positions::Random(5, 3);
  EXPECT_THAT([&] { rigid_fit(four, five); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("rigid fit of 4 points to 5")));
  EXPECT_THAT([&] { rigid_fit(four, four, Eigen::VectorXd::Ones(3)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 weights for 4 points")));
  EXPECT_THAT([&] { rigid_fit(four, four, Eigen::VectorXd::Zero(4)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("not all 0")));
}

TEST(StableAlignment, FindsTheHeadsMotionBehindAnOpeningJaw) {
  const MeshSequence jaw = opening_jaw(24);
  const auto motion = random_motion(24, 40, 0.6);
  const Alignment alignment = align(with_motion(jaw, motion));
  // The still half locks: what is left is kLeastWeight's 1e-10 of the jaw's motion.
  EXPECT_LT(difference(alignment.sequence, jaw), 1e-9);
  EXPECT_EQ(alignment.sequence.rest(), jaw.rest());
  EXPECT_LT(largest_angle(alignment.motion, motion), 1e-9);
}

TEST(StableAlignment, DoesBetterThanAllVertices) {
  const MeshSequence jaw = opening_jaw(24);
  const MeshSequence moved = with_motion(jaw, random_motion(24, 5, 0.1));
  // The jaw's motion of up to a quarter of the radius reads as a rotation of more than a degree.
  EXPECT_GT(difference(align(moved, {.vertices = AlignmentVertices::all}).sequence, jaw), 0.02);
}

TEST(StableAlignment, IsAsGoodAsTheNoise) {
  const double sigma = 1e-4;
  const MeshSequence jaw = opening_jaw(24);
  const auto motion = random_motion(24, 10, 0.2);
  const Alignment alignment = align(with_noise(with_motion(jaw, motion), sigma));
  // 1026 vertices, of which at least one in twenty decides: an angle's standard error is about
  // sigma / sqrt(50) = sigma / 7; the largest of 24 frames x 3 axes stays below the noise.
  EXPECT_LT(largest_angle(alignment.motion, motion), sigma);
}

TEST(StableAlignment, OfAStillHeadIsTheInputBitByBitDespiteNoise) {
  const MeshSequence jaw = opening_jaw(24);
  for (const MeshSequence& still : {jaw, with_noise(jaw, 1e-3)}) {
    const Alignment alignment = align(still);
    EXPECT_EQ(alignment.sequence.positions(), still.positions());
    for (const RigidTransform& transform : alignment.motion) EXPECT_TRUE(transform.is_identity());
  }
}

TEST(StableAlignment, DoesNotDependOnTheMotionItRemoves) {
  const MeshSequence jaw = opening_jaw(24);
  // Nothing but residuals enters, so that only rounding differs, which 40 iterations amplify.
  const MeshSequence nodding = with_motion(with_noise(jaw, 1e-2), random_motion(24, 10, 0.2));
  for (const MeshSequence& sequence : {jaw, nodding}) {
    EXPECT_LT(change_by_motion(sequence, random_motion(24, 40, 0.6)), 1e-9);
  }
}

/// Every vertex moves; the motion itself is not rigid.
MeshSequence breathing(int frames) {
  const TriMesh ball = test::mesh_of(test::sphere(3));
  Frames poses(frames, ball.positions.size());
  for (int f = 0; f < frames; ++f) {
    const Eigen::Vector3d scale(1 + 0.02 * std::sin(f), 1 - 0.03 * std::cos(f), 1);
    poses.row(f) = (ball.positions * scale.asDiagonal()).reshaped<Eigen::RowMajor>().transpose();
  }
  return {ball.connectivity, poses, {}, ball.positions};
}

TEST(StableAlignment, WithoutStillVerticesStaysWithinTheDeformation) {
  const MeshSequence ball = breathing(16);
  const MeshSequence aligned = rigidly_aligned(with_motion(ball, random_motion(16, 30, 1)));
  // The ball's points move by at most 3 % of its radius; an alignment may move them once more.
  EXPECT_LT(difference(aligned, ball), 0.06);
}

TEST(StableAlignment, OfAFrameThatIsTheRestPoseIsTheIdentity) {
  const Alignment alignment = align(bare(with_motion(breathing(4), random_motion(4, 30, 1))));
  EXPECT_TRUE(alignment.motion[0].is_identity());
  EXPECT_FALSE(alignment.motion[1].is_identity());
}

TEST(StableAlignment, OfStillVerticesOnALineDoesNotSpinAboutIt) {
  // Of a flat grid only one row is still; the others tilt one way in half of the frames.
  const TriMesh sheet = test::mesh_of(test::grid(30, 8));
  Frames poses = sheet.positions.reshaped<Eigen::RowMajor>().transpose().replicate(10, 1);
  for (int f = 5; f < 10; ++f) {
    for (int v = 30; v < 240; ++v) {
      const int row = v / 30;
      poses(f, 3 * v + 2) += 0.02 * row * (v % 3);
    }
  }
  const MeshSequence sequence(sheet.connectivity, poses, {}, sheet.positions);
  const MeshSequence aligned = rigidly_aligned(with_motion(sequence, random_motion(10, 40, 3)));
  // The deformation, at most 0.28 high, bounds the rotation about the line.
  EXPECT_LT(difference(aligned, sequence), 0.28);
}

TEST(StableAlignment, OfNoVerticesIsEmpty) {
  EXPECT_EQ(align(MeshSequence(Connectivity(), Frames(2, 0))).motion.size(), 2u);
}

TEST(StableAlignment, OfCoincidingVerticesIsFinite) {
  const MeshSequence point(Connectivity::from_triangles(3, Triangles(0, 3)), Frames::Ones(2, 9));
  EXPECT_TRUE(rigidly_aligned(point).positions().allFinite());
}

/// The motion by the same iteration over all frames in memory, step by step.
std::vector<RigidTransform> literal_stable_motion(const MeshSequence& sequence) {
  const Eigen::Index vertices = sequence.vertices();
  const double least_scale = 1e-12 * box_diagonal(sequence.rest());
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(vertices);
  std::vector<RigidTransform> motion;
  double scale = 0;
  for (int iteration = 0; iteration < 40; ++iteration) {
    motion.assign(sequence.frames(), {});
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(vertices);
    for (int f = 0; f < sequence.frames(); ++f) {
      const PositionsView frame = sequence.frame(f);
      if (frame != sequence.rest()) motion[f] = rigid_fit(sequence.rest(), frame, weights);
      const Eigen::Matrix3d rotation = motion[f].rotation;
      const Eigen::Vector3d translation = motion[f].translation;
      for (Eigen::Index v = 0; v < vertices; ++v) {
        const Eigen::Vector3d point = sequence.rest().row(v);
        squares[v] +=
            (rotation.lazyProduct(point) + translation - frame.row(v).transpose()).squaredNorm();
      }
    }
    const Eigen::VectorXd residuals = (squares / sequence.frames()).cwiseSqrt();
    std::vector<double> sorted(residuals.begin(), residuals.end());
    std::ranges::sort(sorted);
    const auto quantile = [&](double share) {
      return sorted[static_cast<std::size_t>(share * static_cast<double>(vertices - 1))];
    };
    const double target = std::max(quantile(0.05), least_scale);
    const bool settled = scale == least_scale;
    scale = iteration == 0 ? std::max(target, quantile(0.5))
                           : std::min(scale, std::max(target, 0.7 * scale));
    const Eigen::VectorXd next =
        (1 + (residuals.array() / scale).square()).square().inverse().max(1e-10);
    if (settled || (next - weights).cwiseAbs().maxCoeff() < 1e-6) break;
    weights = next;
  }
  return motion;
}

TEST(StableAlignment, OfAStreamIsBitByBitTheOneInMemory) {
  const MeshSequence moved =
      with_motion(with_noise(opening_jaw(24), 1e-3), random_motion(24, 40, 0.6));
  const auto stream = test::streamed(moved);
  const std::vector<RigidTransform> expected = literal_stable_motion(moved);
  for (const int threads : {1, 3}) {
    const std::vector<RigidTransform> found =
        rigid_motion(*stream, {}, Context().with_threads(threads));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t f = 0; f < found.size(); ++f) {
      EXPECT_TRUE(found[f].rotation == expected[f].rotation) << f;
      EXPECT_TRUE(found[f].translation == expected[f].translation) << f;
    }
  }
  const auto still = without_motion(stream, expected);
  EXPECT_TRUE(still->read(5, 7) == align(moved).sequence.positions().middleRows(5, 7));
}

TEST(StableAlignment, OfAStreamThatBreaksThrowsWhatReadingThrows) {
  EXPECT_THAT([] { rigid_motion(*test::streamed(opening_jaw(24), 13)); },
              ThrowsMessage<std::runtime_error>("frame 13 is broken"));
}

TEST(StableAlignment, ReportsProgressThatEndsAtOneOrWhenAskedTo) {
  double last = -1;
  const auto rising = [&last](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  align(opening_jaw(2), {}, Context().with_progress(rising));
  EXPECT_EQ(last, 1);
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(align(opening_jaw(2), {}, cancelled), Cancelled);
}

TEST(Alignment, OfAllVerticesIsTheRigidFitOfEachFrame) {
  const MeshSequence jaw = opening_jaw(6);
  const Alignment alignment = align(jaw, {.vertices = AlignmentVertices::all});
  for (int f = 1; f < 6; ++f) {
    const RigidTransform fit = rigid_fit(jaw.rest(), jaw.frame(f));
    EXPECT_TRUE(alignment.motion[f].rotation.isApprox(fit.rotation, kRounding));
  }
}

TEST(Alignment, OfAStreamIsBitByBitTheOneInMemory) {
  const MeshSequence moved = with_motion(opening_jaw(8), random_motion(8, 40, 1));
  const auto stream = test::streamed(moved);
  const Alignment alignment = align(moved, {.vertices = AlignmentVertices::all});
  const auto motion =
      rigid_motion(*stream, {.vertices = AlignmentVertices::all}, Context().with_threads(3));
  const auto still = without_motion(stream, motion);
  EXPECT_TRUE(MeshSequence(*still).positions() == alignment.sequence.positions());
  const auto back = with_motion(still, motion);
  const MeshSequence expected = with_motion(alignment.sequence, alignment.motion);
  for (int f = 0; f < 8; ++f) {
    EXPECT_TRUE(back->read(f, 1) == expected.positions().row(f));
    EXPECT_TRUE(expected.frame(f) == motion[f].apply(alignment.sequence.frame(f)));
  }
}

TEST(Alignment, IsUndoneByGivingTheMotionBack) {
  const MeshSequence moved = with_motion(opening_jaw(8), random_motion(8, 40, 1));
  const Alignment alignment = align(moved);
  EXPECT_LT(difference(with_motion(alignment.sequence, alignment.motion), moved), kRounding);
}

TEST(Alignment, WithAGivenMotionRemovesIt) {
  const MeshSequence jaw = opening_jaw(8);
  const auto motion = random_motion(8, 40, 1);
  EXPECT_LT(difference(align(with_motion(jaw, motion), motion).sequence, jaw), kRounding);
}

TEST(Alignment, RefusesAnotherNumberOfTransforms) {
  const auto refusal =
      ThrowsMessage<MismatchError>(HasSubstr("3 rigid transforms, expected 2, one per frame"));
  const std::vector<RigidTransform> three(3);
  EXPECT_THAT([&] { align(opening_jaw(2), three); }, refusal);
  EXPECT_THAT([&] { with_motion(opening_jaw(2), three); }, refusal);
}

TEST(CapturedAlignment, OfATalkingFaceDoesNotDependOnItsHeadMotion) {
  const auto folder = test::shared_path("data/ict-face");
  const auto weights = test::shared_path("data/captures/talking-60fps-1200.csv");
  MIMETRA_SKIP_WITHOUT(folder);
  MIMETRA_SKIP_WITHOUT(weights);
  const MeshSequence talking =
      test::captured_performance(folder / "neutral.obj", folder / "expressions", weights, 300)
          .slice(0, 300, 10);
  const double box = box_diagonal(talking.rest());
  EXPECT_LT(change_by_motion(talking, random_motion(30, 40, 0.3 * box)), 1e-6 * box);
}

TEST(CapturedAlignment, OfAHeadWhoseBackIsStillIsExact) {
  const auto folder = test::shared_path("data/facecap");
  MIMETRA_SKIP_WITHOUT(folder);
  const MeshSequence talking =
      test::captured_performance(folder / "neutral.obj", folder / "targets", folder / "weights.csv",
                                 335)
          .slice(0, 335, 10);
  const double box = box_diagonal(talking.rest());
  const auto motion = random_motion(talking.frames(), 40, 0.3 * box);
  // A quarter of the vertices is in no target; kLeastWeight leaves the rest 1e-10 of their motion.
  EXPECT_LT(difference(rigidly_aligned(with_motion(talking, motion)), talking), 1e-9 * box);
}

}  // namespace
}  // namespace mimetra
