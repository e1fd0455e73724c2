#include "fitting/video_format.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "fitting/video_codec.h"
#include "fitting/video_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/formats.h"

namespace mimetra {

namespace {

std::string size_text(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

/// \pre there is a picture
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

/// Draws some pictures at a time on all threads, and codes them in order.
void write_frames(const Pictures& pictures, const WriteRequest& request,
                  const std::filesystem::path& file, const Context& context) {
  const Eigen::VectorXd times =
      pictures.times.size() == pictures.count ? pictures.times : default_times(pictures.count);
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int batch = context.threads() > 0 ? context.threads() : all;
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
        encoder =
            create_video(file, request.target, layout_of(pictures, times, image, request.target));
        size.width = image.width;
        size.height = image.height;
      }
      if (image.width != size.width || image.height != size.height) {
        throw MismatchError(request.target.string() + ": picture " + std::to_string(first + i) +
                            " has " + size_text(image) + " pixels, expected " + size_text(size) +
                            " as the first; write them to a folder");
      }
      encoder->add(image, times[first + i]);
    }
    context.report(double(first + static_cast<int>(drawn.size())) / pictures.count);
  }
  if (encoder) encoder->finish();
}

std::vector<std::filesystem::path> write_video(const Data& data, const WriteRequest& request,
                                               const Context& context) {
  return write_with_extra(request, [&]() -> std::vector<std::filesystem::path> {
    PendingOutputs outputs(request.overwrite, request.inputs, request.together);
    write_frames(std::get<Pictures>(data), request,
                 outputs.add(request.target, PendingOutput::Kind::file), context);
    outputs.commit();
    return {request.target};
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
