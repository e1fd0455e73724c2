#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "fitting/fit_verdict.h"
#include "fitting/landmark_file.h"
#include "fitting/landmark_mapping.h"
#include "tests/fitting/two_videos.h"
#include "tests/shared_data.h"
#include "toolkit/formats/model_file.h"

/// What is made of landmarks that err in every frame in the same way, or wildly.
namespace mimetra {
namespace {

using Outliers = FitOptions::Outliers;

constexpr int kFrames = 60;

/// Pixels of noise in each direction.
struct Noise {
  double own = 1;
  double repeated = 0;
};

/// A person of the model who turns the head.
test::SyntheticClip clip_with(const MorphableModel& model, const std::vector<int>& vertices,
                              unsigned seed, const Noise& noise, int frames = kFrames) {
  std::mt19937 random(seed);
  test::SyntheticClip clip{model, vertices, {}, {}, {}, {}, {}};
  clip.alpha = test::normal_matrix(model.identities().size(), 1, random);
  clip.beta = test::random_weights(frames, model.expressions().size(), random);
  clip.times = Eigen::VectorXd::LinSpaced(frames, 0, (frames - 1) / 10.0);
  for (const double time : clip.times) {
    clip.cameras.push_back(test::turning_camera(time, 0, test::kFacePixels / extent(model.mean())));
  }
  test::see(clip, noise.own, random);
  const auto n = static_cast<Eigen::Index>(vertices.size());
  clip.points.rowwise() += test::as_row(noise.repeated * test::normal_matrix(n, 2, random));
  return clip;
}

test::SyntheticClip head_with(unsigned seed, const Noise& noise) {
  return clip_with(test::built_in_head(), test::vertices_of_landmarks(), seed, noise);
}

double neutral_error(const test::SyntheticClip& clip, const Eigen::VectorXd& alpha) {
  return (clip.model.person(alpha).neutral() - clip.model.person(clip.alpha).neutral())
      .rowwise()
      .norm()
      .mean();
}

TEST(ClipNoise, IsFoundInWhatTheFitLeaves) {
  for (unsigned seed = 0; seed < 2; ++seed) {
    const FrameFit independent = test::fit(head_with(seed, {1, 0}), {}).front();
    // 52 landmarks in 60 frames tell a standard deviation to a percent; few of the degrees of
    // freedom of cameras and expressions are counted wrongly.
    EXPECT_NEAR(independent.sigma, 1, 0.1);
    EXPECT_LT(independent.repeated, 0.05);
    const FrameFit half = test::fit(head_with(seed, {1, 1}), {}).front();
    // The repeated part is seen once by each landmark: 104 numbers less the unknowns.
    EXPECT_NEAR(half.sigma, std::sqrt(2), 0.25);
    EXPECT_NEAR(half.repeated, 0.5, 0.2);
  }
  // One that is given is not estimated.
  EXPECT_EQ(test::fit(head_with(1, {1, 0}), {.repeated = 0.3}).front().repeated, 0.3);
}

TEST(ClipNoise, OfOneLandmarkFarOffInEveryFrameDoesNotMoveTheIdentity) {
  const test::SyntheticClip clip = head_with(2, {1, 0});
  test::SyntheticClip wrong = clip;
  wrong.points.col(2 * 20).array() += 40;
  const double clean = (test::fit(clip, {}).front().alpha - clip.alpha).norm();
  const double resisted = (test::fit(wrong, {}).front().alpha - clip.alpha).norm();
  const double trusted =
      (test::fit(wrong, {.outliers = Outliers::trust}).front().alpha - clip.alpha).norm();
  std::cout << "alpha's error: " << clean << " without, " << resisted << " with, " << trusted
            << " where it is trusted\n";
  // One landmark of 52 less: what it said is missing, and no more.
  EXPECT_LT(resisted, 1.5 * clean);
  EXPECT_GT(trusted, 5 * clean);
}

TEST(ClipNoise, CostsLittleToResistOutliersWhereThereAreNone) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const test::SyntheticClip clip = head_with(seed, {1, 0});
    const double resisted = (test::fit(clip, {}).front().alpha - clip.alpha).norm();
    const double trusted =
        (test::fit(clip, {.outliers = Outliers::trust}).front().alpha - clip.alpha).norm();
    EXPECT_LT(resisted, 1.02 * trusted);
  }
}

TEST(ClipNoise, WeighsThePriorAsTheNeutralNeedsIt) {
  const auto folder = test::shared_path("data/sfm");
  MIMETRA_SKIP_WITHOUT(folder);
  const MorphableModel model = read_model(folder);
  std::vector<int> vertices;
  for (const auto& [name, vertex] : read_landmark_mapping(find_landmark_mapping(folder))) {
    vertices.push_back(vertex);
  }
  // Of one person the prior may be too strong or too weak; of several it is neither.
  constexpr unsigned kPeople = 8;
  constexpr int kFew = 20;
  double as_it_is = 0, weaker = 0, stronger = 0;
  for (unsigned seed = 0; seed < kPeople; ++seed) {
    const test::SyntheticClip clip = clip_with(model, vertices, seed, {1.5, 1.5}, kFew);
    // alpha in other units is a prior of another weight.
    const auto error = [&](double prior) {
      ShapeBasis identities = model.identities();
      identities.displacements /= std::sqrt(prior);
      const MorphableModel other(model.shared_connectivity(), model.mean(), identities,
                                 model.expressions());
      const Eigen::VectorXd alpha =
          LandmarkFitter(other, vertices).fit(clip.points, {}, clip.times).front().alpha;
      return neutral_error(clip, alpha / std::sqrt(prior));
    };
    as_it_is += error(1);
    weaker += error(0.1);
    stronger += error(10);
  }
  const double unit = extent(model.mean()) * kPeople / 100;
  std::cout << "the neutral's error in % of the longest side: " << as_it_is / unit << ", "
            << weaker / unit << " with a tenth of the prior, " << stronger / unit
            << " with ten times it\n";
  EXPECT_LT(as_it_is, weaker);
  EXPECT_LT(as_it_is, stronger);
}

/// Real footage: two halves of a clip give one person, who is not the mean.
TEST(ClipNoise, GivesOneFaceFromBothHalvesOfRealFootage) {
  const auto folder = test::shared_path("data/sfm");
  const auto footage = test::shared_path("data/footage/talking-head-1080p-300.csv");
  MIMETRA_SKIP_WITHOUT(folder);
  MIMETRA_SKIP_WITHOUT(footage);
  const MorphableModel model = read_model(folder);
  const LandmarkTrack track = read_landmarks(footage);
  const MappedLandmarks mapped =
      map_landmarks(track, read_landmark_mapping(find_landmark_mapping(folder)));
  const LandmarkFitter fitter(model, mapped.vertices, LandmarkFitter::Outline::given);
  std::vector<Positions> neutrals;
  for (const int from : {0, 150}) {
    const auto rows = Eigen::seqN(from, 150);
    const auto fits = fitter.fit(mapped.points(rows, Eigen::all), {}, track.times(rows),
                                 mapped.outline(rows, Eigen::all));
    const Eigen::VectorXd& alpha = fits.front().alpha;
    EXPECT_LT(std::sqrt(alpha.squaredNorm() / double(alpha.size())), 1.1);
    EXPECT_LT(alpha.cwiseAbs().maxCoeff(), 3);
    EXPECT_EQ(verdict_of(model, alpha).flipped, 0);
    neutrals.push_back(model.person(alpha).neutral());
    EXPECT_GT((neutrals.back() - model.mean()).rowwise().norm().mean(),
              0.015 * extent(model.mean()));
    double squares = 0;
    for (std::size_t f = 0; f < fits.size(); ++f) {
      const Eigen::RowVectorXd row = mapped.points.row(from + static_cast<Eigen::Index>(f));
      const double ratio =
          fits[f].rms / rms_radius(row.reshaped<Eigen::RowMajor>(row.size() / 2, 2));
      squares += ratio * ratio / double(fits.size());
    }
    EXPECT_LT(std::sqrt(squares), 0.06);
  }
  const Eigen::VectorXd distance = (neutrals[0] - neutrals[1]).rowwise().norm();
  EXPECT_LT(distance.mean(), 0.005 * extent(model.mean()));
  EXPECT_LT(distance.maxCoeff(), 0.016 * extent(model.mean()));
}

}  // namespace
}  // namespace mimetra
