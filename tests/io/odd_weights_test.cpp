#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

class OddWeights : public testing::Test {
 protected:
  /// \pre a file of JSON begins with a bracket
  WeightTrack read(const std::string& content) const {
    const bool is_json = content.front() == '[' || content.front() == '{';
    const auto path = folder_ / (is_json ? "w.json" : "w.csv");
    write_bytes(path, content);
    return read_weights(path);
  }

  test::TemporaryFolder folder_;
};

TEST_F(OddWeights, AreScaledOnRequestAndRefusedFarBeyondOne) {
  const std::vector<std::string> expressions = {"browInnerUp_L", "browInnerUp_R", "jawOpen"};
  // A head's pose in degrees drives nothing.
  const std::string percent = "browInnerUp,jawOpen,pitch\n55,80,-120\n0,12,-130\n";
  WeightTrack track = read(percent);
  scale_weights("w.csv", track, expressions, 0.01);
  EXPECT_TRUE(track.weights.leftCols(2).isApprox(
      (Eigen::Matrix2d() << 0.55, 0.8, 0, 0.12).finished(), 1e-15));
  track = read(percent);
  EXPECT_EQ(test::message_of<IoError>([&] { scale_weights("w.csv", track, expressions, {}); }),
            "w.csv: the weight of 'browInnerUp' is 55 in frame 0, expected 0 to 1; option "
            "'weight-scale' multiplies weights: 0.01 where they are in percent, 1 to take them as "
            "they are");
  scale_weights("w.csv", track, expressions, 1);
  EXPECT_EQ(track.weights(0, 1), 80);
  WeightTrack usual = read("browInnerUp,jawOpen,pitch\n-0.5,2,-120\n");
  scale_weights("w.csv", usual, expressions, {});
  EXPECT_EQ(usual.weights, Eigen::RowVector3d(-0.5, 2, -120));
  WeightTrack below = read("jawOpen\n-2.5\n");
  EXPECT_THAT(test::message_of<IoError>([&] { scale_weights("w", below, expressions, {}); }),
              HasSubstr("'jawOpen' is -2.5"));
  below.is_fit = true;
  scale_weights("w", below, expressions, {});
}

TEST_F(OddWeights, ThatAreMissingLieBetweenTheirNeighboursInTime) {
  EXPECT_THAT(read("time,a\n0,0\n0.1,nan\n0.4,1\n").weights.col(0),
              ElementsAre(0, DoubleNear(0.25, 1e-15), 1));
  EXPECT_THAT(read(R"([{"time": 0, "a": 0}, {"time": 0.1, "a": null}, {"time": 0.4, "a": 1}])")
                  .weights.col(0),
              ElementsAre(0, DoubleNear(0.25, 1e-15), 1));
  EXPECT_THAT(read(R"({"names": ["a"], "weights": [[0], [null], [1]]})").weights.col(0),
              ElementsAre(0, 0.5, 1));
}

TEST_F(OddWeights, OfFramesWithoutAFaceLieBetweenTheirNeighbours) {
  const auto face = [](const char* score) {
    return std::string(
               R"({"faceBlendshapes": [{"categories": [{"categoryName": "jawOpen", "score": )") +
           score + "}]}]}";
  };
  const std::string none = R"({"faceBlendshapes": []})";
  const WeightTrack track =
      read("[" + none + "," + face("0.5") + "," + none + "," + face("1") + "]");
  EXPECT_THAT(track.names, ElementsAre("jawOpen"));
  EXPECT_THAT(track.weights.col(0), ElementsAre(0.5, 0.5, 0.75, 1));
  EXPECT_THAT(track.notes, ElementsAre(HasSubstr("rows without weights, which are taken from "
                                                 "between their neighbours': 0, 2")));
  EXPECT_THAT(test::message_of<IoError>([&] { read("[" + none + "]"); }),
              HasSubstr("row 0: expected the categories of one face there or in another"));
}

TEST_F(OddWeights, HaveTimesInMillisecondsWhereTheirNameSaysSo) {
  for (const char* text : {"time_ms,a\n0,0\n500,1\n", "Timestamp_ms,a\n0,0\n500,1\n",
                           R"([{"time_ms": 0, "a": 0}, {"time_ms": 500, "a": 1}])",
                           R"([{"Time": 0, "a": 0}, {"Time": 0.5, "a": 1}])"}) {
    const WeightTrack track = read(text);
    EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.5)) << text;
    EXPECT_THAT(track.names, ElementsAre("a")) << text;
  }
}

TEST_F(OddWeights, CountByTheNumbersOfTheirFramesWhereAllHaveOne) {
  for (const char* text :
       {"frame,a\n1.0,0\n3.0,1\n5.0,0\n",
        R"([{"frame": 1.0, "a": 0}, {"frame": 3.0, "a": 1}, {"frame": 5.0, "a": 0}])",
        R"([{"frame": 1, "frame_index": 0, "a": 0},
                               {"frame": 3, "frame_index": 1, "a": 1}])"}) {
    EXPECT_EQ(read(text).step, 2) << text;
  }
  const WeightTrack some = read(R"([{"frame": 0, "a": 0}, {"a": 1}, {"frame": 2, "a": 0}])");
  EXPECT_EQ(some.step, 1);
  EXPECT_THAT(some.notes, ElementsAre(HasSubstr("'frame' is not used")));
}

TEST_F(OddWeights, MayHaveTheirNodesInTheColumns) {
  const WeightTrack track =
      read("blendShape1.jawOpen,blendShape1.mouthSmileLeft,smile.L\n0.5,1,0\n");
  EXPECT_THAT(match_weights(track, {"jawOpen", "mouthSmile_L", "smile_L"}).column,
              ElementsAre(0, 1, 2));
  // Another node's shape is another one.
  EXPECT_THAT(match_weights(track, {"face.jawOpen", "brow"}).column, ElementsAre(-1, -1));
  // The one without a node goes first.
  const WeightTrack both = read("teeth.jawOpen,jawOpen\n0.5,1\n");
  EXPECT_THAT(match_weights(both, {"jawOpen"}).column, ElementsAre(1));
  const WeightTrack two = read("teeth.jawOpen,face.jawOpen\n0.5,1\n");
  EXPECT_THAT(match_weights(two, {"jawOpen"}).column, ElementsAre(-1));
}

TEST_F(OddWeights, ByColumnsAreThoseByRows) {
  for (const char* text :
       {R"({"time": [0, 0.5, 1], "a": [0, 0.25, 1], "b": [1, null, 0]})",
        R"({"time": {"0": 0, "1": 0.5, "2": 1}, "a": {"0": 0, "1": 0.25, "2": 1},
            "b": {"0": 1, "1": null, "2": 0}})",
        R"({"take": "smile", "fps": 2, "a": [0, 0.25, 1], "b": [1, null, 0]})",
        R"({"times": [0, 0.5, 1], "a": [0, 0.25, 1], "b": [1, null, 0]})",
        R"({"fps": 2, "frame": [0, 1, 2], "a": [0, 0.25, 1], "b": [1, null, 0]})"}) {
    const WeightTrack track = read(text);
    EXPECT_THAT(track.names, ElementsAre("a", "b")) << text;
    EXPECT_EQ(track.weights, (Eigen::MatrixXd(3, 2) << 0, 1, 0.25, 0.5, 1, 0).finished()) << text;
    EXPECT_EQ(track.times, Eigen::Vector3d(0, 0.5, 1)) << text;
  }
  // As many as need two digits are in the order of their numbers.
  std::string numbers;
  for (int i = 11; i >= 0; --i) {
    numbers += "\"" + std::to_string(i) + "\": " + std::to_string(i) + (i > 0 ? ", " : "");
  }
  EXPECT_EQ(read("{\"a\": {" + numbers + "}}").weights.col(0),
            Eigen::VectorXd(Eigen::VectorXd::LinSpaced(12, 0, 11)));
  const auto message_of = [&](const char* text) {
    return test::message_of<IoError>([&] { read(text); });
  };
  EXPECT_THAT(message_of(R"({"a": [0, 1], "b": [0]})"),
              HasSubstr("'b': 1 numbers, expected 2 as 'a' has"));
  EXPECT_THAT(message_of(R"({"a": {"0": 0, "2": 1}})"), HasSubstr("'a': has no row 1"));
  EXPECT_THAT(message_of(R"({"a": [null, null]})"),
              HasSubstr("row 0, 'a': expected a finite number"));
  for (const char* other : {R"({"a": ["x"]})", R"({"a": []})", R"({"a": [0], "b": [{}, {}]})"}) {
    EXPECT_THAT(message_of(other), HasSubstr("holds no weights")) << other;
  }
}

TEST_F(OddWeights, WhoseTimesRepeatNameThem) {
  const auto message_of = [&](const char* text) {
    return test::message_of<IoError>([&] { read(text); });
  };
  EXPECT_THAT(message_of("time,a\n0.25,0\n0.25,1\n"),
              HasSubstr("line 3: times do not ascend: 0.25 is not later than the 0.25 of the row "
                        "before; leave out one of the rows, or the column"));
  EXPECT_THAT(message_of(R"([{"time": 0.5, "a": 0}, {"time": 0.25, "a": 1}])"),
              HasSubstr("row 1: times do not ascend: 0.25 is not later than the 0.5"));
}

TEST_F(OddWeights, OfShapesOfANodeMatchWithoutIt) {
  const WeightTrack track = read("jawOpen,mouthSmileLeft\n0.5,1\n");
  EXPECT_THAT(match_weights(track, {"blendShape1.jawOpen", "face.mouthSmile_L", "smile.L"}).column,
              ElementsAre(0, 1, -1));
  const WeightTrack visemes = read("aa,PP,left\n0.5,1,0\n");
  EXPECT_THAT(match_weights(visemes, {"visemes.aa", "visemes.PP", "smile.left"}).column,
              ElementsAre(0, 1, -1));
}

}  // namespace
}  // namespace mimetra
