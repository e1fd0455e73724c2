#include "fitting/face_images.h"

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "fitting/face_finder.h"
#include "fitting/followed_face.h"
#include "fitting/landmark_formats.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTerms =
    "the 68-point model was trained on photographs for non-commercial use only (iBUG 300-W)";

FaceBox box_of(const Face& face) {
  const Eigen::Array2d size(face.width, face.height);
  return {Eigen::Array2d(face.left, face.top) + size / 2, size};
}

FaceFrame frame_of(const FacesInImage& image, const std::vector<Face>& confident,
                   const Face* chosen, double min_confidence) {
  FaceFrame frame;
  frame.image = image.image;
  frame.faces = static_cast<int>(confident.size());
  if (chosen) {
    frame.outcome = FaceFrame::Outcome::found;
    frame.confidence = chosen->confidence;
    if (frame.faces > 1) frame.note = "one of " + std::to_string(frame.faces) + " faces";
  } else if (image.faces.empty()) {
    frame.note = "no face found";
  } else {
    frame.confidence = std::ranges::max_element(image.faces, {}, &Face::confidence)->confidence;
    const bool trusted = frame.faces > 0;
    frame.outcome = trusted ? FaceFrame::Outcome::other_face : FaceFrame::Outcome::low_confidence;
    frame.note = trusted ? "only faces of others than the one that is followed"
                         : low_confidence_note(frame.confidence, min_confidence);
  }
  return frame;
}

/// Adds "3 of 120 images WHAT, the first is NAME", or nothing if the count is 0.
template <typename Counted>
void add_note(std::vector<std::string>& notes, const std::vector<FaceFrame>& frames,
              const std::string& what, Counted is_counted) {
  const auto first = std::ranges::find_if(frames, is_counted);
  if (first == frames.end()) return;
  notes.push_back(std::to_string(std::ranges::count_if(frames, is_counted)) + " of " +
                  std::to_string(frames.size()) + " images " + what + ", the first is " +
                  fs::path(first->image).filename().string());
}

std::vector<std::string> notes_on(const std::vector<FaceFrame>& frames) {
  using Outcome = FaceFrame::Outcome;
  std::vector<std::string> notes;
  add_note(notes, frames, "show no face that was found",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::no_face; });
  add_note(notes, frames, "show only faces of too low confidence",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::low_confidence; });
  add_note(notes, frames,
           "show several faces (the largest of the first frame with a face is followed)",
           [](const FaceFrame& frame) { return frame.faces > 1; });
  add_note(notes, frames, "show only faces of others than the one that is followed",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::other_face; });
  add_note(notes, frames,
           "show the face that is followed elsewhere than before (is it the same person's?)",
           [](const FaceFrame& frame) { return frame.jumps; });
  return notes;
}

std::vector<FacesInImage> faces_of_images(const ImageSequence& images, const FaceFinder& finder,
                                          const Context& context) {
  std::vector<FacesInImage> frames(static_cast<std::size_t>(images.frames()));
  const auto look_at = [&](int i) {
    frames[static_cast<std::size_t>(i)] = {images.name(i), finder.faces(images.image(i))};
  };
  parallel_for(images.frames(), look_at, context);
  return frames;
}

/// Throws IoError if no frame shows a face.
void check_some_face(const FaceTrack& track) {
  const auto is_found = [](const FaceFrame& frame) {
    return frame.outcome == FaceFrame::Outcome::found;
  };
  if (std::ranges::any_of(track.frames, is_found)) return;
  const std::size_t others = track.frames.size() - 1;
  throw IoError(
      track.frames.front().image,
      "shows no face that the detector is sure of" +
          (others == 0 ? std::string() : ", nor does any of the other " + std::to_string(others)) +
          "; a face must look towards the camera and be at least 80 pixels wide");
}

/// Frames from one full search to the next: a second of most videos. Frames of a chunk do not
/// depend on earlier chunks, so chunks are searched in parallel.
constexpr int kChunkFrames = 30;

/// Memory limit for waiting frames. One frame for each thread may always wait.
constexpr std::size_t kWaitingBytes = std::size_t{256} << 20;

/// Passes frames, which are read in order, to the threads that search chunks of them.
class WaitingFrames {
 public:
  explicit WaitingFrames(int threads) : least_(static_cast<std::size_t>(threads)) {}

  /// Waits for room.
  void put(int frame, Image image) {
    std::unique_lock lock(mutex_);
    const std::size_t bytes = sizeof(Color) * image.pixels.size();
    changed_.wait(lock, [&] {
      return is_stopped_ || frames_.size() <= least_ ||
             (frames_.size() + 1) * bytes <= kWaitingBytes;
    });
    frames_.emplace(frame, std::move(image));
    changed_.notify_all();
  }
  /// Waits for the frame; empty after stop().
  std::optional<Image> take(int frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_stopped_ || frames_.contains(frame); });
    if (is_stopped_) return std::nullopt;
    Image image = std::move(frames_.extract(frame).mapped());
    changed_.notify_all();
    return image;
  }
  /// Ends all waiting.
  void stop() {
    const std::scoped_lock lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }
  /// Lowest chunk that no thread has begun.
  int next_chunk() {
    const std::scoped_lock lock(mutex_);
    return chunk_++;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, Image> frames_;
  std::size_t least_;
  int chunk_ = 0;
  bool is_stopped_ = false;
};

/// Searches the frames of a chunk in order.
class ChunkSearch {
 public:
  ChunkSearch(const FaceFinder& finder, double min_confidence)
      : finder_(finder), min_confidence_(min_confidence) {}

  std::vector<Face> faces(const Image& image) {
    std::vector<Face> found;
    if (!last_.empty()) found = finder_.faces_near(image, last_);
    std::vector<Face> trusted = trusted_of(found);
    if (last_.empty() || trusted.size() < last_.size()) {
      found = finder_.faces(image);
      trusted = trusted_of(found);
    }
    last_ = std::move(trusted);
    return found;
  }

 private:
  std::vector<Face> trusted_of(std::vector<Face> faces) const {
    std::erase_if(faces, [this](const Face& face) { return face.confidence < min_confidence_; });
    return faces;
  }

  const FaceFinder& finder_;
  double min_confidence_;
  std::vector<Face> last_;
};

/// Searches all frames on the calling thread.
void search_here(const ImageSequence& images, const FaceFinder& finder, double min_confidence,
                 std::vector<FacesInImage>& found, const Context& context) {
  std::optional<ChunkSearch> search;
  for (int frame = 0; frame < images.frames(); ++frame) {
    if (frame % kChunkFrames == 0) search.emplace(finder, min_confidence);
    found[static_cast<std::size_t>(frame)].faces = search->faces(images.image(frame));
    context.report(double(frame + 1) / images.frames());
  }
}

/// Threads that search chunks until none is left.
class Searchers {
 public:
  Searchers(int count, int threads, const FaceFinder& finder, double min_confidence,
            std::vector<FacesInImage>& found)
      : waiting(threads), failures_(static_cast<std::size_t>(threads)) {
    for (std::exception_ptr& failure : failures_) {
      threads_.emplace_back([this, count, &finder, min_confidence, &found, &failure] {
        try {
          while (search_chunk(waiting.next_chunk(), count, finder, min_confidence, found)) continue;
        } catch (...) {
          failure = std::current_exception();
          waiting.stop();
        }
      });
    }
  }
  ~Searchers() { waiting.stop(); }  // before the threads are joined
  Searchers(const Searchers&) = delete;
  Searchers& operator=(const Searchers&) = delete;

  /// Waits until all chunks are searched. Throws what a search threw.
  void finish() {
    for (std::jthread& thread : threads_) thread.join();
    for (const std::exception_ptr& failure : failures_) {
      if (failure) std::rethrow_exception(failure);
    }
  }

  WaitingFrames waiting;

 private:
  /// Returns false if there is no such chunk or the search was stopped.
  bool search_chunk(int chunk, int count, const FaceFinder& finder, double min_confidence,
                    std::vector<FacesInImage>& found) {
    const long long first = static_cast<long long>(chunk) * kChunkFrames;
    const int end = static_cast<int>(std::min<long long>(first + kChunkFrames, count));
    ChunkSearch search(finder, min_confidence);
    for (int frame = static_cast<int>(std::min<long long>(first, count)); frame < end; ++frame) {
      const std::optional<Image> image = waiting.take(frame);
      if (!image) return false;
      found[static_cast<std::size_t>(frame)].faces = search.faces(*image);
    }
    return first < count;
  }

  std::vector<std::exception_ptr> failures_;
  std::vector<std::jthread> threads_;
};

/// Finds the faces in each frame of a recording. One thread reads the frames in order. The others
/// search near the previous frame's faces, or everywhere at the start of a chunk and if fewer faces
/// are found than before. Throws as ImageSequence::image; Cancelled.
std::vector<FacesInImage> faces_of_recording(const ImageSequence& images, const FaceFinder& finder,
                                             double min_confidence, const Context& context) {
  const int count = images.frames(), chunks = (count + kChunkFrames - 1) / kChunkFrames;
  std::vector<FacesInImage> found(static_cast<std::size_t>(count));
  for (int frame = 0; frame < count; ++frame) {
    found[static_cast<std::size_t>(frame)].image = images.name(frame);
  }
  const int threads = std::min(context.thread_count(), chunks);
  if (threads == 1) {
    search_here(images, finder, min_confidence, found, context);
    return found;
  }
  Searchers searchers(count, threads, finder, min_confidence, found);
  for (int frame = 0; frame < count; ++frame) {
    searchers.waiting.put(frame, images.image(frame));
    context.report(double(frame + 1) / count);
  }
  searchers.finish();
  return found;
}

}  // namespace

FaceTrack follow_face(const std::vector<FacesInImage>& frames, double min_confidence) {
  check_options(FaceOptions{.min_confidence = min_confidence});
  const auto count = static_cast<Eigen::Index>(frames.size());
  FaceTrack track;
  track.landmarks.names = numbered_names(kFaceLandmarks);
  track.landmarks.points.setConstant(count, 2 * kFaceLandmarks, kUnseen);
  track.landmarks.confidence.setZero(count);
  std::vector<std::vector<Face>> confident;
  std::vector<std::vector<FaceBox>> boxes;
  for (const FacesInImage& image : frames) {
    auto& faces = confident.emplace_back();
    std::ranges::copy_if(image.faces, std::back_inserter(faces),
                         [&](const Face& face) { return face.confidence >= min_confidence; });
    std::ranges::transform(faces, std::back_inserter(boxes.emplace_back()), box_of);
  }
  const FollowedFace followed = followed_face(boxes);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const int index = followed.chosen[f];
    const Face* chosen = index < 0 ? nullptr : &confident[f][static_cast<std::size_t>(index)];
    track.frames.push_back(frame_of(frames[f], confident[f], chosen, min_confidence));
    if (!chosen) continue;
    const auto row = static_cast<Eigen::Index>(f);
    track.landmarks.points.row(row) = chosen->landmarks.reshaped<Eigen::RowMajor>().transpose();
    track.landmarks.confidence[row] = chosen->confidence;
  }
  for (const int jump : followed.jumps) {
    FaceFrame& frame = track.frames[static_cast<std::size_t>(jump)];
    frame.jumps = true;
    if (frame.note.empty()) frame.note = "the face is elsewhere than before";
  }
  track.notes = notes_on(track.frames);
  return track;
}

std::string low_confidence_note(double confidence, double min_confidence) {
  std::ostringstream text;
  text.precision(2);
  text << "confidence " << confidence << " is below " << min_confidence;
  return text.str();
}

FaceTrack track_face(const ImageSequence& images, const FaceOptions& options,
                     const Context& context) {
  check_options(options);
  if (images.frames() == 0) throw std::invalid_argument("there are no images");
  require_dlib(images.name(0));
  const fs::path model = options.model.value_or(kDebianFaceModel);
  const FaceFinder finder(model);
  const std::vector<FacesInImage> found =
      images.is_recording() ? faces_of_recording(images, finder, options.min_confidence, context)
                            : faces_of_images(images, finder, context);
  FaceTrack track = follow_face(found, options.min_confidence);
  check_some_face(track);
  if (model == kDebianFaceModel) track.notes.insert(track.notes.begin(), kTerms);
  return track;
}

namespace {

/// Loads the model, a hundred megabytes, only for drawings of heads.
class FinderOnDemand {
 public:
  explicit FinderOnDemand(std::filesystem::path model) : model_(std::move(model)) {}

  const FaceFinder& get() {
    const std::lock_guard lock(mutex_);
    if (!finder_) finder_.emplace(model_);
    return *finder_;
  }

 private:
  std::filesystem::path model_;
  std::mutex mutex_;
  std::optional<FaceFinder> finder_;
};

Image colored(const GreyImage& grey) {
  Image image(grey.width, grey.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {grey.pixels[i], grey.pixels[i], grey.pixels[i]};
  }
  return image;
}

}  // namespace

LandmarkFinder landmarks_of_drawings(const std::filesystem::path& model) {
  const auto finder = std::make_shared<FinderOnDemand>(model);
  return [finder](const GreyImage& drawing) -> std::optional<FoundFace> {
    const std::vector<Face> faces = finder->get().faces(colored(drawing));
    if (faces.empty()) return {};
    return FoundFace{faces.front().landmarks, faces.front().confidence};
  };
}

}  // namespace mimetra
