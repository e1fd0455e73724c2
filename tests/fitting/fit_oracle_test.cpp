#include <cmath>
#include <fstream>
#include <optional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fitting/landmark_file.h"
#include "fitting/landmark_fitter.h"
#include "fitting/landmark_mapping.h"
#include "tests/shared_data.h"
#include "toolkit/formats/model_file.h"

/// The paper's alternation on a photograph against another program's.
namespace mimetra::test {
namespace {

class FitOracle : public testing::Test {
 protected:
  void SetUp() override {
    MIMETRA_SKIP_WITHOUT(shared_path("oracle/fitting/image_0010.json"));
    MIMETRA_SKIP_WITHOUT(shared_path("data/sfm"));
    std::ifstream(shared_path("oracle/fitting/image_0010.json")) >> oracle_;
    vertices_ = oracle_["vertex_ids"].get<std::vector<int>>();
    const auto& image = oracle_["image_points_y_down_0_based"];
    points_.resize(1, 2 * static_cast<Eigen::Index>(image.size()));
    for (std::size_t i = 0; i < image.size(); ++i) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        points_(0, static_cast<Eigen::Index>(2 * i + axis)) = image[i][axis];
      }
    }
  }

  static const MorphableModel& surrey_model() {
    static const MorphableModel model = read_model(shared_path("data/sfm"));
    return model;
  }

  static Eigen::VectorXd vector(const nlohmann::json& list) {
    const auto values = list.get<std::vector<double>>();
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  }

  /// Compares with every iteration of the oracle that is asked for: 1, 5 and 20.
  void compare(const char* bounds, std::optional<double> max_expression) {
    const LandmarkFitter fitter(surrey_model(), vertices_);
    int compared = 0;
    for (const auto& expected : oracle_[bounds]) {
      const int iterations = expected["it"];
      if (iterations != 1 && iterations != 5 && iterations != 20) continue;
      ++compared;
      const FrameFit fit = fitter
                               .fit(points_, {.solver = FitOptions::Solver::alternating,
                                              .iterations = iterations,
                                              .tolerance = 0,
                                              .sigma = std::sqrt(3.0),
                                              .max_expression = max_expression})
                               .front();
      EXPECT_LT((fit.alpha - vector(expected["alpha"])).lpNorm<Eigen::Infinity>(), 1e-6);
      EXPECT_LT((fit.beta - vector(expected["beta"])).lpNorm<Eigen::Infinity>(), 1e-6);
      for (int row = 0; row < 2; ++row) {
        EXPECT_LT((fit.camera.row(row).transpose() - vector(expected["C"][row]))
                      .lpNorm<Eigen::Infinity>(),
                  1e-6);
      }
      EXPECT_NEAR(fit.rms, expected["rms_px"].get<double>(), 1e-6);
      // The reference counts |r|^2 / sigma^2 + 2 |alpha|^2.
      EXPECT_NEAR(2 * fit.energies.back(), expected["energy"].get<double>(), 1e-5);
    }
    EXPECT_EQ(compared, 3);
  }

  nlohmann::json oracle_;
  std::vector<int> vertices_;
  Frames points_;
};

TEST_F(FitOracle, AgreesWithNonNegativeExpressionsAndThoseInTheBox) {
  compare("nonnegative_beta", std::nullopt);
  compare("box_beta", 1);
}

TEST_F(FitOracle, ReadsTheSameLandmarksFromTheFiles) {
  const auto folder = shared_path("data/sfm");
  const LandmarkMapping mapping = read_landmark_mapping(find_landmark_mapping(folder));
  const MappedLandmarks mapped = map_landmarks(read_landmarks(folder / "image_0010.pts"), mapping);
  EXPECT_EQ(mapped.vertices, vertices_);
  // The reference's went through single precision: 2^-24 of some 800 px.
  EXPECT_LT((mapped.points - points_).lpNorm<Eigen::Infinity>(), 1e-4);
}

TEST_F(FitOracle, IsWhatTheDefaultNoiseGives) {
  const LandmarkFitter fitter(surrey_model(), vertices_);
  // 0.017485 was rounded from sqrt(3) px on this image.
  EXPECT_NEAR(fitter.fit(points_).front().sigma, std::sqrt(3.0), 1e-4);
}

}  // namespace
}  // namespace mimetra::test
