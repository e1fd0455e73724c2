#include "toolkit/formats/hdf5/hdf5_formats.h"
#include "toolkit/io/frame_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/formats/hdf5/hdf5_file.h"
#include "toolkit/formats/hdf5/hdf5_image.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/point_cache.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

// Datasets of the reference implementation of sparse localized deformation components.
constexpr auto kVerts = "verts", kTris = "tris";
// Names of the same data in other tools.
constexpr auto kVertices = "vertices", kFaces = "faces";
// Further datasets of mimetra, which the reference implementation ignores.
constexpr auto kTimesName = "times", kRestName = "rest";
// If not all polygons are triangles: the number of corners of each polygon, and their vertices.
// Also texture coordinates, and the index of each corner's.
constexpr auto kSizes = "polygon_sizes", kCorners = "polygon_corners";
constexpr auto kTexture = "uvs", kTextureCorners = "uv_corners";

std::string dataset_shape(const Hdf5Dataset& set) {
  std::vector<std::string> sizes;
  for (const std::uint64_t size : set.shape()) sizes.push_back(std::to_string(size));
  return sizes.empty() ? "one number" : joined(sizes, " x ");
}

/// Converts a size. The number of frames, and of coordinates in one, must fit int.
int counted(const Hdf5Dataset& set, std::uint64_t size) {
  constexpr std::uint64_t kMost = std::numeric_limits<int>::max() / 3;
  if (size > 0 && size <= kMost) return static_cast<int>(size);
  set.fail("has " + std::to_string(size) + " frames or vertices, expected 1 to " +
           std::to_string(kMost));
}

Hdf5Dataset positions_of(const Hdf5File& file) {
  for (const char* name : {kVerts, kVertices}) {
    if (file.has(name)) return file.dataset(name);
  }
  if (file.has("default") && file.has("comp000")) {
    file.fail(
        "holds components, expected a sequence; `regions` and `transfer` take them by option "
        "'components'");
  }
  if (file.has("VTKHDF")) file.fail("is a VTKHDF file, which is written but not read");
  file.fail(
      "holds " + (file.names().empty() ? "nothing" : listed(file.names())) +
      ", expected the dataset 'verts' or 'vertices' of frames x vertices x 3 or vertices x 3 x "
      "frames; copy one take under that name");
}

/// File with frames x vertices x 3.
class SplocsFile : public PointCache {
 public:
  SplocsFile(const fs::path& path, Hdf5Dataset verts) : PointCache(path), verts_(std::move(verts)) {
    frames_ = counted(verts_, verts_.shape()[0]);
    vertices_ = counted(verts_, verts_.shape()[1]);
  }

 private:
  void read_values(int first, FramesView poses) const override {
    verts_.read(static_cast<std::uint64_t>(first),
                {poses.data(), static_cast<std::size_t>(poses.size())});
  }

  Hdf5Dataset verts_;
};

/// File with vertices x 3 x frames, as MATLAB and Dynamic FAUST write it. Each frame is spread over
/// the file, so the file is read completely.
class TransposedFile : public PointCache {
 public:
  TransposedFile(const fs::path& path, const Hdf5Dataset& verts)
      : PointCache(path), values_(verts.values()) {
    frames_ = counted(verts, verts.shape()[2]);
    vertices_ = counted(verts, verts.shape()[0]);
  }

 private:
  void read_values(int first, FramesView poses) const override {
    const Eigen::Map<const Eigen::MatrixXd> frames(values_.data(), frames_, poses.cols());
    poses = frames.middleRows(first, poses.rows());
  }

  std::vector<double> values_;
};

std::unique_ptr<const PointCache> cache_of(const fs::path& path, Hdf5Dataset verts) {
  const auto& shape = verts.shape();
  const bool is_real = verts.type().is_real, has_axes = is_real && shape.size() == 3;
  if (has_axes && shape[2] == 3) return std::make_unique<SplocsFile>(path, std::move(verts));
  if (has_axes && shape[1] == 3) return std::make_unique<TransposedFile>(path, verts);
  verts.fail("is " + dataset_shape(verts) + (is_real ? "" : " integers") +
             ", expected frames x vertices x 3, or vertices x 3 x frames, of float32 or float64");
}

void check_shape(const Hdf5Dataset& set, const std::vector<std::uint64_t>& expected,
                 const std::string& text) {
  if (set.shape() != expected) set.fail("is " + dataset_shape(set) + ", expected " + text);
}

/// Reads a dataset of integers from `least` to `most`.
std::vector<int> integers_of(const Hdf5Dataset& set, int least, int most) {
  std::vector<int> integers;
  for (const double value : set.values()) {
    if (!(value >= least && value <= most) || value != std::floor(value)) {
      set.fail("holds " + readable(value) + ", expected " + std::to_string(least) + " to " +
               std::to_string(most));
    }
    integers.push_back(static_cast<int>(value));
  }
  return integers;
}

Polygons triangles_of(const Hdf5Dataset& set, int vertices) {
  if (set.shape().size() != 2 || set.shape()[1] != 3) {
    set.fail("is " + dataset_shape(set) + ", expected triangles x 3");
  }
  if (set.size() == 0) set.fail("has no triangles");
  Polygons polygons;
  polygons.corners = integers_of(set, 0, vertices - 1);
  for (std::size_t end = 3; end <= polygons.corners.size(); end += 3) {
    polygons.offsets.push_back(static_cast<int>(end));
  }
  return polygons;
}

Connectivity connectivity_of(const Hdf5Dataset& set, int vertices, Polygons polygons) {
  try {
    return Connectivity::from_polygons(vertices, std::move(polygons));
  } catch (const std::invalid_argument& error) {
    set.fail(error.what());
  }
}

/// Polygons that the triangles were made from.
Polygons polygons_of(const Hdf5File& file, int vertices) {
  const Hdf5Dataset sizes = file.dataset(kSizes), corners = file.dataset(kCorners);
  Polygons polygons;
  polygons.corners = integers_of(corners, 0, vertices - 1);
  std::uint64_t end = 0;
  for (const int size : integers_of(sizes, 3, std::numeric_limits<int>::max())) {
    end += static_cast<std::uint64_t>(size);
    if (end > polygons.corners.size()) break;
    polygons.offsets.push_back(static_cast<int>(end));
  }
  if (end != polygons.corners.size()) {
    sizes.fail("adds up to another number than there are 'polygon_corners'");
  }
  return polygons;
}

TextureCoordinates texture_of(const Hdf5File& file, std::size_t corners) {
  const Hdf5Dataset uvs = file.dataset(kTexture), indices = file.dataset(kTextureCorners);
  check_shape(uvs, {uvs.shape().empty() ? 0 : uvs.shape()[0], 2}, "coordinates x 2");
  check_shape(indices, {corners}, std::to_string(corners) + ", one for each corner");
  const std::vector<double> values = uvs.values();
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    uvs.fail("holds a number that is not finite");
  }
  TextureCoordinates texture;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    texture.coordinates.emplace_back(values[i], values[i + 1]);
  }
  texture.corners = integers_of(indices, -1, static_cast<int>(texture.coordinates.size()) - 1);
  return texture;
}

std::shared_ptr<const Connectivity> faces_of(const Hdf5File& file, const char* name, int vertices) {
  const Hdf5Dataset tris = file.dataset(name);
  Connectivity faces = connectivity_of(tris, vertices, triangles_of(tris, vertices));
  if (file.has(kSizes) && file.has(kCorners)) {
    Connectivity cut = connectivity_of(file.dataset(kSizes), vertices, polygons_of(file, vertices));
    if (cut.triangles.rows() != faces.triangles.rows() || cut.triangles != faces.triangles) {
      tris.fail("is not what the polygons of 'polygon_corners' are cut into; remove one of them");
    }
    faces = std::move(cut);
  }
  if (file.has(kTexture) && file.has(kTextureCorners)) {
    faces.texture = texture_of(file, faces.polygons.corners.size());
  }
  return std::make_shared<const Connectivity>(std::move(faces));
}

Eigen::VectorXd times_in(const Hdf5Dataset& set, int frames) {
  check_shape(set, {static_cast<std::uint64_t>(frames)},
              std::to_string(frames) + ", one time for each frame");
  Eigen::VectorXd times(frames);
  set.read(0, {times.data(), set.size()});
  return times;
}

Positions rest_in(const Hdf5Dataset& set, int vertices) {
  check_shape(set, {static_cast<std::uint64_t>(vertices), 3}, std::to_string(vertices) + " x 3");
  Positions rest(vertices, 3);
  set.read(0, {rest.data(), set.size()});
  if (const Eigen::Index v = first_unusable(rest); v >= 0) {
    set.fail("vertex " + std::to_string(v) + " has no usable position");
  }
  return rest;
}

OpenSequence open_splocs(const fs::path& path, const ReadOptions& options, const Context& context) {
  const Hdf5File file(path);
  std::unique_ptr<const PointCache> cache = cache_of(path, positions_of(file));
  PointCacheParts parts;
  const char* const faces = file.has(kTris) ? kTris : kFaces;
  if (file.has(faces) && !options.topology) parts.faces = faces_of(file, faces, cache->vertices());
  if (file.has(kTimesName)) {
    parts.times = times_in(file.dataset(kTimesName), cache->frames());
    check_times(path.string(), *parts.times);
  }
  if (file.has(kRestName)) parts.rest = rest_in(file.dataset(kRestName), cache->vertices());
  return open_point_cache(std::move(cache), options, std::move(parts), context);
}

Hdf5Image image_of(const SequenceHeader& header, Hdf5Array::Type type) {
  const Connectivity& faces = *header.connectivity;
  Hdf5Image image;
  image.reserve(kVerts, type,
                {static_cast<std::uint64_t>(header.times.size()),
                 static_cast<std::uint64_t>(faces.vertices), 3});
  image.add(kTris, Hdf5Array::of(faces.triangles));
  if (header.times_are_known) {
    image.add(kTimesName, Hdf5Array::of(std::span(header.times.data(),
                                                  static_cast<std::size_t>(header.times.size()))));
  }
  if (header.rest_is_known) image.add(kRestName, Hdf5Array::of(header.rest));
  const std::vector<int>& offsets = faces.polygons.offsets;
  std::vector<int> sizes;
  for (std::size_t i = 1; i < offsets.size(); ++i) sizes.push_back(offsets[i] - offsets[i - 1]);
  if (std::ranges::any_of(sizes, [](int size) { return size != 3; })) {
    image.add(kSizes, Hdf5Array::of(sizes));
    image.add(kCorners, Hdf5Array::of(faces.polygons.corners));
  }
  if (!faces.texture.corners.empty()) {
    Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uvs(faces.texture.coordinates.size(),
                                                                  2);
    for (Eigen::Index i = 0; i < uvs.rows(); ++i) {
      uvs.row(i) = faces.texture.coordinates[static_cast<std::size_t>(i)];
    }
    image.add(kTexture, Hdf5Array::of(uvs));
    image.add(kTextureCorners, Hdf5Array::of(faces.texture.corners));
  }
  return image;
}

/// Writes everything but the positions first, and then the positions to their place in the file.
class SplocsSink : public FrameSink {
 public:
  SplocsSink(const SequenceHeader& header, const fs::path& target, const WriteOptions& options)
      : target_(target),
        outputs_(options.overwrite, options.inputs, options.together),
        file_(outputs_.add(target, PendingOutput::Kind::file)),
        columns_(3 * static_cast<std::size_t>(header.connectivity->vertices)),
        extent_(extent(header.rest)) {
    const bool single = options.single_precision;
    Hdf5Image image =
        image_of(header, single ? Hdf5Array::Type::float32 : Hdf5Array::Type::float64);
    file_.write({image.image()});
    verts_ = {image.place_of(kVerts), single ? sizeof(float) : sizeof(double), std::endian::little};
    add_extra_beside(outputs_, target_, options.extra, extra_files_);
  }

  void write(int first, const Frames& poses) override {
    if (verts_.bytes == sizeof(float)) {
      check_single_range(target_, first, poses);
      check_single_precision(target_, PositionsView(poses.data(), poses.size() / 3, 3), extent_,
                             SinglePrecision::asked);
    }
    verts_.write(file_, columns_ * static_cast<std::size_t>(first),
                 {poses.data(), static_cast<std::size_t>(poses.size())});
  }

  std::vector<fs::path> commit() override {
    file_.close();
    std::vector<fs::path> files = {target_};
    files.insert(files.end(), extra_files_.begin(), extra_files_.end());
    outputs_.commit();
    return files;
  }

 private:
  fs::path target_;
  std::vector<fs::path> extra_files_;
  PendingOutputs outputs_;
  OutputFile file_;
  StoredFloats verts_;
  std::size_t columns_;
  double extent_;  ///< longest side of the rest pose
};

std::unique_ptr<FrameSink> begin_splocs(const SequenceHeader& header, const fs::path& target,
                                        const WriteOptions& options, const Context&) {
  return std::make_unique<SplocsSink>(header, target, options);
}

}  // namespace

Format splocs_format() {
  return {.name = "SPLOCS sequence (HDF5)",
          .extensions = {".h5", ".hdf5"},
          .reading = reading_parameters(),
          .writing = writing_parameters({"single"}),
          .holds =
              [](const WriteOptions&) {
                return HeldParts{.polygons = true, .texture = HeldParts::Texture::corners};
              },
          .open = open_splocs,
          .create = begin_splocs};
}

}  // namespace mimetra
