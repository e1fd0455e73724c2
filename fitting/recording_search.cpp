#include "fitting/recording_search.h"

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace mimetra {

namespace {

/// Frames wait in this many bytes at most, but always one for each thread.
constexpr std::size_t kWaitingBytes = std::size_t{256} << 20;

/// Hands frames that were read in order to those who search chunks of them.
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
  /// Waits for the frame; none where it will not come.
  std::optional<Image> take(int frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_stopped_ || frames_.contains(frame); });
    if (is_stopped_) return std::nullopt;
    Image image = std::move(frames_.extract(frame).mapped());
    changed_.notify_all();
    return image;
  }
  /// Nobody waits any longer.
  void stop() {
    const std::scoped_lock lock(mutex_);
    is_stopped_ = true;
    changed_.notify_all();
  }
  /// The lowest chunk that nobody has begun.
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

/// Searches the frames of a chunk, one after the other.
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

/// All frames on the calling thread.
void search_here(const ImageSequence& images, const FaceFinder& finder, double min_confidence,
                 std::vector<FacesInImage>& found, const Context& context) {
  std::optional<ChunkSearch> search;
  for (int frame = 0; frame < images.frames(); ++frame) {
    if (frame % kChunkFrames == 0) search.emplace(finder, min_confidence);
    found[static_cast<std::size_t>(frame)].faces = search->faces(images.image(frame));
    context.report(double(frame + 1) / images.frames());
  }
}

/// Threads that search chunks until there are none left.
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
  ~Searchers() { waiting.stop(); }  // before the threads are waited for
  Searchers(const Searchers&) = delete;
  Searchers& operator=(const Searchers&) = delete;

  /// Waits until all is searched. Throws what a search threw.
  void finish() {
    for (std::jthread& thread : threads_) thread.join();
    for (const std::exception_ptr& failure : failures_) {
      if (failure) std::rethrow_exception(failure);
    }
  }

  WaitingFrames waiting;

 private:
  /// False where there is no such chunk, or the search was stopped.
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

}  // namespace

std::vector<FacesInImage> faces_of_recording(const ImageSequence& images, const FaceFinder& finder,
                                             double min_confidence, const Context& context) {
  const int count = images.frames(), chunks = (count + kChunkFrames - 1) / kChunkFrames;
  std::vector<FacesInImage> found(static_cast<std::size_t>(count));
  for (int frame = 0; frame < count; ++frame) {
    found[static_cast<std::size_t>(frame)].image = images.name(frame);
  }
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = std::min(context.threads() > 0 ? context.threads() : all, chunks);
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

}  // namespace mimetra
