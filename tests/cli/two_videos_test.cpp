#include "tests/fitting/two_videos.h"

#include <gtest/gtest.h>

#include "samples/head/head.h"
#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

class TwoVideos : public test::QuickCommandTest {
 protected:
  std::string csv_of(const Frames& points, const Eigen::VectorXd& times) const {
    std::ostringstream text;
    text.precision(17);
    text << "time";
    for (int i = 0; i < points.cols() / 2; ++i) text << ",x" << i << ",y" << i;
    for (Eigen::Index f = 0; f < points.rows(); ++f) {
      text << '\n' << times[f];
      for (const double value : points.row(f)) text << ',' << value;
    }
    return text.str() + '\n';
  }
};

TEST_F(TwoVideos, BecomeTheSourcesExpressionsOnTheTargetsFaceInThreeCommands) {
  const WeightTrack track = samples::parametric_performance();
  const MorphableModel head = samples::parametric_head();
  const test::TwoVideos videos = test::two_videos(
      head, test::vertices_of_landmarks(), track.weights.topRows(60), track.times.head(60), 2);
  write_model(folder_ / "model", head);
  std::string mapping;
  for (const int vertex : videos.vertices) mapping += std::to_string(vertex) + '\n';
  write("model/landmarks68.txt", mapping);
  write("source.csv", csv_of(videos.source, videos.times));
  write("target.csv", csv_of(videos.target, videos.times));

  for (const std::string line :
       {"fit source.csv --model model -o source.npy", "fit target.csv --model model -o target.npy",
        "transfer model@source.fit.json model@target.fit.json -k 10 -o out.npy"}) {
    const auto result = run(line);
    ASSERT_EQ(result.code, 0) << line << '\n' << result.err;
  }
  const SequenceRead result = read_sequence((folder_ / "out.npy").string());
  const test::SequenceDistance error = test::distance_between(result.sequence, videos.truth());
  // As in the library's test of this case.
  const double pixel = videos.truth().diameter() / test::kFacePixels;
  EXPECT_LT(error.expression, pixel);
  EXPECT_LT(error.face, 2 * pixel);

  // The written sequence is as good a source as its coefficients: it knows its rest pose.
  ASSERT_EQ(run("transfer source.npy model@target.fit.json -k 10 -o again.npy").code, 0);
  const SequenceRead again = read_sequence((folder_ / "again.npy").string());
  EXPECT_LT(test::distance_between(again.sequence, result.sequence).face, 1e-6 * pixel);
}

}  // namespace
}  // namespace mimetra
