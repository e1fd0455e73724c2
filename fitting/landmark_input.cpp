#include "fitting/landmark_input.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>
#include <limits>

#include "fitting/image_files.h"
#include "fitting/landmark_file.h"
#include "fitting/landmark_formats.h"
#include "fitting/video_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_series.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

bool is_points(const fs::path& path) {
  return lower_extension(path) == ".pts";
}

/// Landmarks of a whole clip before frames are selected: one file a frame, or a track.
struct LandmarkFiles {
  Paths frames;  ///< .pts files or images
  fs::path track;
  Paths others;  ///< images beside the .pts files
};

LandmarkFiles input_of(const std::string& text) {
  std::error_code unreadable;
  const bool is_folder = fs::is_directory(text, unreadable);
  if (!is_folder && (fs::exists(text, unreadable) || !is_frame_pattern(text))) {
    if (!fs::exists(text, unreadable)) fail_missing(text);
    if (is_image(text) || is_points(text)) return {{text}, {}, {}};
    return {{}, text, {}};
  }
  Paths files = files_named(text), images;
  std::ranges::copy_if(files, std::back_inserter(images), is_image);
  std::erase_if(files, std::not_fn(is_points));
  if (files.empty() && images.empty()) {
    throw IoError(text,
                  std::string(is_folder ? "holds" : "matches") + " no .pts file and no image");
  }
  if (files.empty()) return {images, {}, {}};
  return {files, {}, images};
}

/// Image of the same name beside a file, the first of several; empty if there is none.
fs::path image_beside(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  fs::path found;
  std::error_code unreadable;
  for (const fs::path& other : fs::directory_iterator(folder, unreadable)) {
    if (other.stem() != file.stem() || !is_image(other)) continue;
    const fs::path image = file.parent_path() / other.filename();
    if (found.empty() || image < found) found = image;
  }
  return found;
}

/// Notes that images without .pts files are ignored.
void note_others(LandmarksRead& read, const std::string& text, const LandmarkFiles& input) {
  const auto has_points = [&](const fs::path& image) {
    return std::ranges::find(input.frames, image.stem(), &fs::path::stem) != input.frames.end();
  };
  const auto passed = std::ranges::count_if(input.others, std::not_fn(has_points));
  if (passed == 0) return;
  read.notes.push_back(text + ": " + std::to_string(passed) +
                       " images without a .pts file are not read, because there are .pts files; "
                       "name the images by a pattern to find faces in them");
}

/// Notes which numbers are missing among the files.
void note_missing(LandmarksRead& read, const std::string& text, const Paths& files) {
  const std::vector<std::string> missing = missing_numbers(files);
  if (missing.empty()) return;
  read.notes.push_back(text + ": no file has these numbers: " + listed(missing) +
                       "; frames follow each other without a pause");
}

/// Throws MismatchError if an option has no effect. `what` describes an input that shows faces, as
/// "is a video", and is empty for landmarks.
void check_needed(const std::string& text, const std::string& what,
                  const LandmarkInputOptions& options) {
  if (!what.empty() && options.images) {
    throw MismatchError("option 'images': " + text + " " + what);
  }
  if (!what.empty() && options.image_size) {
    throw MismatchError("option 'image-size': " + text + " " + what + ", whose size is known");
  }
  if (what.empty() && options.faces.model) {
    throw MismatchError("option 'face-model': " + text + " are landmarks already");
  }
}

/// Throws IoError if the video is damaged before frame `end`, or at all without `end`.
void check_whole(const std::string& text, const VideoFile& video, std::optional<int> end) {
  const std::string sound = std::to_string(video.frames());
  if (video.damage().empty() || (end && *end <= video.frames())) return;
  throw IoError(
      text, video.damage() + "; option 'frames' 0:" + sound + " takes the " + sound + " before it");
}

/// Images of the whole clip, or null, and their files.
struct ShownImages {
  std::shared_ptr<const ImageSequence> images;
  Paths files;
};

ShownImages images_named(const std::string& text, int count, const Context& context) {
  if (is_video(text) && fs::exists(text)) {
    auto video = std::make_shared<const VideoFile>(text, context);
    check_whole(text, *video, count);
    return {std::move(video), {text}};
  }
  Paths files = image_files(text);
  return {std::make_shared<const ImageFiles>(files), files};
}

ShownImages images_of(const std::string& text, const Paths& frames, int count,
                      const LandmarkInputOptions& options, const Context& context) {
  if (options.images) {
    ShownImages shown = images_named(*options.images, count, context);
    if (shown.images->frames() == count) return shown;
    throw MismatchError(*options.images + ": " + std::to_string(shown.images->frames()) +
                        " images, expected one for each of the " + std::to_string(count) +
                        " frames of " + text);
  }
  Paths images;
  std::ranges::transform(frames, std::back_inserter(images), image_beside);
  if (images.empty() || std::ranges::any_of(images, &fs::path::empty)) return {};
  return {std::make_shared<const ImageFiles>(images), images};
}

Paths taken_from(const Paths& all, const std::vector<int>& frames) {
  Paths part;
  if (all.empty()) return part;
  for (const int frame : frames) part.push_back(all[static_cast<std::size_t>(frame)]);
  return part;
}

LandmarkTrack taken_from(LandmarkTrack track, const std::vector<int>& frames) {
  track.points = Frames(track.points(frames, Eigen::all));
  if (track.times.size() > 0) track.times = Eigen::VectorXd(track.times(frames));
  if (track.confidence.size() > 0) track.confidence = Eigen::VectorXd(track.confidence(frames));
  return track;
}

/// Keeps the times that frames have in the whole clip.
void set_times(LandmarksRead& read, const std::string& text, const std::vector<int>& frames,
               const ReadOptions& options) {
  LandmarkTrack& track = read.track;
  check_rate(text, track.times, options.fps);
  if (track.times.size() > 0) {
    const std::string odd = options.frames ? "" : note_on_steps(track.times);
    if (!odd.empty()) read.notes.push_back(text + ": " + odd);
    return;
  }
  track.times_are_known = options.fps.has_value();
  track.times.resize(track.frames());
  for (int f = 0; f < track.frames(); ++f) {
    track.times[f] = frames[static_cast<std::size_t>(f)] * track.step /
                     options.fps.value_or(kDefaultFramesPerSecond);
  }
}

/// Reads one frame from each file.
LandmarkTrack read_points(const Paths& files, const Context& context) {
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
    context.report(static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  return all;
}

/// Replaces frames below the confidence with NaN.
void drop_doubtful(LandmarksRead& read, const std::string& text, double min_confidence) {
  const LandmarkTrack& track = read.track;
  int doubtful = 0;
  read.frame_notes.resize(static_cast<std::size_t>(track.frames()));
  for (Eigen::Index f = 0; f < track.confidence.size(); ++f) {
    if (track.confidence[f] >= min_confidence) continue;
    read.track.points.row(f).setConstant(kUnseen);
    read.frame_notes[static_cast<std::size_t>(f)] =
        low_confidence_note(track.confidence[f], min_confidence);
    ++doubtful;
  }
  if (doubtful > 0) {
    read.notes.push_back(text + ": " + std::to_string(doubtful) + " of " +
                         std::to_string(track.frames()) +
                         " frames have too low a confidence and are taken as not seen");
  }
}

/// Parses width and height, as "1920x1080".
std::pair<int, int> size_of(const std::string& text) {
  int width = 0, height = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool goes_on = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = goes_on ? std::from_chars(first.ptr + 1, end, height) : first;
  if (!goes_on || second.ec != std::errc() || second.ptr != end || width < 1 || height < 1) {
    throw UsageError("option 'image-size': '" + text + "', expected WIDTHxHEIGHT, as 1920x1080");
  }
  return {width, height};
}

/// Fewer landmarks are not a face: they have no inside, and their place says nothing.
constexpr int kFewForAFace = 5;

using Points = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>;

bool is_placeholder(const Eigen::RowVector2d& point) {
  return point == Eigen::RowVector2d(0, 0) || point == Eigen::RowVector2d(-1, -1);
}

/// Rows of landmarks (n x 2) that are placeholders.
std::vector<Eigen::Index> placeholders_of(const Points& points) {
  std::vector<Eigen::Index> found;
  Eigen::RowVector2d lowest = Eigen::RowVector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::RowVector2d highest = -lowest;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (is_placeholder(points.row(i))) {
      found.push_back(i);
    } else if (!points.row(i).hasNaN()) {
      lowest = lowest.cwiseMin(points.row(i));
      highest = highest.cwiseMax(points.row(i));
    }
  }
  std::erase_if(found, [&](Eigen::Index i) {
    const auto point = points.row(i).array();
    return (lowest.array() <= point).all() && (point <= highest.array()).all();
  });
  return found;
}

/// Replaces placeholders, landmarks at exactly (0, 0) or (-1, -1), with NaN. They must be outside
/// the box of the frame's other landmarks, or be the frame's only ones. Returns a note or "".
std::string drop_placeholders(LandmarkTrack& track) {
  if (track.landmarks() < kFewForAFace) return "";
  int frames = 0, partly = 0;
  for (Eigen::Index f = 0; f < track.points.rows(); ++f) {
    Points points(track.points.row(f).data(), track.landmarks(), 2);
    const bool was_seen = !points.array().isNaN().all();
    const std::vector<Eigen::Index> placeholders = placeholders_of(points);
    if (placeholders.empty()) continue;
    for (const Eigen::Index landmark : placeholders) {
      points.row(landmark).setConstant(kUnseen);
    }
    ++(was_seen && points.array().isNaN().all() ? frames : partly);
  }
  if (frames + partly == 0) return "";
  std::string text = std::to_string(frames + partly) + " of " + std::to_string(track.frames()) +
                     " frames have landmarks at (0, 0) or (-1, -1), outside of the face, which are "
                     "taken as not seen";
  if (frames > 0) text += "; " + std::to_string(frames) + " of them have no others";
  return text;
}

/// True if nine in ten landmarks are within 2 of the corner, which no face in pixels is.
bool are_shares(const LandmarkTrack& track) {
  constexpr double kMostShare = 2, kMostWrong = 0.1;
  Eigen::Index seen = 0, far = 0;
  for (Eigen::Index i = 0; i < track.points.size(); i += 2) {
    const Eigen::Map<const Eigen::Array2d> point(track.points.data() + i);
    if (point.isNaN().any()) continue;
    ++seen;
    if ((point.abs() > kMostShare).any()) ++far;
  }
  return track.landmarks() >= kFewForAFace && seen > 0 &&
         static_cast<double>(far) <= kMostWrong * static_cast<double>(seen);
}

/// Converts shares of the image's width and height, as MediaPipe counts, to pixels.
void scale_to_pixels(LandmarkTrack& track, int width, int height) {
  // 0 is the edge of the image in shares, and the middle of the first pixel in pixels.
  for (Eigen::Index column = 0; column < track.points.cols(); ++column) {
    const double size = column % 2 == 0 ? width : height;
    track.points.col(column) = track.points.col(column).array() * size - 0.5;
  }
}

void make_pixels(LandmarksRead& read, const std::string& text,
                 const std::optional<std::string>& size) {
  if (!are_shares(read.track)) {
    if (!size) return;
    throw MismatchError("option 'image-size': " + text + " has landmarks in pixels already");
  }
  if (size) {
    const auto [width, height] = size_of(*size);
    scale_to_pixels(read.track, width, height);
  } else if (read.images) {
    const Image image = read.images->image(0);
    scale_to_pixels(read.track, image.width, image.height);
  } else {
    throw MismatchError(text +
                        ": has landmarks in shares of the image's width and height, as MediaPipe "
                        "counts: at least nine in ten have no coordinate above 2; give its size "
                        "by option 'image-size' (1920x1080), or its images by option 'images'");
  }
}

LandmarksRead find_in_images(std::shared_ptr<const ImageSequence> images,
                             const FaceOptions& options, const Context& context) {
  FaceTrack faces = track_face(*images, options, context);
  LandmarksRead read;
  read.track = std::move(faces.landmarks);
  read.images = std::move(images);
  read.notes = std::move(faces.notes);
  for (FaceFrame& frame : faces.frames) read.frame_notes.push_back(std::move(frame.note));
  return read;
}

LandmarksRead find_in_video(const std::string& text, const ReadOptions& reading,
                            const FaceOptions& options, const Context& context) {
  constexpr double kShareOfOpening = 0.2;
  const auto video = std::make_shared<const VideoFile>(text, context.part(0, kShareOfOpening));
  check_rate(text, video->times(), reading.fps);
  check_whole(text, *video, end_of_frames(reading.frames));
  const std::vector<int> chosen = selected_frames(reading.frames, video->frames());
  LandmarksRead read =
      find_in_images(selected(video, chosen), options, context.part(kShareOfOpening, 1));
  read.track.times = video->times()(chosen);
  read.files = {text};
  return read;
}

}  // namespace

LandmarksRead read_landmark_input(const std::string& text, const ReadOptions& reading,
                                  const LandmarkInputOptions& options, const Context& context) {
  check_options(reading);
  check_options(options.faces);
  const LandmarkFiles input = input_of(text);
  if (is_video(input.track)) {
    check_needed(text, "is a video", options);
    return find_in_video(text, reading, options.faces, context);
  }
  LandmarkTrack whole;
  if (input.frames.empty()) whole = read_landmarks(input.track);
  const int count = input.frames.empty() ? whole.frames() : static_cast<int>(input.frames.size());
  const std::vector<int> selected = selected_frames(reading.frames, count);
  const Paths files = taken_from(input.frames, selected);
  LandmarksRead read;
  const bool from_images = !files.empty() && is_image(files.front());
  check_needed(text, from_images ? "are images themselves" : "", options);
  if (from_images) {
    read = find_in_images(std::make_shared<const ImageFiles>(files), options.faces, context);
    read.files = files;
  } else {
    constexpr double kShareOfPoints = 0.5;
    read.track = files.empty() ? taken_from(std::move(whole), selected)
                               : read_points(files, context.part(0, kShareOfPoints));
    read.files = files.empty() ? Paths{input.track} : files;
    const ShownImages shown =
        images_of(text, input.frames, count, options, context.part(kShareOfPoints, 1));
    if (shown.images) read.images = mimetra::selected(shown.images, selected);
    const bool of_frames = static_cast<int>(shown.files.size()) == count;
    const Paths shown_files = of_frames ? taken_from(shown.files, selected) : shown.files;
    read.files.insert(read.files.end(), shown_files.begin(), shown_files.end());
    if (const std::string dropped = drop_placeholders(read.track); !dropped.empty()) {
      read.notes.push_back(text + ": " + dropped);
    }
    make_pixels(read, text, options.image_size);
    drop_doubtful(read, text, options.faces.min_confidence);
    for (const std::string& note : read.track.notes) read.notes.push_back(text + ": " + note);
    note_others(read, text, input);
    if (!reading.frames) note_missing(read, text, input.frames);
  }
  if (const std::string note = note_on_digits(text); !files.empty() && !note.empty()) {
    read.notes.push_back(note);
  }
  set_times(read, text, selected, reading);
  context.report(1);
  return read;
}

}  // namespace mimetra
