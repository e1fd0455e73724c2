#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/landmark_file.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Landmarks : public testing::Test {
 protected:
  LandmarkTrack read(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return read_landmarks(folder_ / name);
  }
  std::string message(const std::string& name, const std::string& content) {
    return test::message_of<IoError>([&] { read(name, content); });
  }
  test::TemporaryFolder folder_;
};

const char* const kPts = "version: 1\nn_points:  2\n{\n1 1\n3.5 7\n}\n";

TEST_F(Landmarks, OfAPtsFileBecomeZeroBased) {
  const LandmarkTrack track = read("a.pts", kPts);
  EXPECT_THAT(track.names, ElementsAre("1", "2"));
  EXPECT_EQ(track.points, Eigen::RowVector4d(0, 0, 2.5, 6));
  EXPECT_EQ(track.times.size(), 0);
  // With a byte order mark and carriage returns.
  EXPECT_EQ(read("a.PTS", "\xEF\xBB\xBFversion: 1\r\nn_points: 1\r\n{\r\n2 3\r\n}\r\n").points,
            Eigen::RowVector2d(1, 2));
}

TEST_F(Landmarks, OfEveryTruncatedPtsFileAreAnError) {
  const std::string content = kPts;
  for (std::size_t length = 0; length + 2 < content.size(); ++length) {
    EXPECT_THAT(message("a.pts", content.substr(0, length)), HasSubstr("a.pts")) << length;
  }
}

TEST_F(Landmarks, OfABrokenPtsFileNameTheLine) {
  EXPECT_THAT(message("a.pts", "version: 2\n"),
              AllOf(StartsWith((folder_ / "a.pts").string()),
                    HasSubstr("line 1: expected '1', found '2'")));
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 0\n{\n}\n"),
              HasSubstr("line 2: n_points is 0"));
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 1\n{\n1 a\n}\n"),
              HasSubstr("line 4: expected a number for y, found 'a'"));
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 1\n{\n1 nan\n}\n"),
              HasSubstr("line 4: a coordinate is not finite"));
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 1\n{\n1 2\n3 4\n}\n"),
              HasSubstr("line 5: expected '}', found '3'"));
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 99999999999\n{\n1 2\n}\n"),
              HasSubstr("line 2: n_points is 99999999999"));
}

TEST_F(Landmarks, OfACsvTrackAreWholeOrMissing) {
  const LandmarkTrack track = read("a.csv", "x0,y0,x1,y1\n,,31,41\nnan,NaN,1,2\n");
  EXPECT_TRUE(std::isnan(track.points(0, 0)) && std::isnan(track.points(1, 1)));
  EXPECT_EQ(track.points(0, 3), 41);
  EXPECT_EQ(track.times.size(), 0);
  EXPECT_THAT(message("a.csv", "x0,y0\n1,\n"),
              HasSubstr("line 2: only one of 'x0' and 'y0' is a number"));
}

TEST_F(Landmarks, OfOpenFaceAreRead) {
  const LandmarkTrack track = read(
      "a.csv",
      "frame, face_id, timestamp, confidence, success, eye_lmk_x_0, x_0, x_1, y_0, y_1, X_0\r\n"
      "1, 0, 0.000, 0.98, 1, 5, 10, 11, 20, 21, 7\r\n2, 0, 0.033, 0.1, 0, 5, 0, 0, 0, 0, 7\r\n");
  EXPECT_EQ(track.points.row(0), Eigen::RowVector4d(10, 20, 11, 21));
  EXPECT_TRUE(track.points.row(1).array().isNaN().all());
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.033));
  EXPECT_EQ(track.confidence, Eigen::Vector2d(0.98, 0.1));
}

TEST_F(Landmarks, OfACsvTrackHaveTimesUnderSeveralNames) {
  for (const char* name : {"Time", "Timestamp", "seconds", "time (s)"}) {
    const LandmarkTrack track = read("a.csv", name + std::string(",x0,y0\n0,1,2\n0.04,1,2\n"));
    EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.04)) << name;
  }
  EXPECT_EQ(read("a.csv", "timestamp_ms,x0,y0\n0,1,2\n40,1,2\n").times, Eigen::Vector2d(0, 0.04));
  EXPECT_EQ(read("a.csv", "time_s,ms,x0,y0\n0,7,1,2\n0.04,7,1,2\n").times,
            Eigen::Vector2d(0, 0.04));
}

TEST_F(Landmarks, OfACsvTrackHaveSuccessAndConfidenceInAnyCase) {
  const LandmarkTrack track = read("a.csv", "Success,Confidence,x0,y0\n1,0.5,1,2\n0,0.25,3,4\n");
  EXPECT_FALSE(track.points.row(0).array().isNaN().any());
  EXPECT_TRUE(track.points.row(1).array().isNaN().all());
  EXPECT_EQ(track.confidence, Eigen::Vector2d(0.5, 0.25));
}

TEST_F(Landmarks, OfABrokenCsvTrackNameTheLine) {
  EXPECT_THAT(message("a.csv", ""), HasSubstr("is empty; expected a line of column names"));
  EXPECT_THAT(message("a.csv", "x0,y0\n"), HasSubstr("has column names but no frame"));
  EXPECT_THAT(message("a.csv", "a,b\n1,2\n"),
              HasSubstr("line 1: no landmarks; expected columns x0, y0"));
  EXPECT_THAT(message("a.csv", "x0,y0,x2,y2\n1,2,3,4\n"),
              HasSubstr("line 1: column 'x1' is missing before 'x2'"));
  EXPECT_THAT(message("a.csv", "x0,y1\n1,2\n"), HasSubstr("line 1: no column 'y' for 'x0'"));
  EXPECT_THAT(message("a.csv", "x0,y0,y1\n1,2,3\n"),
              HasSubstr("line 1: there are more columns of y than of x"));
  EXPECT_THAT(message("a.csv", "x0,y0,x_0\n1,2,3\n"),
              HasSubstr("line 1: the column 'x_0' occurs twice"));
  EXPECT_THAT(message("a.csv", "x0,y0\n1,5,2,5\n"),
              HasSubstr("decimal commas need ';' between fields"));
  EXPECT_THAT(message("a.csv", "x0,y0\n1,2\n\n1\n"),
              HasSubstr("line 4: 1 field, expected 2 as in the first line"));
  EXPECT_THAT(message("a.csv", "x0,y0\n1,b\n"),
              HasSubstr("line 2: column 'y0': expected a finite number, found 'b'"));
  EXPECT_THAT(message("a.csv", "x0,y0\n1,inf\n"), HasSubstr("found 'inf'"));
  EXPECT_THAT(message("a.csv", "time,x0,y0\n1,1,2\n1,1,2\n"),
              HasSubstr("line 3: times do not ascend; expected one face and one row a frame"));
}

TEST_F(Landmarks, OfAJsonFileMayHaveNames) {
  const LandmarkTrack track = read("a.json",
                                   R"({"names": ["chin", "nose"], "frames": [
              {"time": 0, "confidence": 1, "points": [[1, 2], [3, 4]]},
              {"time": 0.5, "confidence": 0.5, "points": [null, [5, 6]]}]})");
  EXPECT_THAT(track.names, ElementsAre("chin", "nose"));
  EXPECT_EQ(track.points.row(0), Eigen::RowVector4d(1, 2, 3, 4));
  EXPECT_TRUE(std::isnan(track.points(1, 0)) && std::isnan(track.points(1, 1)));
  EXPECT_EQ(track.points(1, 3), 6);
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(track.confidence, Eigen::Vector2d(1, 0.5));
}

TEST_F(Landmarks, OfAJsonFileMayBeOneFrame) {
  const LandmarkTrack track = read("a.json", R"({"points": [[1, 2]]})");
  EXPECT_EQ(track.points, Eigen::RowVector2d(1, 2));
  EXPECT_THAT(track.names, ElementsAre("1"));
}

TEST_F(Landmarks, OfAJsonFileHaveTimesUnderSeveralNames) {
  for (const char* time : {R"("Time": 0.5)", R"("time_s": 0.5)", R"("timestampMs": 500)"}) {
    const std::string frame = "[{" + std::string(time) + R"(, "points": [[1, 2]]}])";
    EXPECT_EQ(read("a.json", frame).times, Eigen::VectorXd::Constant(1, 0.5)) << time;
  }
}

/// The second of four is (1, 2) in the first frame, and nothing else is seen.
TEST_F(Landmarks, OfAJsonFileMayBeginWithOneThatWasNotSeen) {
  const std::string face = "[null, [1, 2], null, null]", none = "[null, null, null, null]";
  const std::string pairs = "[[null, null], [1, 2], [null, null], null]";
  const std::string no_pairs = "[[null, null], [null, null], [null, null], [null, null]]";
  const std::string unseen = R"({"x": null, "y": null})";
  const std::string keys = "[" + unseen + R"(, {"x": 1, "y": 2}, null, )" + unseen + "]";
  const std::vector<std::string> files = {
      "[" + face + ", " + none + "]",
      "[[" + face + "], [" + none + "]]",
      "[" + pairs + ", " + no_pairs + "]",
      R"({"frames": [{"points": )" + face + R"(}, {"points": )" + none + "}]}",
      R"({"frames": [{"points": [)" + face + R"(]}, {"points": )" + no_pairs + "}]}",
      R"([{"landmarks": )" + keys + "}, null]",
      R"([{"faceLandmarks": [)" + keys + R"(]}, {"faceLandmarks": [)" + none + "]}]",
  };
  for (const std::string& file : files) {
    const LandmarkTrack track = read("a.json", file);
    ASSERT_EQ(track.frames(), 2) << file;
    ASSERT_EQ(track.landmarks(), 4) << file;
    EXPECT_EQ(track.points.row(0).segment(2, 2), Eigen::RowVector2d(1, 2)) << file;
    EXPECT_EQ(track.points.array().isNaN().count(), 14) << file;
  }
  EXPECT_EQ(read("a.json", "[" + none + ", [[1, 2], [3, 4], [5, 6], [7, 8]]]").frames(), 2);
  EXPECT_EQ(read("a.json", pairs).frames(), 1);
}

TEST_F(Landmarks, OfAJsonFileNeedBothCoordinates) {
  EXPECT_THAT(message("a.json", R"({"points": [[1, null]]})"),
              HasSubstr("/points/0: expected a finite number"));
  EXPECT_THAT(message("a.json", R"({"points": [{"x": 1, "y": null}]})"),
              HasSubstr("/points/0/y: expected a finite number"));
}

TEST_F(Landmarks, OfABrokenJsonFileNameTheElement) {
  EXPECT_THAT(message("a.json", "{"), HasSubstr("expected JSON"));
  EXPECT_THAT(message("a.json", "[]"), HasSubstr("shows no face in any frame"));
  EXPECT_THAT(message("a.json", "{}"), HasSubstr("/: expected a list of \"points\""));
  EXPECT_THAT(message("a.json", "[[]]"), HasSubstr("shows no face in any frame"));
  EXPECT_THAT(message("a.json", R"({"points": 3})"), HasSubstr("/points: expected a list"));
  EXPECT_THAT(message("a.json", R"({"points": []})"), HasSubstr("shows no face in any frame"));
  EXPECT_THAT(message("a.json", R"({"frames": []})"), HasSubstr("/frames: expected a list"));
  EXPECT_THAT(message("a.json", R"({"points": [[1]]})"),
              HasSubstr("/points/0: expected [x, y] or null"));
  EXPECT_THAT(message("a.json", R"({"points": [["a", 1]]})"),
              HasSubstr("/points/0: expected a finite number"));
  EXPECT_THAT(message("a.json", R"({"frames": [{"points": [[1, 2]]}, {"points": [null, null]}]})"),
              HasSubstr("/frames/1/points: 2 points, expected 1 as in the first frame"));
  EXPECT_THAT(message("a.json", R"([{"timestamp": 33, "points": [[1, 2]]}])"),
              HasSubstr("/0/timestamp: in which unit?"));
  EXPECT_THAT(
      message("a.json", R"({"frames": [{"points": [null]}, {"time": 1, "points": [null]}]})"),
      HasSubstr("\"time\" is in 1 of 2 frames"));
  EXPECT_THAT(message("a.json", R"({"frames": [{"time": 1, "points": [null]},
                                               {"time": 1, "points": [null]}]})"),
              HasSubstr("/frames/1/time: times do not ascend"));
  EXPECT_THAT(message("a.json", R"({"names": ["a", "b"], "points": [null]})"),
              HasSubstr("/names: expected a list of 1 names"));
  EXPECT_THAT(message("a.json", R"({"names": [1], "points": [null]})"),
              HasSubstr("/names: expected strings"));
  EXPECT_THAT(message("a.json", R"({"names": ["a", "a"], "points": [null, null]})"),
              HasSubstr("/names: the name 'a' occurs twice"));
}

TEST_F(Landmarks, AreWrittenAsTheyAreRead) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LandmarkTrack track;
  track.names = {"1", "2"};
  track.points.resize(3, 4);
  track.points << 0.1, 1.0 / 3, -2, 1e-7, nan, nan, 5, 6, nan, nan, nan, nan;
  track.times = Eigen::Vector3d(0, 1.0 / 30, 0.7);
  track.confidence = Eigen::Vector3d(0.9, 0.123456789012345678, 0);
  const LandmarkTrack again = read("a.csv", landmark_csv(track));
  EXPECT_EQ(again.names, track.names);
  EXPECT_EQ(again.times, track.times);
  EXPECT_EQ(again.confidence, track.confidence);
  EXPECT_TRUE((again.points.array() == track.points.array() ||
               (again.points.array().isNaN() && track.points.array().isNaN()))
                  .all());
  track.times.resize(0);
  track.confidence.resize(0);
  EXPECT_EQ(read("b.csv", landmark_csv(track)).times.size(), 0);
  track.names = {"nose", "chin"};
  EXPECT_THAT(test::message_of<MismatchError>([&] { landmark_csv(track); }), HasSubstr("'nose'"));
}

/// Every frame of these shows (1, 2) and (3, 4), and the second none.
TEST_F(Landmarks, OfMediaPipeAreReadAsItsInterfacesGiveThem) {
  const std::string face = R"([{"x": 1, "y": 2, "z": -5}, {"x": 3, "y": 4, "z": 6}])";
  const std::vector<std::string> files = {
      R"({"frames": [{"faceLandmarks": [)" + face + R"(]}, {"faceLandmarks": []}]})",
      R"([{"face_landmarks": [)" + face + R"(]}, {"face_landmarks": []}])",
      R"([{"multi_face_landmarks": [{"landmark": )" + face + R"(}]}, null])",
      R"([{"multiFaceLandmarks": [)" + face + R"(]}, {"multiFaceLandmarks": null}])",
      "[" + face + ", null]",
      "[" + face + ", []]",
      "[[[1, 2, -5], [3, 4, 6]], []]",
  };
  for (const std::string& file : files) {
    const LandmarkTrack track = read("a.json", file);
    ASSERT_EQ(track.frames(), 2) << file;
    EXPECT_EQ(track.points.row(0), Eigen::RowVector4d(1, 2, 3, 4)) << file;
    EXPECT_TRUE(track.points.row(1).array().isNaN().all()) << file;
  }
  EXPECT_TRUE(read("a.json", "[null, " + face + "]").points.row(0).array().isNaN().all());
}

TEST_F(Landmarks, OfSeveralFacesFollowOneFromTheLargestOn) {
  const auto face = [](double x, double size) {
    const std::string left = std::to_string(x - size), right = std::to_string(x + size);
    return "[[" + left + ", 0], [" + right + ", 0]]";
  };
  const LandmarkTrack track =
      read("a.json", "[[" + face(10, 1) + ", " + face(50, 3) + "], [" + face(12, 9) + ", " +
                         face(47, 1) + "], [" + face(40, 2) + "]]");
  EXPECT_EQ(track.points.col(0), Eigen::Vector3d(47, 46, 38));
}

TEST_F(Landmarks, OfSomebodyElseAreNotTakenWhereTheFollowedFaceIsMissed) {
  const auto face = [](double x) {
    return "[[" + std::to_string(x - 5) + ", 0], [" + std::to_string(x + 5) + ", 10]]";
  };
  const LandmarkTrack track =
      read("a.json", "[[" + face(10) + "," + face(50) + "], [" + face(50) + "], [null, null], [" +
                         face(51) + "," + face(12) + "]]");
  EXPECT_EQ(track.points(0, 0), 5);
  EXPECT_TRUE(track.points.middleRows(1, 2).array().isNaN().all());
  EXPECT_EQ(track.points(3, 0), 7);
  EXPECT_THAT(
      track.notes,
      ElementsAre("2 of 4 frames have several faces, of which the largest of the first frame with "
                  "a face is "
                  "followed: 0, 3",
                  "1 of 4 frames have only faces of others than the one that is followed, and are "
                  "taken as not seen: 1"));
  EXPECT_THAT(read("a.json", "[[" + face(10) + "], [" + face(90) + "]]").notes, testing::IsEmpty());
}

TEST_F(Landmarks, OfMediaPipeAreCalledByItsNumbersAndMayHaveMilliseconds) {
  for (const int count : {468, 478}) {
    std::string points;
    for (int i = 0; i < count; ++i) points += (i > 0 ? ", [" : "[") + std::to_string(i) + ", 0, 0]";
    const LandmarkTrack track =
        read("a.json", R"([{"timestamp_ms": 40, "faceLandmarks": [[)" + points + "]]}]");
    EXPECT_EQ(track.names.front(), "mp0");
    EXPECT_EQ(track.names.back(), "mp" + std::to_string(count - 1));
    EXPECT_EQ(track.points(0, 2 * 133), 133);
    EXPECT_EQ(track.times[0], 0.04);
  }
}

TEST_F(Landmarks, OfACsvTrackMayCountFromOne) {
  const LandmarkTrack track = read("a.csv", "x1,y1,z1,x2,y2,z2\n1,2,9,3,4,9\n");
  EXPECT_THAT(track.names, ElementsAre("1", "2"));
  EXPECT_EQ(track.points, Eigen::RowVector4d(1, 2, 3, 4));
}

TEST_F(Landmarks, OfAnUnknownFormatAreRefused) {
  EXPECT_THAT(message("a.txt", ""), HasSubstr("expected .pts, .csv or .json"));
  EXPECT_THAT(test::message_of<IoError>([&] { read_landmarks(folder_ / "none.pts"); }),
              HasSubstr("none.pts"));
}

TEST_F(Landmarks, OfAJsonFileHaveTheTimesOfItsRate) {
  EXPECT_EQ(read("a.json", R"({"fps": 25, "frames": [{"points": [[1, 2]]}, {"points": [[1, 3]]}]})")
                .times,
            Eigen::Vector2d(0, 0.04));
  EXPECT_EQ(read("a.json", R"({"fps": 10, "frames": [{"frame": 7, "points": [[1, 2]]},
                                                     {"frame": 9, "points": [[1, 3]]}]})")
                .times,
            Eigen::Vector2d(0, 0.2));
  EXPECT_THAT(message("a.json", R"({"fps": 0, "frames": [{"points": [[1, 2]]}]})"),
              HasSubstr("/fps: expected more than 0"));
}

TEST_F(Landmarks, NameFramesThatAreMissingWhereThereAreNoTimes) {
  const auto expect_gap = [](const LandmarkTrack& track) {
    EXPECT_EQ(track.frames(), 3);
    EXPECT_EQ(track.times.size(), 0);
    EXPECT_EQ(track.step, 2);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("no row has these frames: 5")));
  };
  expect_gap(read("a.csv", "frame,x0,y0\n1,0,10\n3,0,10\n7,0,10\n"));
  for (const std::string key : {"frame", "frame_index"}) {
    std::string text;
    for (const char* number : {"1", "3", "7"}) {
      text +=
          (text.empty() ? "[" : ",") + ("{\"" + key) + "\": " + number + ", \"points\": [[1, 2]]}";
    }
    expect_gap(read("a.json", text + "]"));
  }
  EXPECT_THAT(read("a.csv", "frame,time,x0,y0\n1,0,0,10\n3,0.1,0,10\n7,0.3,0,10\n").notes,
              testing::IsEmpty());
  EXPECT_THAT(message("a.csv", "frame,x0,y0\n1,0,10\n1,0,10\n"),
              HasSubstr("line 3: frame 1 follows 1; expected one face and one row a frame"));
}

/// Frames of (1, 2), with these numbers by some keys, ten in a second.
std::string numbered_frames(const std::vector<std::string>& numbers) {
  std::string frames;
  for (const std::string& number : numbers) {
    frames += (frames.empty() ? "{" : ", {") + number + R"(, "points": [[1, 2]]})";
  }
  return R"({"fps": 10, "frames": [)" + frames + "]}";
}

TEST_F(Landmarks, OfAJsonFileTakeWholeNumbersOfFramesWithAPoint) {
  const LandmarkTrack track =
      read("a.json", numbered_frames({R"("frame": 1.0)", R"("frame": 3.0)"}));
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.2));
  EXPECT_THAT(track.notes, testing::IsEmpty());
}

TEST_F(Landmarks, OfAJsonFileTakeNumbersOfFramesByOneKey) {
  const LandmarkTrack track =
      read("a.json",
           numbered_frames({R"("frame_index": 0, "frame": 1)", R"("frame_index": 1, "frame": 3)"}));
  EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.2));
  const LandmarkTrack images =
      read("a.json", numbered_frames({R"("frame": "a.png", "frame_index": 5)",
                                      R"("frame": "b.png", "frame_index": 8)"}));
  EXPECT_EQ(images.times, Eigen::Vector2d(0, 0.3));
  EXPECT_THAT(images.notes, testing::IsEmpty());
}

TEST_F(Landmarks, SayWhereNumbersOfFramesAreNotUsed) {
  for (const char* second : {R"("frame": 3.5)", R"("frame": 1)", R"("frame": null)",
                             R"("frame": "b.png")", R"("frame": 1e300)", R"("other": 3)"}) {
    const LandmarkTrack track = read("a.json", numbered_frames({R"("frame": 1)", second}));
    EXPECT_EQ(track.times, Eigen::Vector2d(0, 0.1)) << second;
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("'frame' is not used"))) << second;
  }
  EXPECT_THAT(
      read("a.json", numbered_frames({R"("time": 0, "frame": 9)", R"("time": 1, "frame": 1)"}))
          .notes,
      testing::IsEmpty());
}

TEST_F(Landmarks, OfACsvTrackMayHaveNamesOfImagesForFrames) {
  for (const char* second : {"img_2.png", "2.png", "", "2.5", "1e300"}) {
    const LandmarkTrack track =
        read("a.csv", std::string("Frame,x0,y0\n1,5,6\n") + second + ",7,8\n4,9,10\n");
    EXPECT_EQ(track.points.col(0), Eigen::Vector3d(5, 7, 9)) << second;
    EXPECT_EQ(track.step, 1) << second;
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("'Frame' is not used"))) << second;
  }
  const LandmarkTrack commas = read("a.csv", "frame;x0;y0\n1,0;5;6\n3,0;7;8\n");
  EXPECT_EQ(commas.step, 2);
  EXPECT_THAT(commas.notes, testing::IsEmpty());
}

TEST_F(Landmarks, BeyondAnyImageAreRefused) {
  EXPECT_THAT(message("a.pts", "version: 1\nn_points: 2\n{\n1 1\n1e308 7\n}\n"),
              AllOf(StartsWith((folder_ / "a.pts").string()),
                    HasSubstr("frame 0: x of landmark '2' is 1e+308, expected a place")));
  EXPECT_THAT(message("a.csv", "x0,y0\n1,2\n1,-2e7\n"), HasSubstr("frame 1: y of landmark '1'"));
  EXPECT_THAT(message("a.json", R"([{"points": [[1, 2]]}, {"points": [[1, 1e308]]}])"),
              HasSubstr("frame 1: y of landmark '1'"));
  EXPECT_EQ(read("a.csv", "x0,y0\n1e6,-1e6\n").points, Eigen::RowVector2d(1e6, -1e6));
}

}  // namespace
}  // namespace mimetra
