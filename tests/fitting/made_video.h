#pragma once

#include <filesystem>
#include <vector>

#include "fitting/video_codec.h"
#include "toolkit/io/image.h"

namespace mimetra::test {

/// Writes a video of one image for each time, in seconds.
inline void write_video(const std::filesystem::path& path, const std::vector<Image>& images,
                        const std::vector<double>& times, const std::filesystem::path& sound = {}) {
  const double last = times.back() + (times.size() > 1 ? times[1] - times[0] : 0.04);
  const auto encoder = create_video(path, path,
                                    {.extension = path.extension().string(),
                                     .width = images.front().width,
                                     .height = images.front().height,
                                     .fps = double(times.size()) / (last - times.front()),
                                     .first_time = times.front(),
                                     .end_time = last,
                                     .sound = sound});
  for (std::size_t i = 0; i < images.size(); ++i) encoder->add(images[i], times[i]);
  encoder->finish();
}

/// `count` times from 0 on.
inline std::vector<double> even_times(int count, double fps = 25) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) times.push_back(i / fps);
  return times;
}

}  // namespace mimetra::test
