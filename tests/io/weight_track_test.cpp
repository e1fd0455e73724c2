#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Weights : public testing::Test {
 protected:
  WeightTrack read(const std::string& content) {
    std::ofstream(folder_ / "w.csv", std::ios::binary) << content;
    return read_weights(folder_ / "w.csv");
  }
  std::string message_of(const std::string& content) {
    try {
      read(content);
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(Weights, HaveNamesTimesAndValues) {
  const WeightTrack track = read("time,smile,blink\n0,0.25,0\n0.04,0.5,1\n");
  EXPECT_THAT(track.names, ElementsAre("smile", "blink"));
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.04));
  EXPECT_EQ(track.weights(1, 0), 0.5);
  EXPECT_EQ(track.weights(1, 1), 1);
}

TEST_F(Weights, MayHaveAByteOrderMarkCarriageReturnsAndLiveLinkColumns) {
  const WeightTrack track =
      read("\xEF\xBB\xBFTimecode,BlendShapeCount,JawOpen\r\n10:00:00:01,61,0.5\r\n\r\n");
  EXPECT_THAT(track.names, ElementsAre("JawOpen"));
  EXPECT_EQ(track.weights(0, 0), 0.5);
  EXPECT_EQ(track.times.size(), 0);
}

TEST_F(Weights, ErrorsNameLineColumnAndWhatWasFound) {
  EXPECT_THAT(message_of("a,b\n0,0\n0,x\n"),
              HasSubstr("line 3: column 'b': expected a finite number, found 'x'"));
  EXPECT_THAT(message_of("a,b\n0,nan\n"), HasSubstr("found 'nan'"));
  EXPECT_THAT(message_of("a,b\n0\n"), HasSubstr("line 2: 1 field, expected 2"));
  EXPECT_THAT(message_of("a,b\n0,5,1\n"), HasSubstr("decimal commas"));
  EXPECT_THAT(message_of("a;b\n0;1\n"), HasSubstr("separated by ';', expected ','"));
  EXPECT_THAT(message_of("a,a\n0,0\n"), HasSubstr("the name 'a' occurs twice"));
  EXPECT_THAT(message_of("time,Time,a\n"), HasSubstr("the name 'time' occurs twice"));
  EXPECT_THAT(message_of("a,\n0,0\n"), HasSubstr("column 2 has no name"));
  EXPECT_THAT(message_of("time\n0\n"), HasSubstr("no column of weights"));
  EXPECT_THAT(message_of("time,a\n1,0\n1,0\n"), HasSubstr("line 3: times do not ascend"));
  EXPECT_THAT(message_of(""), HasSubstr("is empty"));
  EXPECT_THAT(message_of("a,b\n"), HasSubstr("no row"));
}

TEST_F(Weights, ComeBackEqualAfterWriting) {
  const WeightTrack track{{"smile, left", "a \"grin\""},
                          Eigen::MatrixXd::Random(7, 2),
                          Eigen::VectorXd::LinSpaced(7, 0, 0.2)};
  write_weights(folder_ / "t.csv", track, false);
  const WeightTrack found = read_weights(folder_ / "t.csv");
  EXPECT_EQ(found.names, track.names);
  EXPECT_EQ(found.weights, track.weights);
  EXPECT_EQ(found.times, track.times);
}

TEST_F(Weights, AreNotWrittenWhereNamesAndColumnsDiffer) {
  const WeightTrack columns{{"a"}, Eigen::MatrixXd::Zero(2, 2), {}};
  EXPECT_THROW(write_weights(folder_ / "t.csv", columns, false), std::invalid_argument);
  const WeightTrack times{{"a"}, Eigen::MatrixXd::Zero(2, 1), Eigen::VectorXd::Zero(3)};
  EXPECT_THROW(write_weights(folder_ / "t.csv", times, false), std::invalid_argument);
}

TEST(WeightMatch, PrefersTheExactNameOverItsOtherSpellings) {
  const WeightTrack track{
      {"browInnerUp", "browInnerUpLeft", "browInnerUp_L"}, Eigen::MatrixXd::Zero(1, 3), {}};
  EXPECT_THAT(match_weights(track, {"browInnerUp_L", "browInnerUp_R"}).column, ElementsAre(2, 0));
}

TEST(WeightMatch, IsExactThenBySideThenForBothHalves) {
  const WeightTrack track{{"jawOpen", "mouthSmileLeft", "mouthSmile_R", "browInnerUp", "tongueOut"},
                          Eigen::MatrixXd::Zero(1, 5),
                          {}};
  const WeightMatch match = match_weights(track, {"jawOpen", "mouthSmile_L", "mouthSmile_R",
                                                  "browInnerUp_L", "browInnerUp_R", "sneer"});
  EXPECT_THAT(match.column, ElementsAre(0, 1, 2, 3, 3, -1));
  EXPECT_THAT(match.unmatched_columns, ElementsAre("tongueOut"));
  EXPECT_THAT(match.undriven_expressions, ElementsAre("sneer"));
}

TEST(WeightMatch, IgnoresCaseAndUnderscoresWhereNothingIsExact) {
  const WeightTrack track{{"JawOpen", "MouthSmileLeft"}, Eigen::MatrixXd::Zero(1, 2), {}};
  EXPECT_THAT(match_weights(track, {"jawOpen", "mouthSmile_L"}).column, ElementsAre(0, 1));
}

TEST(WeightMatch, OfNoKnownNameIsAMismatch) {
  const WeightTrack track{{"smile"}, Eigen::MatrixXd::Zero(1, 1), {}};
  EXPECT_THROW(weights_for(track, {"jawOpen"}), MismatchError);
}

TEST(WeightsOfTheCapture, DriveEveryExpressionOfTheIctFace) {
  const auto path = test::shared_path("data/captures/talking-60fps-1200.csv");
  MIMETRA_SKIP_WITHOUT(path);
  const WeightTrack track = read_weights(path);
  EXPECT_EQ(track.weights.rows(), 1200);
  EXPECT_EQ(track.names.size(), 51u);
  const WeightMatch match = match_weights(track, {"browInnerUp_L", "cheekPuff_R", "eyeBlink_L"});
  EXPECT_TRUE(match.undriven_expressions.empty());
}

}  // namespace
}  // namespace mimetra
