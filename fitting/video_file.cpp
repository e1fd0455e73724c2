#include "fitting/video_file.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "fitting/video_codec.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace fs = std::filesystem;

std::vector<std::string> video_extensions() {
  return {".mp4", ".m4v",  ".mov", ".3gp",  ".mkv", ".webm", ".avi",
          ".mpg", ".mpeg", ".mts", ".m2ts", ".wmv", ".ogv"};
}

bool is_video(const fs::path& path) {
  const std::vector<std::string> known = video_extensions();
  return std::ranges::find(known, lower_extension(path)) != known.end();
}

/// One decoder, and the images that it came by last: threads that draw frame after frame ask for
/// them a little out of order.
struct VideoFile::State {
  explicit State(fs::path file) : path(std::move(file)) {}

  void index(const Context& context) {
    const std::unique_ptr<VideoDecoder> whole = open_video(path);
    std::vector<double> found;
    try {
      while (const std::optional<double> time = whole->next()) {
        found.push_back(*time);
        context.report(0);
      }
    } catch (const IoError& error) {
      if (found.empty()) throw;
      damage = std::string(error.what()).substr(path.string().size() + 2);  // after "PATH: "
    }
    if (found.empty()) throw IoError(path.string(), "is a video without a frame");
    times =
        Eigen::Map<const Eigen::VectorXd>(found.data(), static_cast<Eigen::Index>(found.size()));
  }

  const Image& decoded(int frame) {
    const std::size_t kept = std::max(4u, std::thread::hardware_concurrency());
    if (!decoder || frame < next - static_cast<int>(recent.size())) {
      decoder = open_video(path);
      recent.clear();
      next = 0;
    }
    for (; next <= frame; ++next) {
      if (!decoder->next())
        throw IoError(path.string(), "has fewer frames than before; was it changed?");
      if (next + static_cast<int>(kept) <= frame) continue;
      recent.push_back(decoder->image());
      if (recent.size() > kept) recent.pop_front();
    }
    return recent[recent.size() - static_cast<std::size_t>(next - frame)];
  }

  fs::path path;
  Eigen::VectorXd times;
  std::string damage;
  std::mutex mutex;
  std::unique_ptr<VideoDecoder> decoder;
  int next = 0;              ///< frame that the decoder comes to next
  std::deque<Image> recent;  ///< of the frames before it
};

VideoFile::VideoFile(fs::path path, const Context& context)
    : state_(std::make_unique<State>(std::move(path))) {
  state_->index(context);
}
VideoFile::~VideoFile() = default;

int VideoFile::frames() const {
  return static_cast<int>(state_->times.size());
}

const Eigen::VectorXd& VideoFile::times() const {
  return state_->times;
}

const std::string& VideoFile::damage() const {
  return state_->damage;
}

Image VideoFile::image(int frame) const {
  if (frame < 0 || frame >= frames()) {
    throw std::out_of_range(state_->path.string() + " has no frame " + std::to_string(frame));
  }
  const std::scoped_lock lock(state_->mutex);
  return state_->decoded(frame);
}

fs::path VideoFile::sound() const {
  return state_->path;
}

std::string VideoFile::name(int frame) const {
  return state_->path.string() + ", frame " + std::to_string(frame);
}

}  // namespace mimetra
