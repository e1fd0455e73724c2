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

TEST_F(OddWeights, ArePercentOnlyWhereMostColumnsAre) {
  // Degrees of a rotation and a stranger's column are no weights in percent.
  const WeightTrack usual =
      read("jawOpen,smile,HeadYaw,neckBend\n0,0.5,0,0\n0.8,0.25,20,15\n0.4,0,30,40\n");
  EXPECT_EQ(usual.weights(1, 0), 0.8);
  EXPECT_EQ(usual.weights(1, 2), 20);
  EXPECT_THAT(usual.notes, ElementsAre(HasSubstr("the weight of 'neckBend' is 40")));
}

TEST_F(OddWeights, InPercentAreKnownBesideRotations) {
  const WeightTrack percent =
      read("jawOpen,smile,headRX,LeftEyePitch\n0,55,-3.2,-0.3\n80,12,4,0\n");
  EXPECT_EQ(percent.weights,
            (Eigen::MatrixXd(2, 4) << 0, 0.55, -3.2, -0.3, 0.8, 0.12, 4, 0).finished());
  EXPECT_THAT(percent.notes, ElementsAre(HasSubstr("go up to 80 and look like percent")));
}

TEST_F(OddWeights, OfRotationsAreNoReasonToWarn) {
  const WeightTrack few = read("jawOpen,headRotX,headRotationY,eyeYaw\n0.2,12,6,18\n0.8,14,7,19\n");
  EXPECT_THAT(few.weights.col(0), ElementsAre(0.2, 0.8));
  EXPECT_THAT(few.notes, testing::IsEmpty());
  EXPECT_THAT(read("JawOpen,HeadYaw,RightEyeRoll\n0.5,-0.3,2.5\n").notes, testing::IsEmpty());
  EXPECT_THAT(read("headYaw,headPitch\n20,30\n").notes, testing::IsEmpty());
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
