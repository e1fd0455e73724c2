#include "toolkit/report/viewer_data.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

/// A grid of 150 x 150 far from the origin that moves by mixtures of three waves along z.
MeshSequence mixture(int frames, double height = 10) {
  const test::Shape shape = test::grid(150, 150);
  const Positions rest = shape.positions.rowwise() + Eigen::RowVector3d(1000, -50, 7);
  Frames positions(frames, rest.size());
  for (int f = 0; f < frames; ++f) {
    Positions pose = rest;
    for (int v = 0; v < pose.rows(); ++v) {
      pose(v, 2) += height * (std::sin(0.07 * v + 0.3 * f) + 0.2 * std::sin(0.01 * v) * f / frames);
    }
    positions.row(f) = pose.reshaped<Eigen::RowMajor>();
  }
  return MeshSequence(Connectivity::from_triangles(static_cast<int>(rest.rows()), shape.triangles),
                      std::move(positions), {}, rest);
}

std::vector<int> all_frames(const MeshSequence& sequence) {
  std::vector<int> frames(static_cast<std::size_t>(sequence.frames()));
  std::iota(frames.begin(), frames.end(), 0);
  return frames;
}

/// Frame f as the header says it is read (1 x 3N).
Eigen::RowVectorXd shown(const MixedPoses& mixed, Eigen::Index f) {
  Eigen::RowVectorXd steps = mixed.rest.cast<double>() / MixedPoses::kStepsOfRest;
  for (Eigen::Index k = 0; k < mixed.basis.rows(); ++k) {
    steps += mixed.basis_step / MixedPoses::kWeightOfOne * mixed.weights(f, k) *
             mixed.basis.row(k).cast<double>();
  }
  for (const MixedPoses::Correction& correction : mixed.corrections) {
    if (correction.frame == f) steps[correction.coordinate] += correction.steps;
  }
  Eigen::RowVectorXd positions = mixed.step * steps;
  for (Eigen::Index i = 0; i < positions.size(); ++i) positions[i] += mixed.center[i % 3];
  return positions;
}

double largest_error(const MixedPoses& mixed, const MeshSequence& sequence) {
  double largest = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    const Positions pose = sequence.frame(f);
    const Eigen::RowVectorXd missed =
        pose.reshaped<Eigen::RowMajor>().transpose() - shown(mixed, f);
    largest = std::max(largest, missed.cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(MixedPoses, OfAMixtureOfThreeAreThreeForAnyNumberOfThreads) {
  const MeshSequence sequence = mixture(30);
  const auto poses = mixed(sequence, all_frames(sequence), 100, Context().with_threads(2));
  ASSERT_TRUE(poses);
  EXPECT_EQ(poses->basis.rows(), 3);
  EXPECT_TRUE(poses->corrections.empty());
  // A fourth of a step by the basis, an eighth by rounding, root mean square.
  EXPECT_LE(largest_error(*poses, sequence), poses->step);
  const auto one = mixed(sequence, all_frames(sequence), 100, Context().with_threads(1));
  ASSERT_TRUE(one);
  EXPECT_EQ(one->basis, poses->basis);
  EXPECT_EQ(one->weights, poses->weights);
  EXPECT_FALSE(mixed(sequence, all_frames(sequence), 2, Context().with_threads(1)))
      << "more than allowed";
}

TEST(MixedPoses, ShowWhereOneVertexLeapsInOneFrame) {
  const MeshSequence smooth = mixture(30);
  Frames frames = smooth.positions();
  frames(17, 3 * 4000 + 1) += 5;
  const MeshSequence sequence = smooth.with_frames(frames);
  const auto poses = mixed(sequence, all_frames(sequence), 100, Context().with_threads(1));
  ASSERT_TRUE(poses);
  ASSERT_FALSE(poses->corrections.empty());
  EXPECT_LE(largest_error(*poses, sequence), poses->step * (1 + 1e-9));
}

TEST(MixedPoses, AreThoseOfTheFramesThatAreAskedFor) {
  const MeshSequence sequence = mixture(30);
  const auto poses = mixed(sequence, {29, 0, 7, 8, 9, 10, 11}, 100, Context().with_threads(1));
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->weights.rows(), 7);
  const Positions last = sequence.frame(29);
  const Eigen::RowVectorXd missed = last.reshaped<Eigen::RowMajor>().transpose() - shown(*poses, 0);
  EXPECT_LE(missed.cwiseAbs().maxCoeff(), poses->step);
}

TEST(MixedPoses, OfAStillFaceAreItsRest) {
  const MeshSequence sequence = mixture(6, 0);
  const auto poses = mixed(sequence, all_frames(sequence), 100, Context().with_threads(1));
  ASSERT_TRUE(poses);
  EXPECT_LE(largest_error(*poses, sequence), poses->step / 8);
}

TEST(MixedPoses, AreNoneOfNoise) {
  const MeshSequence smooth = mixture(8);
  Frames frames = smooth.positions();
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.1);  // five steps
  for (double& number : frames.reshaped()) number += noise(random);
  const MeshSequence sequence = smooth.with_frames(frames);
  EXPECT_FALSE(mixed(sequence, all_frames(sequence), 100, Context().with_threads(1)));
}

}  // namespace
}  // namespace mimetra
