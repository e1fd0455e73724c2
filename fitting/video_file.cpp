#include "fitting/video_file.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "fitting/video_codec.h"
#include "toolkit/io/format.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/parallel.h"
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

/// One decoder and its latest images: drawing threads ask for frames slightly out of order.
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
  int next = 0;              ///< next frame of the decoder
  std::deque<Image> recent;  ///< frames before `next`
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

namespace {

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

/// \pre There is a picture.
VideoLayout layout_of(const Pictures& pictures, const Eigen::VectorXd& times, const Image& first,
                      const std::filesystem::path& target) {
  const Eigen::Index last = times.size() - 1;
  const double step =
      last > 0 ? (times[last] - times[0]) / double(last) : 1 / kDefaultFramesPerSecond;
  return {.extension = lower_extension(target),
          .width = first.width,
          .height = first.height,
          .fps = 1 / step,
          .first_time = times[0],
          .end_time = times[last] + step,
          .sound = pictures.sound};
}

/// Draws batches of pictures on all threads and encodes them in order.
void write_frames(const Pictures& pictures, const std::filesystem::path& target,
                  const std::filesystem::path& file, const Context& context) {
  const Eigen::VectorXd times =
      pictures.times.size() == pictures.count ? pictures.times : default_times(pictures.count);
  const int batch = context.thread_count();
  std::unique_ptr<VideoEncoder> encoder;
  Image size;
  for (int first = 0; first < pictures.count; first += batch) {
    const double done = double(first) / pictures.count;
    std::vector<Image> drawn(static_cast<std::size_t>(std::min(batch, pictures.count - first)));
    const auto draw = [&](int i) { drawn[static_cast<std::size_t>(i)] = pictures.draw(first + i); };
    parallel_for(static_cast<int>(drawn.size()), draw, context.part(done, done));
    for (int i = 0; i < static_cast<int>(drawn.size()); ++i) {
      const Image& image = drawn[static_cast<std::size_t>(i)];
      if (!encoder) {
        encoder = create_video(file, target, layout_of(pictures, times, image, target));
        size.width = image.width;
        size.height = image.height;
      }
      if (image.width != size.width || image.height != size.height) {
        throw MismatchError(target.string() + ": picture " + std::to_string(first + i) + " has " +
                            size_text(image) + " pixels, expected " + size_text(size) +
                            " as the first; write them to a folder");
      }
      encoder->add(image, times[first + i]);
    }
    context.report(double(first + static_cast<int>(drawn.size())) / pictures.count);
  }
  if (encoder) encoder->finish();
}

Format::Paths write_video(const Data& data, const std::filesystem::path& target,
                          const WriteOptions& options, const Context& context) {
  return write_with_extra(target, options, [&]() -> Format::Paths {
    PendingOutputs outputs(options.overwrite, options.inputs, options.together);
    write_frames(std::get<Pictures>(data), target, outputs.add(target, PendingOutput::Kind::file),
                 context);
    outputs.commit();
    return {target};
  });
}

}  // namespace

void add_video_format(OperationTable& table) {
  table.add(Format{.name = "video",
                   .kind = DataKind::pictures,
                   .extensions = {".mp4", ".mov", ".mkv"},
                   .write = write_video});
}

std::string lost_sound(const std::filesystem::path& target, const std::filesystem::path& video) {
  if (video.empty() || !is_video(target)) return {};
  if (can_keep_sound(video, lower_extension(target))) return {};
  return target.string() + ": is written without the sound of " + video.string() +
         ", which a file of this kind does not hold; .mkv holds more";
}

}  // namespace mimetra
