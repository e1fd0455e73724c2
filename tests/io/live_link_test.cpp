#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/live_link.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two expressions over `frames` frames, `rate` a second, from `start` on.
WeightTrack live_track(int frames, double rate, double start = 0) {
  WeightTrack track{{"jawOpen", "mouthSmile_L"}, Eigen::MatrixXd(frames, 2), {}};
  track.times.resize(frames);
  for (int f = 0; f < frames; ++f) {
    track.times[f] = start + f / rate;
    track.weights.row(f) << 1.0 / (f + 3), 0.1 * f;
  }
  return track;
}

class LiveLink : public testing::Test {
 protected:
  WeightTrack read(const std::string& text) const {
    std::ofstream(folder_ / "w.csv", std::ios::binary) << text;
    return read_weights(folder_ / "w.csv");
  }
  test::TemporaryFolder folder_;
};

TEST_F(LiveLink, HasItsColumnsInOrder) {
  const std::string text = live_link_csv(live_track(2, 60)).text;
  EXPECT_TRUE(text.starts_with("Timecode,BlendShapeCount,EyeBlinkLeft,EyeLookDownLeft,")) << text;
  const std::string header = text.substr(0, text.find('\n'));
  EXPECT_TRUE(
      header.ends_with(",TongueOut,HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw,LeftEyePitch,"
                       "LeftEyeRoll,RightEyeYaw,RightEyePitch,RightEyeRoll"))
      << header;
  EXPECT_EQ(std::ranges::count(header, ','), 62);
  EXPECT_THAT(text, HasSubstr("\n00:00:00:00.000,61,"));
  EXPECT_THAT(text, HasSubstr("\n00:00:00:01.000,61,"));
}

TEST_F(LiveLink, IsReadBackAsItWas) {
  for (const double rate : {24.0, 25.0, 29.97, 30.0, 59.94, 60.0, 12.0}) {
    const WeightTrack track = live_track(150, rate);
    const LiveLinkText made = live_link_csv(track);
    EXPECT_THAT(made.notes, IsEmpty()) << rate;
    const WeightTrack found = read(made.text);
    EXPECT_EQ(weights_for(found, track.names), track.weights) << rate;
    // Timecodes hold thousandths of a frame.
    EXPECT_LE((found.times - track.times).cwiseAbs().maxCoeff(), 1.1e-3 / rate) << rate;
  }
}

TEST_F(LiveLink, HoldsItsNamesAsTheyAre) {
  WeightTrack track;
  track.names = live_link_names();
  track.weights = Eigen::MatrixXd::Random(3, 52);
  const WeightTrack found = read(live_link_csv(track).text);
  EXPECT_EQ(weights_for(found, track.names), track.weights);
  EXPECT_EQ(found.names.size(), 61u);
  EXPECT_TRUE(found.weights.rightCols(9).isZero(0));
}

TEST_F(LiveLink, SaysWhatItDoesNotHold) {
  WeightTrack track = live_track(3, 30, 2);
  track.names[0] = "anger";
  EXPECT_THAT(live_link_csv(track).notes,
              ElementsAre(HasSubstr("not ARKit's are left out: anger"),
                          HasSubstr("the weights begin at 2 s"),
                          HasSubstr("no second ends among its timecodes")));
  track = live_track(90, 30);
  track.times.resize(0);
  EXPECT_THAT(live_link_csv(track).notes, ElementsAre(HasSubstr("no times; their timecodes")));
  track = live_track(90, 30);
  track.times[40] += 0.004;
  EXPECT_THAT(live_link_csv(track).notes, IsEmpty());
  track = live_track(5, 0.25);
  EXPECT_THAT(live_link_csv(track).notes, Contains(HasSubstr("rate")));
}

TEST_F(LiveLink, TakesTheMeanOfHalves) {
  WeightTrack track{{"browInnerUp_L", "browInnerUp_R"}, Eigen::MatrixXd(1, 2), {}};
  track.weights << 0.25, 0.75;
  const LiveLinkText made = live_link_csv(track);
  EXPECT_THAT(made.notes, Contains(HasSubstr("the mean of several expressions: BrowInnerUp")));
  EXPECT_EQ(weights_for(read(made.text), {"browInnerUp"})(0, 0), 0.5);
}

TEST_F(LiveLink, RefusesWhatItCannotHold) {
  WeightTrack track = live_track(2, 30);
  track.names = {"anger", "fear"};
  EXPECT_FALSE(has_live_link_names(track.names));
  EXPECT_THAT(test::message_of<MismatchError>([&] { live_link_csv(track); }),
              HasSubstr("none of the expressions is one of ARKit's"));
  track = live_track(90, 30);
  EXPECT_TRUE(has_live_link_names(track.names));
  track.times[41] = track.times[40] + 1e-9;
  EXPECT_THAT(test::message_of<MismatchError>([&] { live_link_csv(track); }),
              HasSubstr("frames 40 and 41 are at the same timecode"));
}

}  // namespace
}  // namespace mimetra
