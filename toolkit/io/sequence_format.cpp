#include "toolkit/io/sequence_format.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

void check_rate(const std::string& name, const Eigen::VectorXd& times,
                const SequenceSource& source) {
  if (!source.fps || times.size() == 0) return;
  throw std::invalid_argument(name + ": its " + std::to_string(times.size()) +
                              " frames have times of their own, " + readable(times[0]) + " to " +
                              readable(times[times.size() - 1]) +
                              " s, and option 'fps' is for what has none; leave it out");
}

void check_times(const std::string& name, const Eigen::VectorXd& times) {
  for (Eigen::Index frame = 0; frame < times.size(); ++frame) {
    if (std::isfinite(times[frame]) && (frame == 0 || times[frame] > times[frame - 1])) continue;
    throw IoError(name, "frame " + std::to_string(frame) + " is at " + readable(times[frame]) +
                            " s, expected times that rise");
  }
}

std::string note_on_steps(const Eigen::VectorXd& times) {
  constexpr double kLongest = 1;
  constexpr Eigen::Index kMany = 10;
  if (times.size() < 2) return "";
  const double step = median_difference(times);
  const bool are_whole =
      times.size() >= kMany && step >= kLongest && (times.array() == times.array().round()).all();
  if (!(step > kLongest) && !are_whole) return "";
  return "its frames are " + readable(step) +
         " s apart (median), as where times are milliseconds or numbers of frames; expected "
         "seconds";
}

// Each is defined in the file of its format.
SequenceFormat gltf_format(), mdd_format(), npy_format(), npz_format(), pc2_format(),
    splocs_format();
SequenceFormat mesh_format(MeshFormat format);

const std::vector<SequenceFormat>& sequence_formats() {
  static const std::vector<SequenceFormat> formats = {npy_format(),
                                                      npz_format(),
                                                      pc2_format(),
                                                      mdd_format(),
                                                      splocs_format(),
                                                      gltf_format(),
                                                      mesh_format(MeshFormat::ply),
                                                      mesh_format(MeshFormat::obj),
                                                      mesh_format(MeshFormat::off),
                                                      mesh_format(MeshFormat::stl),
                                                      mesh_format(MeshFormat::om)};
  return formats;
}

const SequenceFormat* sequence_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const auto& formats = sequence_formats();
  const auto found = std::ranges::find_if(formats, [&extension](const SequenceFormat& format) {
    return std::ranges::find(format.extensions, extension) != format.extensions.end();
  });
  return found == formats.end() ? nullptr : &*found;
}

std::vector<std::string> sequence_extensions() {
  std::vector<std::string> all;
  for (const SequenceFormat& format : sequence_formats()) {
    all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  }
  return all;
}

}  // namespace mimetra
