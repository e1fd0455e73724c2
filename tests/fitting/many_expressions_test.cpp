#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "fitting/landmark_file.h"
#include "fitting/landmark_mapping.h"
#include "tests/fitting/two_videos.h"
#include "tests/shared_data.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/weight_file.h"

/// Real models have fifty expressions and more, which landmarks alone do not tell apart.
namespace mimetra {
namespace {

constexpr int kUpperLip = 62, kLowerLip = 66, kLeftEye = 36, kRightEye = 45;
constexpr int kNoseTop = 27, kNoseBase = 33;

class ManyExpressions : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::shared_path("data/ict-face");
    MIMETRA_SKIP_WITHOUT(folder);
    model_ = read_model(folder);
    mapping_ = read_landmark_mapping(find_landmark_mapping(folder));
    ASSERT_EQ(mapping_.size(), 68u);
    for (const auto& [name, vertex] : mapping_) vertices_.push_back(vertex);
  }

  double lip_gap(const Positions& pose) const {
    return (pose.row(vertices_[kUpperLip]) - pose.row(vertices_[kLowerLip])).norm();
  }

  Positions pose(const FrameFit& fit) const { return model_.person(fit.alpha).pose(fit.beta); }

  MorphableModel model_;
  LandmarkMapping mapping_;
  std::vector<int> vertices_;
};

double correlation(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd x = a - a.mean(), y = b - b.mean();
  return (x * y).sum() / std::sqrt(x.square().sum() * y.square().sum());
}

/// A person who talks, seen with noise of 3 % of the distance between the eyes' outer corners, half
/// of which repeats, and the rest of which changes slowly, as detectors' does.
TEST_F(ManyExpressions, AreNearerToAKnownFaceThanOneThatIsStill) {
  const auto capture = test::shared_path("data/captures/talking-60fps-1200.csv");
  MIMETRA_SKIP_WITHOUT(capture);
  constexpr int kFrames = 100, kStep = 3;
  std::mt19937 random(1);
  test::SyntheticClip clip{model_, vertices_, {}, {}, {}, {}, {}};
  const Eigen::MatrixXd weights = weights_for(read_weights(capture), model_.expressions().names);
  clip.beta = weights(Eigen::seqN(0, kFrames, kStep), Eigen::all);
  clip.alpha = test::normal_matrix(model_.identities().size(), 1, random);
  clip.times = Eigen::VectorXd::LinSpaced(kFrames, 0, (kFrames - 1) / 20.0);
  for (const double time : clip.times) {
    clip.cameras.push_back(
        test::turning_camera(time, 0, test::kFacePixels / extent(model_.mean())));
  }
  test::see(clip, 0, random);
  const auto landmarks = static_cast<Eigen::Index>(vertices_.size());
  const auto of_eye = [&](int eye) { return clip.points.row(0).segment<2>(2 * eye); };
  const double sigma = 0.03 * (of_eye(kLeftEye) - of_eye(kRightEye)).norm();
  constexpr double kSlow = 0.8;
  const Eigen::RowVectorXd repeated = test::normal_matrix(1, 2 * landmarks, random);
  Eigen::RowVectorXd own = test::normal_matrix(1, 2 * landmarks, random);
  for (auto row : clip.points.rowwise()) {
    row += sigma * std::sqrt(0.5) * (repeated + own);
    own =
        kSlow * own + std::sqrt(1 - kSlow * kSlow) * test::normal_matrix(1, 2 * landmarks, random);
  }

  const std::vector<FrameFit> fits = test::fit(clip, {});
  const BlendshapeModel person = model_.person(clip.alpha);
  double squares = 0, still = 0;
  Eigen::ArrayXd gaps(kFrames), true_gaps(kFrames);
  for (int f = 0; f < kFrames; ++f) {
    const Positions truth = person.pose(clip.beta.row(f)), found = pose(fits[std::size_t(f)]);
    squares += (found - truth).squaredNorm();
    still += (model_.mean() - truth).squaredNorm();
    gaps[f] = lip_gap(found);
    true_gaps[f] = lip_gap(truth);
  }
  std::cout << "error " << std::sqrt(squares / still) << " of the mean face's, lips follow with a "
            << "correlation of " << correlation(gaps, true_gaps) << '\n';
  EXPECT_LT(squares, 0.64 * still);
  EXPECT_GT(correlation(gaps, true_gaps), 0.85);
}

/// Real footage: the mouth moves as the landmarks do, and nothing leaps.
TEST_F(ManyExpressions, FollowRealFootage) {
  const auto footage = test::shared_path("data/footage/talking-head-1080p-300.csv");
  MIMETRA_SKIP_WITHOUT(footage);
  const LandmarkTrack track = read_landmarks(footage);
  const MappedLandmarks mapped = map_landmarks(track, mapping_);
  const std::vector<FrameFit> fits =
      LandmarkFitter(model_, mapped.vertices).fit(mapped.points, {}, track.times);
  const auto jaw =
      std::ranges::find(model_.expressions().names, "jawOpen") - model_.expressions().names.begin();
  Eigen::ArrayXd gaps(track.frames()), seen(track.frames());
  double largest_step = 0, widest = 0;
  Positions before = pose(fits.front());
  for (int f = 0; f < track.frames(); ++f) {
    const Positions now = pose(fits[std::size_t(f)]);
    largest_step = std::max(largest_step, (now - before).rowwise().norm().maxCoeff());
    widest = std::max(widest, fits[std::size_t(f)].beta[jaw]);
    gaps[f] = lip_gap(now) / (now.row(vertices_[kNoseTop]) - now.row(vertices_[kNoseBase])).norm();
    const auto image = track.points.row(f).reshaped<Eigen::RowMajor>(68, 2);
    seen[f] = (image.row(kUpperLip) - image.row(kLowerLip)).norm() /
              (image.row(kNoseTop) - image.row(kNoseBase)).norm();
    before = now;
  }
  const double step = largest_step / extent(model_.mean());
  std::cout << "lips follow with a correlation of " << correlation(gaps, seen)
            << ", the largest step is " << 100 * step << " % of the face, the jaw opens to "
            << widest << '\n';
  EXPECT_GT(correlation(gaps, seen), 0.9);
  EXPECT_LT(step, 0.1);
  EXPECT_LT(widest, 0.9);
}

}  // namespace
}  // namespace mimetra
