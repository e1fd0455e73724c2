#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

/// Three frames, the second of which was not seen; numbers that need all their digits.
FittedCoefficients some_fit() {
  FittedCoefficients fit;
  fit.identities = {"wide", "long \"face\""};
  fit.expressions = {"smile"};
  fit.times = Eigen::Vector3d(0, 1.0 / 30, 0.1);
  fit.alpha = Eigen::Vector2d(1.0 / 3, -std::sqrt(2.0)).transpose().replicate(3, 1);
  fit.beta = Eigen::Vector3d(0, 1, 2.0 / 3);
  for (int f = 0; f < 3; ++f) {
    fit.cameras.emplace_back(Eigen::Matrix<double, 2, 4>::Constant(std::sqrt(f + 2.0)));
  }
  fit.rms = Eigen::Vector3d(0.1, std::numeric_limits<double>::quiet_NaN(), 1e-17);
  fit.landmarks = Eigen::Vector3i(50, 0, 49);
  fit.iterations = Eigen::Vector3i(2, 0, 5);
  return fit;
}

class FitFile : public testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) const {
    write_bytes(folder_ / "a.fit.json", text);
    return folder_ / "a.fit.json";
  }

  /// A quad with the identities and the expression of some_fit().
  std::filesystem::path model() const {
    const test::Shape shape = test::grid(2, 2);
    Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(12, 2);
    shapes(3, 0) = 0.5;
    shapes(7, 1) = 0.25;
    const MorphableModel quad(
        std::make_shared<Connectivity>(Connectivity::from_triangles(4, shape.triangles)),
        shape.positions, {{"wide", "long"}, shapes}, {{"smile"}, Eigen::MatrixXd::Ones(12, 1)});
    write_model(folder_ / "quad", quad, {}, {.overwrite = true});
    return folder_ / "quad";
  }

  FittedCoefficients fit_of_model() const {
    FittedCoefficients fit = some_fit();
    fit.identities = {"long", "wide"};  // another order than the model's
    return fit;
  }

  test::TemporaryFolder folder_;
};

TEST_F(FitFile, IsTheSameWhenReadAgain) {
  const FittedCoefficients fit = some_fit(), read = read_fit(written(fit_json(fit)));
  EXPECT_EQ(read.identities, fit.identities);
  EXPECT_EQ(read.expressions, fit.expressions);
  EXPECT_EQ(read.times, fit.times);
  EXPECT_EQ(read.alpha, fit.alpha);
  EXPECT_EQ(read.beta, fit.beta);
  EXPECT_EQ(read.cameras, fit.cameras);
  EXPECT_EQ(read.rms[0], fit.rms[0]);
  EXPECT_TRUE(std::isnan(read.rms[1]));
  EXPECT_EQ(read.landmarks, fit.landmarks);
  EXPECT_EQ(read.iterations, fit.iterations);
  EXPECT_EQ(fit_json(read), fit_json(fit));
}

TEST_F(FitFile, CutAnywhereIsAnError) {
  const std::string text = fit_json(some_fit());
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    EXPECT_THROW(read_fit(written(text.substr(0, length))), IoError) << length;
  }
}

TEST_F(FitFile, NamesTheElementThatIsWrong) {
  const auto message = [this](const std::string& from, const std::string& to) {
    std::string text = fit_json(some_fit());
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return test::message_of<IoError>([&] { read_fit(written(text.replace(at, from.size(), to))); });
  };
  EXPECT_THAT(message("\"wide\",", "\"wide\", \"more\","),
              HasSubstr("a.fit.json: /frames/0/alpha: expected 3 numbers, found 2"));
  EXPECT_THAT(message("\"wide\"", "\"long \\\"face\\\"\""), HasSubstr("/identities"));
  EXPECT_THAT(message("\"landmarks\": 50", "\"landmarks\": -1"), HasSubstr("/frames/0/landmarks"));
  EXPECT_THAT(message("\"time\": 0.1", "\"time\": 0.0"), HasSubstr("/frames/2/time"));
  EXPECT_THAT(message("\"rms_px\": 0.1", "\"rms\": 0.1"),
              HasSubstr("/frames/0/rms_px: is missing"));
  EXPECT_THAT(message("\"frames\"", "\"frame\""), HasSubstr("/frames: expected a list of frames"));
}

TEST(FittedCoefficients, HaveTheMeanIdentityOfTheFramesThatWereSeen) {
  FittedCoefficients fit = some_fit();
  EXPECT_EQ(fit.identity(), fit.alpha.row(0).transpose());
  fit.alpha.row(1) << 1000, 1000;
  fit.alpha.row(2) << 3, 4;
  const Eigen::VectorXd mean = (fit.alpha.row(0) + fit.alpha.row(2)) / 2;
  EXPECT_EQ(fit.identity(), mean);
}

TEST_F(FitFile, GivesAModelItsIdentityByName) {
  const FittedCoefficients fit = fit_of_model();
  const std::string text = model().string() + "@" + written(fit_json(fit)).string();
  const BlendshapeModel person = read_blendshapes(text);
  const Positions mean = read_model(model()).mean();
  // The model's files hold absolute shapes in double precision: a rounding each.
  EXPECT_NEAR(person.neutral()(1, 0) - mean(1, 0), 0.5 * fit.alpha(0, 1), 1e-15);
  EXPECT_NEAR(person.neutral()(2, 1) - mean(2, 1), 0.25 * fit.alpha(0, 0), 1e-15);
}

TEST_F(FitFile, DrivesAModelAsASequence) {
  const FittedCoefficients fit = fit_of_model();
  const std::string text = model().string() + "@" + written(fit_json(fit)).string();
  const SequenceRead read = read_sequence(text, {.frames = "1:"});
  EXPECT_TRUE(read.model_driven);
  EXPECT_EQ(read.files.back(), folder_ / "a.fit.json");
  ASSERT_EQ(read.sequence.frames(), 2);
  EXPECT_EQ(read.sequence.times(), fit.times.tail(2));
  const BlendshapeModel person = read_blendshapes(text);
  EXPECT_EQ(read.sequence.rest(), person.neutral());
  EXPECT_EQ(Positions(read.sequence.frame(1)), person.pose(fit.beta.row(2)));
}

TEST_F(FitFile, OfAnotherModelIsRefused) {
  const std::string text = model().string() + "@" + written(fit_json(some_fit())).string();
  EXPECT_THAT(test::message_of<MismatchError>([&] { read_blendshapes(text); }),
              HasSubstr("it was fitted with another model"));
}

TEST_F(FitFile, IsNamedWithItsFoldersBehindTheModel) {
  std::filesystem::create_directories(folder_ / "a@b/c@d");
  const std::string quad = model().string(), fit = (folder_ / "a@b/c@d/t.fit.json").string();
  const ModelSpec spec = ModelSpec::parse(quad + "@" + fit);
  EXPECT_EQ(spec.path, quad);
  EXPECT_EQ(spec.fit, std::filesystem::path(fit));
  EXPECT_EQ(spec.name(), "quad@t");
}

}  // namespace
}  // namespace mimetra
