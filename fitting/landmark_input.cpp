#include <mimetra/fitting/landmark_input.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <iterator>

#include <mimetra/fitting/landmark_track.h>
#include <mimetra/io/frame_files.h>
#include <mimetra/mesh/errors.h>

namespace mimetra {

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool is_points(const fs::path& path) {
  return lower_extension(path) == ".pts";
}

bool is_image(const fs::path& path) {
  constexpr std::array kExtensions = {".png", ".jpg", ".jpeg"};
  return std::ranges::find(kExtensions, lower_extension(path)) != kExtensions.end();
}

/// The rows of a track that were asked for.
LandmarkTrack part_of(LandmarkTrack track, const std::vector<int>& frames) {
  track.points = Frames(track.points(frames, Eigen::all));
  if (track.times.size() > 0) track.times = Eigen::VectorXd(track.times(frames));
  if (track.confidence.size() > 0) track.confidence = Eigen::VectorXd(track.confidence(frames));
  return track;
}

/// Frames keep the time they have in the whole clip, whichever part is taken.
void set_times(LandmarkTrack& track, const std::vector<int>& frames, const SequenceSource& source) {
  if (track.times.size() > 0) return;
  track.times.resize(track.frames());
  for (int f = 0; f < track.frames(); ++f) {
    track.times[f] =
        frames[static_cast<std::size_t>(f)] / source.fps.value_or(kDefaultFramesPerSecond);
  }
}

/// One frame from each file.
LandmarkTrack read_frames(const Paths& files, const Progress& progress) {
  LandmarkTrack all;
  for (std::size_t i = 0; i < files.size(); ++i) {
    LandmarkTrack one = read_landmarks(files[i]);
    if (i == 0) {
      all.names = one.names;
      all.points.resize(static_cast<Eigen::Index>(files.size()), one.points.cols());
    } else if (one.landmarks() != all.landmarks()) {
      throw MismatchError(files[i].string() + ": " + std::to_string(one.landmarks()) +
                          " landmarks, expected " + std::to_string(all.landmarks()) + " as in " +
                          files[0].string());
    }
    all.points.row(static_cast<Eigen::Index>(i)) = one.points.row(0);
    report_progress(progress, static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  return all;
}

LandmarksRead read_points(Paths files, const SequenceSource& source) {
  const std::vector<int> selected = selected_frames(source.frames, static_cast<int>(files.size()));
  LandmarksRead read;
  for (const int frame : selected) read.files.push_back(files[static_cast<std::size_t>(frame)]);
  read.track = read_frames(read.files, source.progress);
  set_times(read.track, selected, source);
  return read;
}

LandmarksRead read_track(const fs::path& file, const SequenceSource& source) {
  LandmarkTrack whole = read_landmarks(file);
  const std::vector<int> selected = selected_frames(source.frames, whole.frames());
  LandmarksRead read{part_of(std::move(whole), selected), {file}, {}};
  set_times(read.track, selected, source);
  report_progress(source.progress, 1);
  return read;
}

/// Where images become landmarks.
LandmarksRead read_images(const Paths& images) {
  throw IoError(images.front().string(),
                "is an image, and this mimetra was built without a detector of landmarks; it needs "
                "dlib (packages libdlib-dev, libdlib-data); or give landmarks as .pts, .csv or "
                ".json");
}

}  // namespace

LandmarksRead read_landmark_input(const std::string& text, const SequenceSource& source) {
  std::error_code unreadable;
  const bool is_folder = fs::is_directory(text, unreadable);
  if (!is_folder && (fs::exists(text, unreadable) || !is_frame_pattern(text))) {
    if (!fs::exists(text, unreadable)) throw IoError(text, "no such file or folder");
    return is_image(text) ? read_images({text}) : read_track(text, source);
  }
  Paths files = files_named(text), images;
  std::ranges::copy_if(files, std::back_inserter(images), is_image);
  std::erase_if(files, std::not_fn(is_points));
  if (!files.empty()) return read_points(std::move(files), source);
  if (!images.empty()) return read_images(images);
  throw IoError(text, std::string(is_folder ? "holds" : "matches") + " no .pts file and no image");
}

}  // namespace mimetra
