#include "tests/bench/video_bench.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "fitting/face_images.h"
#include "fitting/video_file.h"
#include "tests/fitting/drawn_head.h"
#include "tests/fitting/made_video.h"

namespace mimetra::bench {
namespace {

/// The frames of a video as if each were a photograph.
class Photographs final : public ImageSequence {
 public:
  explicit Photographs(const ImageSequence& video) : video_(video) {}

  int frames() const override { return video_.frames(); }
  Image image(int frame) const override { return video_.image(frame); }
  std::string name(int frame) const override { return video_.name(frame); }
  void check() const override {}

 private:
  const ImageSequence& video_;
};

void write_talking_head(const std::filesystem::path& path, int frames) {
  const WeightTrack track = samples::parametric_performance();
  std::vector<Image> images;
  for (int f = 0; f < frames; ++f) {
    const double phase = 0.1 * f;
    images.push_back(test::drawn_head(1920, 1080,
                                      {.x = 960 + 150 * std::sin(phase),
                                       .y = 540 + 60 * std::cos(1.3 * phase),
                                       .height = 650 + 100 * std::sin(0.7 * phase),
                                       .yaw = 12 * std::sin(0.5 * phase)},
                                      track.weights.row(f % track.weights.rows())));
  }
  test::write_video(path, images, test::even_times(frames));
}

std::string difference(const FaceTrack& near, const FaceTrack& everywhere) {
  double sum = 0, largest = 0;
  int count = 0;
  for (Eigen::Index f = 0; f < near.landmarks.points.rows(); ++f) {
    for (Eigen::Index i = 0; i < near.landmarks.points.cols(); i += 2) {
      const double distance = (near.landmarks.points.row(f).segment<2>(i) -
                               everywhere.landmarks.points.row(f).segment<2>(i))
                                  .norm();
      if (std::isnan(distance)) continue;
      sum += distance;
      largest = std::max(largest, distance);
      ++count;
    }
  }
  std::ostringstream text;
  text.precision(2);
  text << "the face near the last one: landmarks " << sum / count << " px on average, " << largest
       << " px at most from those of the whole frame";
  return text.str();
}

}  // namespace

std::vector<Row> video_rows(const std::filesystem::path& scratch, const Settings& settings) {
  if (!std::filesystem::exists(kDebianFaceModel)) return {};
  const std::filesystem::path path = scratch / "talking.mp4";
  const int frames = settings.quick ? 10 : 90;
  write_talking_head(path, frames);
  const VideoFile video(path);
  const Photographs photographs(video);
  const Size size{"1920 x 1080", frames};
  const auto row = [&](const std::string& what) -> Row {
    return {"fitting", "video, a frame, " + what, size, {}, {"frame", double(frames)}};
  };
  std::vector<Case> cases = {
      {row("decoded"), [&path] { VideoFile{path}; }},
      {row("as a picture"),
       [&video] {
         for (int f = 0; f < video.frames(); ++f) video.image(f);
       }},
      {row("face near the last one"), [&video] { track_face(video); }},
      {row("face in the whole frame"), [&photographs] { track_face(photographs); }}};
  cases[2].row.note = difference(track_face(video), track_face(photographs));
  return measured(cases, settings.quick);
}

}  // namespace mimetra::bench
