#include <mimetra/fitting/face_images.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

#include <mimetra/fitting/image_codec.h>
#include <mimetra/fitting/landmark_formats.h>
#include <mimetra/io/frame_files.h>

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr Eigen::Index kLandmarks = 68;
constexpr const char* kTerms =
    "the 68-point model was trained on photographs for non-commercial use only (iBUG 300-W)";

bool is_image(const fs::path& path) {
  constexpr std::array kExtensions = {".png", ".jpg", ".jpeg"};
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

Eigen::Vector2d middle(const Face& face) {
  return {face.left + face.width / 2, face.top + face.height / 2};
}

/// How much better a face is than another: by its size, or by its distance from the last one.
double merit(const Face& face, const std::optional<Face>& last) {
  return last ? -(middle(face) - middle(*last)).squaredNorm() : face.width * face.height;
}

FaceFrame frame_of(const FacesInImage& image, const std::vector<Face>& confident,
                   const Face* chosen) {
  FaceFrame frame;
  frame.file = image.file;
  frame.faces = static_cast<int>(confident.size());
  if (chosen) {
    frame.outcome = FaceFrame::Outcome::found;
    frame.confidence = chosen->confidence;
  } else if (!image.faces.empty()) {
    frame.outcome = FaceFrame::Outcome::low_confidence;
    frame.confidence = std::ranges::max_element(image.faces, {}, &Face::confidence)->confidence;
  }
  return frame;
}

/// "3 of 120 images WHAT, the first is NAME", or nothing where none is counted.
template <typename Counted>
void add_note(std::vector<std::string>& notes, const std::vector<FaceFrame>& frames,
              const std::string& what, Counted is_counted) {
  const auto first = std::ranges::find_if(frames, is_counted);
  if (first == frames.end()) return;
  notes.push_back(std::to_string(std::ranges::count_if(frames, is_counted)) + " of " +
                  std::to_string(frames.size()) + " images " + what + ", the first is " +
                  first->file.filename().string());
}

std::vector<std::string> notes_on(const std::vector<FaceFrame>& frames) {
  using Outcome = FaceFrame::Outcome;
  std::vector<std::string> notes;
  add_note(notes, frames, "show no face that was found",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::no_face; });
  add_note(notes, frames, "show only faces of too low confidence",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::low_confidence; });
  add_note(notes, frames,
           "show several faces (the largest is taken, then the nearest to the last one)",
           [](const FaceFrame& frame) { return frame.faces > 1; });
  return notes;
}

/// Throws IoError where no frame shows a face.
void check_some_face(const FaceTrack& track) {
  const auto is_found = [](const FaceFrame& frame) {
    return frame.outcome == FaceFrame::Outcome::found;
  };
  if (std::ranges::any_of(track.frames, is_found)) return;
  const std::size_t others = track.frames.size() - 1;
  throw IoError(
      track.frames.front().file.string(),
      "shows no face that the detector is sure of" +
          (others == 0 ? std::string() : ", nor does any of the other " + std::to_string(others)) +
          "; a face must look towards the camera and be at least 80 pixels wide");
}

}  // namespace

FaceTrack follow_face(const std::vector<FacesInImage>& frames, double min_confidence) {
  if (!(min_confidence >= 0 && min_confidence <= 1)) {
    throw std::invalid_argument("min_confidence must be in [0, 1]");
  }
  const auto count = static_cast<Eigen::Index>(frames.size());
  FaceTrack track;
  track.landmarks.names = numbered_names(kLandmarks);
  track.landmarks.points.setConstant(count, 2 * kLandmarks,
                                     std::numeric_limits<double>::quiet_NaN());
  track.landmarks.confidence.setZero(count);
  std::optional<Face> last;
  for (Eigen::Index f = 0; f < count; ++f) {
    const FacesInImage& image = frames[static_cast<std::size_t>(f)];
    std::vector<Face> confident;
    std::ranges::copy_if(image.faces, std::back_inserter(confident),
                         [&](const Face& face) { return face.confidence >= min_confidence; });
    const auto chosen = std::ranges::max_element(
        confident, {}, [&](const Face& face) { return merit(face, last); });
    const bool found = chosen != confident.end();
    track.frames.push_back(frame_of(image, confident, found ? &*chosen : nullptr));
    if (!found) continue;
    track.landmarks.points.row(f) = chosen->landmarks.reshaped<Eigen::RowMajor>().transpose();
    track.landmarks.confidence[f] = chosen->confidence;
    last = *chosen;
  }
  track.notes = notes_on(track.frames);
  return track;
}

FaceTrack track_face(const std::vector<fs::path>& images, const FaceOptions& options,
                     const Progress& progress) {
  if (images.empty()) throw std::invalid_argument("there are no images");
  require_dlib(images.front().string());
  const FaceFinder finder(options.model);
  std::vector<FacesInImage> frames;
  for (const fs::path& file : images) {
    report_progress(progress, double(frames.size()) / double(images.size()));
    frames.push_back({file, finder.faces(read_image(file))});
  }
  report_progress(progress, 1);
  FaceTrack track = follow_face(frames, options.min_confidence);
  check_some_face(track);
  if (options.model == FaceOptions{}.model) track.notes.insert(track.notes.begin(), kTerms);
  return track;
}

std::vector<fs::path> image_files(const std::string& text) {
  std::error_code missing;
  const bool is_folder = fs::is_directory(text, missing);
  if (!is_folder && fs::exists(text, missing)) return {text};
  if (!is_folder && !is_frame_pattern(text)) throw IoError(text, "no such file or folder");
  std::vector<fs::path> files = files_named(text);
  std::erase_if(files, std::not_fn(is_image));
  if (files.empty()) {
    throw IoError(text, std::string(is_folder ? "holds" : "matches") + " no PNG or JPEG file");
  }
  return files;
}

}  // namespace mimetra
