#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/weight_file.h"
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
    return test::message_of<IoError>([&] { read(content); });
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

/// Rows with these timecodes.
std::string coded(const std::vector<std::string>& codes) {
  std::string text = "Timecode,BlendShapeCount,EyeBlinkLeft,HeadYaw\n";
  for (const std::string& code : codes) text += code + ",61,0.5,0.25\n";
  return text;
}

/// `count` timecodes from a second of the day on, `step` frames apart, at `rate` frames a second.
std::vector<std::string> codes_from(int second, int count, double rate, double step,
                                    double first = 0) {
  std::vector<std::string> codes;
  for (int i = 0; i < count; ++i) {
    const double frames = first + step * i;
    const int passed = static_cast<int>(frames / rate), at = (second + passed) % 86400;
    char text[40];
    std::snprintf(text, sizeof text, "%02d:%02d:%02d:%06.3f", at / 3600, at / 60 % 60, at % 60,
                  frames - passed * rate);
    codes.push_back(text);
  }
  return codes;
}

TEST_F(Weights, OfLiveLinkHaveTheTimesOfTheirTimecodes) {
  // 51 s of 60 frames, with the fraction of a frame at which the capture began.
  const WeightTrack track = read(coded(codes_from(3600 * 10, 3061, 60, 1, 27.679)));
  ASSERT_EQ(track.times.size(), 3061);
  EXPECT_EQ(track.times[0], 0);
  // Fractions have three digits.
  EXPECT_NEAR(track.times[3060], 51, 1e-4);
  EXPECT_NEAR(track.times[1], 1.0 / 60, 1e-4);
  EXPECT_THAT(track.names, ElementsAre("EyeBlinkLeft", "HeadYaw"));
  EXPECT_TRUE(track.notes.empty());
}

TEST_F(Weights, FindTheRateOfTheirTimecodes) {
  for (const double rate : {24.0, 25.0, 30.0, 50.0, 60.0, 120.0}) {
    for (const double step : {0.5, 1.0, 2.0}) {
      const WeightTrack track = read(coded(codes_from(17, 300, rate, step)));
      ASSERT_EQ(track.times.size(), 300) << rate;
      EXPECT_NEAR(track.times[299], 299 * step / rate, 1e-4) << rate << ", steps of " << step;
    }
  }
}

TEST_F(Weights, WithFramesLostKeepTheirTimes) {
  std::vector<std::string> codes = codes_from(100, 600, 30, 1);
  for (int lost = 0; lost < 40; ++lost) codes.erase(codes.begin() + 13 * lost + 5);
  const WeightTrack track = read(coded(codes));
  ASSERT_EQ(track.times.size(), 560);
  EXPECT_NEAR(track.times[559], 599 / 30.0, 1e-9);
}

TEST_F(Weights, MayPassMidnight) {
  const WeightTrack track = read(coded(codes_from(86398, 300, 60, 1)));
  EXPECT_NEAR(track.times[299], 299 / 60.0, 1e-4);
}

TEST_F(Weights, WithinOneSecondSayThatNothingTellsTheirRate) {
  const WeightTrack track = read(coded({"10:00:00:01", "10:00:00:02", "10:00:00:03"}));
  EXPECT_EQ(track.times.size(), 0);
  EXPECT_THAT(track.notes, ElementsAre(HasSubstr("give it by option 'fps'")));
}

TEST_F(Weights, WithTimecodesThatRepeatOrFallBackNameTheLine) {
  EXPECT_THAT(message_of(coded({"10:00:00:01", "10:00:00:02", "10:00:00:02"})),
              HasSubstr("line 4: the timecode 10:00:00:02 is not later than the one before"));
  EXPECT_THAT(message_of(coded({"10:00:01:01", "10:00:00:02"})), HasSubstr("line 3"));
  for (const char* code :
       {"10:00:00", "25:00:00:01", "a", "", "10:61:00:01", "10:00:00:01x", "10:00:00;01"}) {
    EXPECT_THAT(message_of(coded({code})), HasSubstr("line 2: expected a timecode HH:MM:SS:FF"));
  }
}

TEST_F(Weights, DoNotUseATimestampAndSaySo) {
  const WeightTrack stamped = read("Timestamp,smile\n1234,0.25\n1238,1\n");
  EXPECT_THAT(stamped.names, ElementsAre("smile"));
  EXPECT_EQ(stamped.times.size(), 0);
  EXPECT_THAT(stamped.notes, ElementsAre(HasSubstr("'Timestamp' is not used")));
}

class WeightsJson : public Weights {
 protected:
  WeightTrack read(const std::string& content) {
    std::ofstream(folder_ / "w.json", std::ios::binary) << content;
    return read_weights(folder_ / "w.json");
  }
  std::string message_of(const std::string& content) {
    return test::message_of<IoError>([&] { read(content); });
  }
};

TEST_F(WeightsJson, OfEveryShapeAreTheSame) {
  for (
      const char* text :
      {R"({"rows": [{"time": 0, "smile": 0.25, "blink": 0}, {"time": 0.5, "blink": 1, "smile": 1}]})",
       R"([{"time": 0, "smile": 0.25, "blink": 0}, {"time": 0.5, "smile": 1, "blink": 1}])",
       R"({"fps": 2, "rows": [{"smile": 0.25, "blink": 0}, {"smile": 1, "blink": 1}]})",
       R"([{"time": 0, "weights": {"smile": 0.25, "blink": 0}},
            {"time": 0.5, "weights": {"smile": 1, "blink": 1}}])",
       R"({"names": ["smile", "blink"], "weights": [[0.25, 0], [1, 1]], "times": [0, 0.5]})",
       R"({"names": ["smile", "blink"], "weights": [[0.25, 0], [1, 1]], "fps": 2})",
       R"({"exportFps": 2, "trackPath": "a.wav", "numPoses": 2, "numFrames": 2,
            "facsNames": ["smile", "blink"], "weightMat": [[0.25, 0], [1, 1]]})"}) {
    const WeightTrack track = read("\xEF\xBB\xBF" + std::string(text));
    EXPECT_THAT(track.names, ElementsAre("smile", "blink")) << text;
    EXPECT_EQ(track.weights, (Eigen::Matrix2d() << 0.25, 0, 1, 1).finished()) << text;
    EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.5)) << text;
  }
}

TEST_F(WeightsJson, DoNotUseATimestampAndSaySo) {
  const WeightTrack track = read(R"([{"timestamp": 7, "a": 0}, {"timestamp": 9, "a": 1}])");
  EXPECT_THAT(track.names, ElementsAre("a"));
  EXPECT_EQ(track.times.size(), 0);
  EXPECT_THAT(track.notes, ElementsAre(HasSubstr("'timestamp' is not used")));
}

TEST_F(WeightsJson, OfAFitAreItsExpressions) {
  const WeightTrack track = read(
      R"({"identities": [], "expressions": ["smile"], "frames": [{"time": 0, "rms_px": 1,
      "landmarks": 68, "iterations": 1, "alpha": [], "beta": [0.5],
      "camera": [[1, 0, 0, 0], [0, 1, 0, 0]]}]})");
  EXPECT_THAT(track.names, ElementsAre("smile"));
  EXPECT_EQ(track.weights(0, 0), 0.5);
}

TEST_F(WeightsJson, ErrorsNameThePlaceAndWhatWasFound) {
  EXPECT_THAT(message_of(""), HasSubstr("is empty"));
  EXPECT_THAT(message_of("{\"rows\": ["), HasSubstr("expected weights as JSON: line 1"));
  EXPECT_THAT(message_of("time,smile\n0,1\n"), HasSubstr("call it .csv"));
  EXPECT_THAT(message_of("{}"), HasSubstr("holds no weights"));
  EXPECT_THAT(message_of("[]"), HasSubstr("expected a list of rows"));
  EXPECT_THAT(message_of("[1]"), HasSubstr("row 0: expected an object"));
  EXPECT_THAT(message_of(R"([{"a": null}])"), HasSubstr("row 0, 'a': expected a finite number"));
  EXPECT_THAT(message_of(R"([{"a": 1}, {"b": 1}])"), HasSubstr("row 1: 'b' is no name"));
  EXPECT_THAT(message_of(R"([{"a": 1, "b": 1}, {"b": 1}])"), HasSubstr("row 1: 1 weights"));
  EXPECT_THAT(message_of(R"([{"a": 1, "time": 1}, {"a": 1}])"), HasSubstr("row 1: has no time"));
  EXPECT_THAT(message_of(R"({"names": ["a"], "weights": [[1, 2]]})"),
              HasSubstr("weights/0: 2 weights, expected 1"));
  EXPECT_THAT(message_of(R"({"names": ["a", "a"], "weights": [[1, 2]]})"),
              HasSubstr("'a' occurs twice"));
  EXPECT_THAT(message_of(R"({"names": ["a"], "weights": [[1]], "fps": 0})"),
              HasSubstr("fps: expected more than 0"));
}

TEST_F(Weights, ThatAreJsonAreNoCsv) {
  EXPECT_THAT(message_of("{\"names\": [\"a\"]}"), HasSubstr("holds JSON"));
  EXPECT_THAT(message_of("[\n{\"a\": 1}]"), HasSubstr("call it .json"));
}

TEST_F(Weights, ErrorsNameLineColumnAndWhatWasFound) {
  EXPECT_THAT(message_of("a,b\n0,0\n0,x\n"),
              HasSubstr("line 3: column 'b': expected a finite number, found 'x'"));
  EXPECT_THAT(message_of("a,b\n0,nan\n"), HasSubstr("found 'nan'"));
  EXPECT_THAT(message_of("a,b\n0\n"), HasSubstr("line 2: 1 field, expected 2"));
  EXPECT_THAT(message_of("a,b\n0,5,1\n"), HasSubstr("decimal commas"));
  EXPECT_THAT(message_of("a,a\n0,0\n"), HasSubstr("the name 'a' occurs twice"));
  EXPECT_THAT(message_of("time,Time,a\n"), HasSubstr("two columns of times"));
  EXPECT_THAT(message_of("a,\n0,0\n"), HasSubstr("column 2 has no name"));
  EXPECT_THAT(message_of("time\n0\n"), HasSubstr("no column of weights"));
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

TEST_F(Weights, MayHaveASign) {
  EXPECT_EQ(read("a,b\n+1,-0.5\n+.5,0\n").weights.col(0), Eigen::Vector2d(1, 0.5));
  EXPECT_THAT(message_of("a\n+-1\n"), HasSubstr("expected a finite number, found '+-1'"));
}

TEST_F(Weights, OfRowsThatLostTheFaceLieBetweenTheirNeighbours) {
  // Without values, and cut off behind their number.
  const WeightTrack track = read(
      "Timecode,BlendShapeCount,JawOpen,JawLeft\n10:00:00:01,0,,\n10:00:00:02,61,0.2,0.5\n"
      "10:00:00:03,0\n10:00:00:04,0\n10:00:00:05,61,0.8,0.5\n10:00:00:06,0\n");
  EXPECT_THAT(track.weights.col(0), ElementsAre(0.2, 0.2, testing::DoubleNear(0.4, 1e-15),
                                                testing::DoubleNear(0.6, 1e-15), 0.8, 0.8));
  EXPECT_THAT(track.notes, testing::Contains(HasSubstr("rows without weights")));
  EXPECT_THAT(message_of("a,b\n,\n,\n"), HasSubstr("no row with weights"));
  EXPECT_THAT(message_of("Timecode,BlendShapeCount,JawOpen\n10:00:00:01,61,0.5\n10:00:00:02,61,\n"
                         "10:00:00:03,61\n"),
              HasSubstr("line 4: is cut off: it has no weights of the 61 that it counts"));
  EXPECT_THAT(message_of("a,b\n0.5,\n"), HasSubstr("'b': expected a finite number"));
  EXPECT_THAT(message_of("a,b\n0.5\n"), HasSubstr("1 field, expected 2"));
}

TEST_F(Weights, NameFramesThatNoRowHasWhereThereAreNoTimes) {
  const auto notes_of = [this](const std::string& content) { return read(content).notes; };
  EXPECT_THAT(notes_of("frame,a\n1,0\n2,0\n7,0\n8,0\n"),
              ElementsAre(HasSubstr("no row has these frames: 3 to 6")));
  EXPECT_THAT(notes_of("frame,a\n0,0\n2,0\n4,0\n"), testing::IsEmpty());
  EXPECT_THAT(notes_of("frame,time,a\n1,0,0\n7,0.2,0\n8,0.3,0\n"), testing::IsEmpty());
  EXPECT_THAT(notes_of("frame,a\nfirst,0\n2,0\n7,0\n"),
              ElementsAre(HasSubstr("'frame' is not used")));
}

TEST_F(Weights, OfRowsThatCountInStepsAreAsManyFramesApart) {
  EXPECT_EQ(read("frame,a\n1001,0\n1003,0\n1007,0\n").step, 2);
  EXPECT_EQ(read("frame,a\n0,0\n2,0\n7,0\n").step, 1);
  EXPECT_EQ(read("Frame_Index,a\n0,0\n5,0\n").step, 5);
  EXPECT_EQ(read("frame,a\n4,0\n2,0\n0,0\n").step, 1);
  EXPECT_EQ(read("a\n0\n0\n").step, 1);
}

TEST_F(Weights, SayThatManyTimesAtWholeSecondsLookLikeNumbersOfFrames) {
  std::string text = "time,a\n";
  for (int f = 0; f < 10; ++f) text += std::to_string(f) + ",0\n";
  EXPECT_THAT(read(text).notes, ElementsAre(HasSubstr("numbers of frames; expected seconds")));
}

TEST_F(Weights, SayThatTimesLookLikeMilliseconds) {
  EXPECT_THAT(read("time,a\n0,0\n33.3,0\n66.7,0\n").notes,
              ElementsAre(HasSubstr("its frames are 33.4 s apart")));
  EXPECT_THAT(read("time,a\n0,0\n1,0\n2,0\n").notes, testing::IsEmpty());
}

TEST_F(Weights, OfOneNameDriveBothHalves) {
  for (const char* end : {"_L", ".l", "Left", "_left"}) {
    const WeightMatch match = match_weights({{"browInnerUp", "jaw"}, {}, {}},
                                            {std::string("browInnerUp") + end, "jawLeft"});
    EXPECT_THAT(match.column, ElementsAre(0, -1)) << end;
  }
}

TEST_F(Weights, MatchNamesOfSidesHoweverTheyAreWritten) {
  const std::vector<std::vector<std::string>> spellings = {{"eyeBlink_L", "eyeBlink_R"},
                                                           {"eyeBlinkLeft", "eyeBlinkRight"},
                                                           {"eyeBlink.L", "eyeBlink.R"},
                                                           {"EyeBlink_l", "EyeBlink_r"}};
  for (const auto& columns : spellings) {
    for (const auto& expressions : spellings) {
      const WeightMatch match = match_weights({columns, {}, {}}, expressions);
      EXPECT_THAT(match.column, ElementsAre(0, 1)) << columns[0] << " to " << expressions[0];
      EXPECT_THAT(match.unmatched_columns, testing::IsEmpty());
    }
  }
}

TEST_F(WeightsJson, AreNumberedAsThoseOfCsv) {
  const WeightTrack counted =
      read(R"([{"frame": 2, "a": 0}, {"frame": 4, "a": 0}, {"frame": 8, "a": 0}])");
  EXPECT_EQ(counted.step, 2);
  EXPECT_THAT(counted.notes, ElementsAre(HasSubstr("no row has these frames: 6")));
  const WeightTrack timed = read(R"({"fps": 10, "frames": [{"frame": 2, "a": 0},
                                     {"frame": 4, "a": 0}, {"frame": 8, "a": 0}]})");
  EXPECT_EQ(timed.times, Eigen::Vector3d(0, 0.2, 0.6));
  EXPECT_THAT(timed.notes, testing::IsEmpty());
}

TEST_F(WeightsJson, OfMediaPipeAreItsCategories) {
  const auto row = [](const char* time, const char* smile) {
    return std::string(R"({"timestamp_ms": )") + time +
           R"(, "faceBlendshapes": [{"categories": [{"categoryName": "_neutral", "score": 1},
                {"index": 1, "categoryName": "smile", "score": )" +
           smile + R"(}]}]})";
  };
  const WeightTrack track = read("[" + row("0", "0.25") + "," + row("40", "0.5") + "]");
  EXPECT_THAT(track.names, ElementsAre("smile"));
  EXPECT_EQ(track.weights, Eigen::Vector2d(0.25, 0.5));
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.04));
  const WeightTrack plain =
      read(R"([{"face_blendshapes": [[{"category_name": "smile", "score": 0.5}]]}])");
  EXPECT_EQ(plain.weights(0, 0), 0.5);
  EXPECT_THAT(message_of(R"([{"faceBlendshapes": []}])"), HasSubstr("row 0: expected the categ"));
}

TEST_F(Weights, ThatAreMissingLieBetweenTheirNeighbours) {
  const WeightTrack track = read("a,b\n0,0\nnan,1\n,\n0.75,NaN\n");
  EXPECT_EQ(track.weights.col(0), Eigen::Vector4d(0, 0.25, 0.5, 0.75));
  EXPECT_EQ(track.weights.col(1), Eigen::Vector4d(0, 1, 1, 1));
  EXPECT_THAT(track.notes, ElementsAre(HasSubstr("rows without weights"),
                                       HasSubstr("columns in which weights are missing")));
  EXPECT_THAT(message_of("a,b\n0,inf\n"), HasSubstr("'b': expected a finite number"));
  EXPECT_THAT(message_of("a\nnan\n\nnan\n"),
              HasSubstr("line 2: column 'a': expected a finite number, found 'nan'"));
}

TEST_F(Weights, MayHaveCommentsAndCommasAtTheEndsOfLines) {
  const WeightTrack track = read("# take 7\na,b,\n0,0.5,\n# lost\n1,0.25,\n");
  EXPECT_THAT(track.names, ElementsAre("a", "b"));
  EXPECT_EQ(track.weights, (Eigen::Matrix2d() << 0, 0.5, 1, 0.25).finished());
  EXPECT_EQ(read("a,b\n0,0.5,\n").weights.cols(), 2);
}

TEST_F(Weights, MayBeThoseOfASpreadsheetWithDecimalCommas) {
  const WeightTrack track = read("time;a;b\n0,5;0,25;1\n1;;0.75\n");
  EXPECT_THAT(track.names, ElementsAre("a", "b"));
  EXPECT_EQ(track.times, Eigen::Vector2d(0.5, 1));
  EXPECT_EQ(track.weights(0, 0), 0.25);
  EXPECT_EQ(track.weights.row(1), Eigen::RowVector2d(0.25, 0.75));
}

TEST_F(Weights, OfOtherFilesAreNamedAsWhatTheyAre) {
  EXPECT_THAT(message_of("a\tb\n0\t1\n"), HasSubstr("separated by tabs, expected ',' or ';'"));
  std::ofstream(folder_ / "w.npy") << "anything";
  EXPECT_THAT(test::message_of<IoError>([this] { read_weights(folder_ / "w.npy"); }),
              HasSubstr("is a NumPy array, which does not name its weights"));
}

TEST_F(Weights, FindExpressionsWhoseSideComesFirst) {
  WeightTrack track;
  track.names = {"L_smile", "right_smile"};
  EXPECT_THAT(match_weights(track, {"smile_L", "smileRight"}).column, ElementsAre(0, 1));
  track.names = {"smileLeft", "smile_R"};
  EXPECT_THAT(match_weights(track, {"l_smile", "Right_smile"}).column, ElementsAre(0, 1));
}

}  // namespace
}  // namespace mimetra
