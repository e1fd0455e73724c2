#include <algorithm>
#include <array>
#include <cmath>

#include "toolkit/io/bytes.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/npy_cache.h"
#include "toolkit/io/npy_header.h"
#include "toolkit/io/npy_values.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/temporary_name.h"
#include "toolkit/io/zip_archive.h"
#include "toolkit/mesh/coordinate.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

// Names of the arrays; what is written has the first of each. An array without a name is NumPy's
// arr_0.
const std::vector<std::string> kPositionNames = {"positions", "vertices", "verts",
                                                 "points",    "frames",   "arr_0"};
const std::vector<std::string> kFaceNames = {"faces", "triangles", "tris", "polygons"};
const std::vector<std::string> kTimeNames = {"times", "time"};
const std::vector<std::string> kRateNames = {"fps", "mocap_framerate", "mocap_frame_rate",
                                             "frame_rate", "framerate"};
const std::vector<std::string> kRestNames = {"rest", "neutral"};

/// Pads the faces of those with fewer corners.
constexpr std::int32_t kNoCorner = -1;

/// The arrays of an archive.
class NpzFile {
 public:
  explicit NpzFile(const fs::path& path) : path_(path), archive_(path), names_(archive_.names()) {}

  /// The first of `names` that it holds; empty for none.
  std::string find(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      if (std::ranges::find(names_, name + kMember) != names_.end()) return name;
    }
    return {};
  }

  std::string named(const std::string& name) const { return path_.string() + ": " + name; }

  std::unique_ptr<const InputBytes> bytes(const std::string& name) const {
    return archive_.member(name + kMember);
  }

  NumericArray array(const std::string& name) const {
    const auto source = bytes(name);
    const NpyHeader header = read_npy_header(named(name), *source);
    std::string content(source->size(), '\0');
    source->read(0, content.data(), content.size());
    return npy_values(named(name), content, header);
  }

  /// What it holds, for messages.
  std::string list() const { return names_.empty() ? "nothing" : listed(names_, 8); }

 private:
  static constexpr const char* kMember = ".npy";

  fs::path path_;
  ZipReader archive_;
  std::vector<std::string> names_;
};

[[noreturn]] void fail_shape(const std::string& name, const NumericArray& array,
                             const std::string& expected) {
  throw IoError(name, "has shape " + shape_text(array.shape) + ", expected " + expected);
}

Connectivity faces_of(const std::string& name, const NumericArray& array, int vertices) {
  if (array.shape.size() != 2 || array.shape[1] < 3) fail_shape(name, array, "faces x corners");
  Polygons polygons;
  for (std::size_t face = 0; face < array.shape[0]; ++face) {
    for (std::size_t corner = 0; corner < array.shape[1]; ++corner) {
      const double index = array.values[face * array.shape[1] + corner];
      if (index == kNoCorner) break;
      if (!(index >= 0 && index < vertices) || index != std::floor(index)) {
        throw IoError(name, "face " + std::to_string(face) + " uses vertex " + readable(index) +
                                ", expected 0 to " + std::to_string(vertices - 1));
      }
      polygons.corners.push_back(static_cast<int>(index));
    }
    polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  if (polygons.size() == 0) throw IoError(name, "has no faces");
  try {
    return Connectivity::from_polygons(vertices, std::move(polygons));
  } catch (const std::invalid_argument& error) {
    throw IoError(name, error.what());
  }
}

Eigen::VectorXd times_in(const std::string& name, const NumericArray& array, int frames) {
  if (array.shape != std::vector<std::size_t>{static_cast<std::size_t>(frames)}) {
    fail_shape(name, array, std::to_string(frames) + ", one time for each frame");
  }
  Eigen::VectorXd times = Eigen::Map<const Eigen::VectorXd>(array.values.data(), frames);
  check_times(name, times);
  return times;
}

Eigen::VectorXd times_by_rate(const std::string& name, const NumericArray& array, int frames) {
  if (array.values.size() != 1) fail_shape(name, array, "one number");
  const double fps = array.values.front();
  if (!(fps > 0 && std::isfinite(fps))) {
    throw IoError(name, "is " + readable(fps) + ", expected frames per second");
  }
  return Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / fps;
}

Positions rest_in(const std::string& name, const NumericArray& array, int vertices) {
  if (array.shape != std::vector<std::size_t>{static_cast<std::size_t>(vertices), 3}) {
    fail_shape(name, array, std::to_string(vertices) + " x 3 as the positions have vertices");
  }
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    if (is_coordinate(array.values[i])) continue;
    throw IoError(name, "vertex " + std::to_string(i / 3) +
                            " has no usable position: " + readable(array.values[i]));
  }
  return Eigen::Map<const Positions>(array.values.data(), vertices, 3);
}

OpenSequence open_npz(const fs::path& path, const SequenceSource& source, const Context& context) {
  const NpzFile file(path);
  const std::string positions = file.find(kPositionNames);
  if (positions.empty()) {
    throw IoError(path.string(), "holds " + file.list() + ", expected an array " +
                                     joined(kPositionNames, ", ", " or ") +
                                     " of frames x vertices x 3");
  }
  auto cache = open_npy_cache(file.named(positions), file.bytes(positions));
  PointCacheParts parts;
  parts.path = path;
  if (const std::string faces = file.find(kFaceNames); !faces.empty() && !source.topology) {
    parts.faces = std::make_shared<const Connectivity>(
        faces_of(file.named(faces), file.array(faces), cache->vertices()));
  }
  if (const std::string times = file.find(kTimeNames); !times.empty()) {
    parts.times = times_in(file.named(times), file.array(times), cache->frames());
  } else if (const std::string rate = file.find(kRateNames); !rate.empty()) {
    parts.times = times_by_rate(file.named(rate), file.array(rate), cache->frames());
  }
  if (const std::string rest = file.find(kRestNames); !rest.empty()) {
    parts.rest = rest_in(file.named(rest), file.array(rest), cache->vertices());
  }
  return open_point_cache(std::move(cache), source, std::move(parts), context);
}

template <typename Number>
std::string npy_bytes(std::string_view type, const std::vector<std::size_t>& shape,
                      const std::vector<Number>& values) {
  std::string bytes = npy_header_bytes(type, shape);
  for (const Number value : values) append_little_endian(bytes, value);
  return bytes;
}

std::string npy_bytes(const Connectivity& connectivity) {
  const Polygons& polygons = connectivity.polygons;
  const auto faces = static_cast<std::size_t>(polygons.size());
  std::size_t most = 3;
  const auto corners_of = [&polygons](std::size_t face) {
    return static_cast<std::size_t>(polygons.offsets[face + 1] - polygons.offsets[face]);
  };
  for (std::size_t face = 0; face < faces; ++face) most = std::max(most, corners_of(face));
  std::vector<std::int32_t> corners(faces * most, kNoCorner);
  for (std::size_t face = 0; face < faces; ++face) {
    std::copy_n(polygons.corners.begin() + polygons.offsets[face], corners_of(face),
                corners.begin() + static_cast<std::ptrdiff_t>(face * most));
  }
  return npy_bytes("<i4", {faces, most}, corners);
}

/// A file that goes with this.
struct FileBeside {
  fs::path path;

  explicit FileBeside(const fs::path& target) {
    std::error_code error;
    path = make_temporary_beside(target, OutputKind::file, error);
    if (error) throw OutputError(target.string(), "cannot be written: " + error.message());
  }
  ~FileBeside() {
    std::error_code gone;
    fs::remove(path, gone);
  }
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;
};

/// The positions go to a file of their own first, since an archive has one member after the other.
class NpzSink : public FrameSink {
 public:
  NpzSink(const SequenceHeader& header, const fs::path& target, const SequenceWriteOptions& options,
          const ExtraFiles& extra)
      : header_(header),
        target_(target),
        outputs_(options.overwrite, options.inputs, options.together),
        archive_(outputs_.add(target, PendingOutput::Kind::file)),
        scratch_(target),
        positions_(begin_npy_cache(scratch_.path, static_cast<std::size_t>(header.times.size()),
                                   static_cast<std::size_t>(header.connectivity->vertices),
                                   options.single_precision)) {
    add_extra_beside(outputs_, target_, extra, extra_files_);
  }

  void write(int first, const Frames& poses) override {
    if (positions_.positions.bytes == sizeof(float)) {
      check_single_range(target_, first, poses);
      check_single_precision(target_, PositionsView(poses.data(), poses.size() / 3, 3),
                             extent(header_.rest), SinglePrecision::asked);
    }
    const auto columns = static_cast<std::size_t>(poses.cols());
    positions_.positions.write(*positions_.file, columns * static_cast<std::size_t>(first),
                               {poses.data(), static_cast<std::size_t>(poses.size())});
  }

  std::vector<fs::path> commit() override {
    positions_.file->close();
    const auto count = [](Eigen::Index size) { return static_cast<std::size_t>(size); };
    const auto name = [](const std::vector<std::string>& names) { return names.front() + ".npy"; };
    ZipWriter zip(archive_);
    zip.add_file(name(kPositionNames), scratch_.path);
    zip.add(name(kFaceNames), npy_bytes(*header_.connectivity));
    if (header_.times_are_known) {
      zip.add(name(kTimeNames), npy_bytes<double>("<f8", {count(header_.times.size())},
                                                  {header_.times.begin(), header_.times.end()}));
    }
    if (header_.rest_is_known) {
      const double* rest = header_.rest.data();
      zip.add(name(kRestNames), npy_bytes<double>("<f8", {count(header_.rest.rows()), 3},
                                                  {rest, rest + header_.rest.size()}));
    }
    zip.close();
    std::vector<fs::path> files = {target_};
    files.insert(files.end(), extra_files_.begin(), extra_files_.end());
    outputs_.commit();
    return files;
  }

 private:
  SequenceHeader header_;
  fs::path target_;
  std::vector<fs::path> extra_files_;
  PendingOutputs outputs_;
  fs::path archive_;
  FileBeside scratch_;
  PointCacheTarget positions_;
};

std::unique_ptr<FrameSink> begin_npz(const SequenceHeader& header, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra,
                                     const Context&) {
  return std::make_unique<NpzSink>(header, target, options, extra);
}

}  // namespace

SequenceFormat npz_format() {
  return {"NumPy archive",
          {".npz"},
          true,
          SequenceFormat::Precision::double_or_single,
          open_npz,
          begin_npz,
          {.polygons = true}};
}

}  // namespace mimetra
