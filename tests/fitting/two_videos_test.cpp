#include "tests/fitting/two_videos.h"

#include <iomanip>
#include <iostream>

#include <gtest/gtest.h>

#include "fitting/landmark_mapping.h"
#include "samples/head/head.h"
#include "tests/shared_data.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/decomposition.h"
#include "toolkit/transfer/blendshape_transfer.h"

/// The paper's case of two videos: fit both, transfer the source's expressions to the target's
/// face.
namespace mimetra {
namespace {

/// What was fitted to one video.
struct FittedPerson {
  BlendshapeModel person;
  MeshSequence performance;
};

FittedPerson fitted(const test::TwoVideos& videos, const Frames& points) {
  const std::vector<FrameFit> fits =
      LandmarkFitter(videos.model, videos.vertices).fit(points, {}, videos.times);
  Eigen::MatrixXd beta(points.rows(), videos.model.expressions().size());
  for (Eigen::Index f = 0; f < beta.rows(); ++f) {
    beta.row(f) = fits[static_cast<std::size_t>(f)].beta;
  }
  BlendshapeModel person = videos.model.person(fits.front().alpha);
  MeshSequence performance = person.animate(beta, videos.times);
  return {std::move(person), std::move(performance)};
}

/// The transferred sequence's distance from the truth for all triangles (K = 0) and for regions, in
/// shares of the face's longest side. Prints a table of them.
std::vector<test::SequenceDistance> transfer_errors(const test::TwoVideos& videos,
                                                    const std::vector<int>& counts) {
  const FittedPerson source = fitted(videos, videos.source);
  const FittedPerson target = fitted(videos, videos.target);
  const MeshSequence truth = videos.truth();
  const double unit = truth.diameter();
  std::cout << "K     share of triangles  face %  expression %  (motion "
            << 100 * motion(truth) / unit << " %)\n";
  std::vector<test::SequenceDistance> errors;
  for (const int count : counts) {
    const std::vector<int> triangles =
        count == 0 ? all_triangles(truth.triangles())
                   : find_regions(decompose(source.performance, {.count = count})).triangles;
    const BlendshapeTransfer transfer(source.person.neutral(), target.person, triangles);
    const MeshSequence result =
        target.person.animate(transfer.weights(source.performance), videos.times);
    test::SequenceDistance error = test::distance_between(result, truth);
    error.face /= unit;
    error.expression /= unit;
    errors.push_back(error);
    std::cout << std::left << std::setw(6) << (count == 0 ? "full" : std::to_string(count))
              << std::setw(20) << std::setprecision(3)
              << double(triangles.size()) / double(truth.triangles().rows()) << std::setw(8)
              << std::setprecision(3) << 100 * error.face << std::setw(14) << 100 * error.expression
              << '\n';
  }
  return errors;
}

/// A pixel on the face, as a share of its longest side.
constexpr double kPixel = 1 / test::kFacePixels;

/// `face`: what the errors of the whole face must stay below.
void expect_close(const std::vector<test::SequenceDistance>& errors, double face) {
  for (const test::SequenceDistance& error : errors) {
    // Every landmark is off by 1 px in each direction; expressions are solved frame by frame from
    // many landmarks, and move most vertices less than those.
    EXPECT_LT(error.expression, kPixel);
    EXPECT_LT(error.face, face);
    // Regions lose little against all triangles of the same fitted source.
    EXPECT_LT(error.expression, errors.front().expression + 0.25 * kPixel);
  }
}

#ifdef __SANITIZE_ADDRESS__
const std::vector<int> kCounts = {0, 10};  // sanitizers are slow; ./dev check runs all
#else
const std::vector<int> kCounts = {0, 10, 30, 40};
#endif

/// How far the model's mean is from the target's neutral: what is known without any landmark.
double distance_of_mean(const test::TwoVideos& videos) {
  const Positions neutral = videos.model.person(videos.target_alpha).neutral();
  const double distance =
      (neutral - videos.model.mean()).rowwise().norm().mean() / videos.truth().diameter();
  std::cout << "mean face " << 100 * distance << " %\n";
  return distance;
}

TEST(TwoVideos, GiveTheSourcesExpressionsOnTheTargetsFaceForTheBuiltInHead) {
  const WeightTrack track = samples::parametric_performance();
  const MorphableModel& head = test::built_in_head();
  const test::TwoVideos videos =
      test::two_videos(head, test::vertices_of_landmarks(), track.weights, track.times, 1);
  // Four identities are seen by 52 landmarks in 120 frames: half a pixel of each.
  expect_close(transfer_errors(videos, kCounts), 2 * kPixel);
}

TEST(TwoVideos, GiveTheSourcesExpressionsOnTheTargetsFaceForTheSurreyModel) {
  const auto folder = test::shared_path("data/sfm");
  const auto weights = test::shared_path("data/captures/six-expressions-25fps-100.csv");
  MIMETRA_SKIP_WITHOUT(folder);
  MIMETRA_SKIP_WITHOUT(weights);
  const MorphableModel model = read_model(folder);
  const WeightTrack track = read_weights(weights);
  const LandmarkMapping mapping = read_landmark_mapping(find_landmark_mapping(folder));
  std::vector<int> vertices;
  for (const auto& [name, vertex] : mapping) vertices.push_back(vertex);
  // Of two people with 63 identities each, one pair may be luckier than another.
  constexpr unsigned kPairs = 3;
  std::vector<test::SequenceDistance> errors(kCounts.size());
  double mean_face = 0;
  for (unsigned seed = 1; seed <= kPairs; ++seed) {
    const test::TwoVideos videos = test::two_videos(
        model, vertices, weights_for(track, model.expressions().names), track.times, seed);
    const auto of_pair = transfer_errors(videos, kCounts);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i].face += of_pair[i].face / kPairs;
      errors[i].expression += of_pair[i].expression / kPairs;
    }
    mean_face += distance_of_mean(videos) / kPairs;
  }
  // 50 landmarks do not see all that 63 identities do between them, and an affine camera takes a
  // part of it; what they see brings the face nearer than the mean.
  expect_close(errors, mean_face);
}

}  // namespace
}  // namespace mimetra
