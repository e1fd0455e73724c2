#include "toolkit/mesh/rest_beyond_frames.h"

#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/thread_ranks.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

constexpr int kFrames = 100;

/// Frames that mix three bumps of a sphere's surface; its rest pose is none of them.
MeshSequence bumpy_take(const Positions& rest_offset) {
  const TriMesh mesh = test::mesh_of(test::sphere(2));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> weight(0, 0.3);
  Frames bumps = Frames::Zero(3, mesh.positions.size());
  for (int b = 0; b < 3; ++b) {
    for (Eigen::Index v = b; v < mesh.positions.rows(); v += 2 + b) {
      bumps.row(b).segment<3>(3 * v) = mesh.positions.row(v);
    }
  }
  Frames frames = mesh.positions.reshaped<Eigen::RowMajor>().transpose().replicate(kFrames, 1);
  for (auto&& frame : frames.rowwise()) {
    for (int b = 0; b < 3; ++b) frame += weight(random) * bumps.row(b);
  }
  return {mesh.connectivity, std::move(frames), {}, mesh.positions + rest_offset};
}

Positions no_offset() {
  return Positions::Zero(test::sphere(2).positions.rows(), 3);
}

/// Every vertex another way, `size` far (root mean square).
Positions offset_everywhere(double size) {
  std::mt19937 random(3);
  std::normal_distribution<double> number(0, size / std::sqrt(3.0));
  return no_offset().unaryExpr([&](double) { return number(random); });
}

RestBeyondFrames found_in(const MeshSequence& sequence, const Context& context = {}) {
  return rest_beyond_frames(std::make_shared<const MeshSequence>(sequence), context);
}

TEST(RestBeyondFrames, IsTheDistanceFromTheNearestMixtureOfEveryOther) {
  const MeshSequence sequence = bumpy_take(offset_everywhere(0.1));
  // All frames are looked at, and all vertices.
  const Frames& poses = sequence.positions();
  // Differences of every other frame, and what moves, turns and scales their mean.
  constexpr int kHalf = kFrames / 2;
  Eigen::MatrixXd differences(poses.cols(), kHalf - 1 + 7);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(poses.cols());
  for (int f = 0; f < kHalf; ++f) mean += poses.row(2 * f).transpose() / kHalf;
  for (int f = 1; f < kHalf; ++f) {
    differences.col(f - 1) = (poses.row(2 * f) - poses.row(0)).transpose();
  }
  const Positions mean_pose = PositionsView(mean.data(), sequence.vertices(), 3);
  const Eigen::RowVector3d center = mean_pose.colwise().mean();
  for (int v = 0; v < sequence.vertices(); ++v) {
    const Eigen::Vector3d from = (mean_pose.row(v) - center).transpose();
    auto of_vertex = differences.block<3, 7>(3 * v, kHalf - 1);
    for (int axis = 0; axis < 3; ++axis) {
      of_vertex.col(axis) = Eigen::Vector3d::Unit(axis);
      of_vertex.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(from);
    }
    of_vertex.col(6) = from;
  }
  const auto distance = [&](const Eigen::VectorXd& pose) {
    const Eigen::VectorXd from = pose - poses.row(0).transpose();
    const Eigen::VectorXd nearest = differences.colPivHouseholderQr().solve(from);
    return (from - differences * nearest).norm() / std::sqrt(double(sequence.vertices())) /
           sequence.diameter();
  };
  const RestBeyondFrames found = found_in(sequence);
  EXPECT_NEAR(found.of_rest, distance(sequence.rest().reshaped<Eigen::RowMajor>()), 1e-9);
  EXPECT_LT(found.of_frames, 1e-9);
  EXPECT_EQ(found.frames, kFrames);
  EXPECT_TRUE(found.is_of_other_face());
  EXPECT_THAT(described(found), testing::HasSubstr("% of the size (RMS) beyond all mixtures"));
}

TEST(RestBeyondFrames, IsNothingOfAMixtureThatNoFrameIs) {
  const RestBeyondFrames found = found_in(bumpy_take(no_offset()));
  EXPECT_LT(found.of_rest, 1e-9);
  EXPECT_FALSE(found.is_of_other_face());
}

TEST(RestBeyondFrames, IsNoOtherFaceThatIsMovedTurnedABitOrScaled) {
  const MeshSequence own = bumpy_take(no_offset());
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  const Positions rest = Positions(own.rest());
  for (const Positions& moved : {Positions(rest * turn.transpose()), Positions(1.1 * rest),
                                 Positions(rest.rowwise() + Eigen::RowVector3d(3, 0, 1))}) {
    const RestBeyondFrames found =
        found_in(MeshSequence(own.shared_connectivity(), own.positions(), {}, moved));
    EXPECT_LT(found.of_rest, 2e-3);
    EXPECT_FALSE(found.is_of_other_face());
  }
}

TEST(RestBeyondFrames, IsNoOtherFaceWhereNoiseIsAsFar) {
  MeshSequence sequence = bumpy_take(no_offset());
  Frames noisy = sequence.positions();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  for (double& coordinate : noisy.reshaped()) coordinate += noise(random);
  const RestBeyondFrames found =
      found_in(MeshSequence(sequence.shared_connectivity(), noisy, {}, Positions(sequence.rest())));
  EXPECT_GT(found.of_frames, 0.005);
  EXPECT_GT(found.of_rest, 0.003);
  EXPECT_FALSE(found.is_of_other_face());
}

TEST(RestBeyondFrames, IsNoOtherFaceWhereMuchOfItIsStill) {
  Positions aside = no_offset();
  for (Eigen::Index v = 0; v < aside.rows(); v += 20) aside(v, v % 3) = 0.3;
  const RestBeyondFrames found = found_in(bumpy_take(aside));
  EXPECT_GT(found.of_rest, 0.01);
  EXPECT_FALSE(found.is_of_other_face());
}

TEST(RestBeyondFrames, OfFewFramesTellsNothing) {
  const RestBeyondFrames found = found_in(bumpy_take(offset_everywhere(0.1)).slice(0, 3));
  EXPECT_EQ(found.of_rest, 0);
  EXPECT_FALSE(found.is_of_other_face());
}

TEST(RestBeyondFrames, IsTheSameForEveryNumberOfThreadsAndRanks) {
  const MeshSequence sequence = bumpy_take(offset_everywhere(0.1));
  const RestBeyondFrames one = found_in(sequence, Context().with_threads(1));
  EXPECT_EQ(found_in(sequence, Context().with_threads(3)).of_rest, one.of_rest);
  test::on_ranks(3, [&](const Ranks& ranks) {
    const RestBeyondFrames found = found_in(sequence, Context().with_threads(1).with_ranks(ranks));
    EXPECT_EQ(found.of_rest, one.of_rest);
    EXPECT_EQ(found.least, one.least);
  });
}

TEST(RestBeyondFrames, TellsTheNeutralOfACapturedFaceFromOtherPeoples) {
  const auto data = test::shared_path("data");
  const auto folder = data / "ict-face";
  MIMETRA_SKIP_WITHOUT(folder);
  const MeshSequence talking =
      test::captured_performance(folder / "neutral.obj", folder / "expressions",
                                 data / "captures" / "talking-60fps-1200.csv", 300);
  for (const int count : {10, 30, 60, 120}) {
    for (int first = 0; first + count <= 300; first += 60) {
      EXPECT_FALSE(found_in(talking.slice(first, first + count)).is_of_other_face()) << first;
    }
  }
  // The last identity moves nothing by much.
  for (int i = 0; i < 9; ++i) {
    const auto file = folder / "identities" / ("identity00" + std::to_string(i) + ".obj");
    const Positions of_other =
        talking.rest() + 2 * (test::read_plain_obj(file).positions - talking.rest());
    const MeshSequence from_other(talking.shared_connectivity(), talking.positions(), {}, of_other);
    EXPECT_TRUE(found_in(from_other).is_of_other_face()) << file;
  }
  const auto facecap = data / "facecap";
  const MeshSequence take = test::captured_performance(facecap / "neutral.obj", facecap / "targets",
                                                       facecap / "weights.csv", 335);
  EXPECT_FALSE(found_in(take).is_of_other_face());
  for (int first = 0; first < 330; first += 30) {
    EXPECT_FALSE(found_in(take.slice(first, std::min(first + 30, 335))).is_of_other_face())
        << first;
  }
}

}  // namespace
}  // namespace mimetra
