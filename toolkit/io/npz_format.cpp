#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <mutex>
#include <set>

#include <zip.h>

#include "toolkit/io/array_file.h"
#include "toolkit/io/binary_file.h"
#include "toolkit/io/bytes.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/npy_array.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

struct OpenZip {
  fs::path path;
  zip_t* archive = nullptr;
  /// libzip is not thread-safe.
  std::mutex mutex;

  ~OpenZip() {
    if (archive) zip_discard(archive);
  }
  [[noreturn]] void fail(const std::string& name, const std::string& reason) const {
    throw IoError(path.string(), "its member " + name + " cannot be read: " + reason);
  }
};

std::string zip_reason(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  return reason;
}

/// Member of an archive, open for reading.
class ZipMember : public InputBytes {
 public:
  ZipMember(std::shared_ptr<OpenZip> zip, std::string name, zip_file_t* file, std::size_t size)
      : zip_(std::move(zip)), name_(std::move(name)), file_(file), size_(size) {}
  ~ZipMember() override {
    const std::lock_guard lock(zip_->mutex);
    zip_fclose(file_);
  }

  std::size_t size() const override { return size_; }

 protected:
  std::shared_ptr<OpenZip> zip_;
  std::string name_;
  zip_file_t* file_;
  std::size_t size_;
};

/// Uncompressed member.
class StoredMember : public ZipMember {
 public:
  using ZipMember::ZipMember;

  void read(std::size_t offset, char* to, std::size_t bytes) const override {
    if (offset > size_ || bytes > size_ - offset) zip_->fail(name_, "it is truncated");
    if (bytes == 0) return;  // libzip crashes on a seek in an empty member
    const std::lock_guard lock(zip_->mutex);
    if (zip_fseek(file_, static_cast<zip_int64_t>(offset), SEEK_SET) != 0) fail();
    for (std::size_t done = 0; done < bytes;) {
      const zip_int64_t now = zip_fread(file_, to + done, bytes - done);
      if (now < 0) fail();
      if (now == 0) zip_->fail(name_, "it is truncated");
      done += static_cast<std::size_t>(now);
    }
  }

 private:
  [[noreturn]] void fail() const { zip_->fail(name_, zip_file_strerror(file_)); }
};

/// Bytes that are decoded first. Readers check the header in them before they ask for the rest.
constexpr std::size_t kFirstBytes = std::size_t{1} << 17;

/// Compressed member. A read within the first kFirstBytes decodes only those; any other read
/// decodes all.
class DeflatedMember : public ZipMember {
 public:
  using ZipMember::ZipMember;

  void read(std::size_t offset, char* to, std::size_t bytes) const override {
    if (offset > size_ || bytes > size_ - offset) zip_->fail(name_, "it is truncated");
    const std::lock_guard lock(zip_->mutex);
    const std::size_t end = offset + bytes;
    if (bytes_.size() < end) decode(end <= kFirstBytes ? std::min(kFirstBytes, size_) : size_);
    std::memcpy(to, bytes_.data() + offset, bytes);
  }

 private:
  void decode(std::size_t end) const {
    std::size_t done = bytes_.size();
    bytes_.resize(end);
    while (done < end) {
      const zip_int64_t now = zip_fread(file_, bytes_.data() + done, end - done);
      if (now <= 0) fail(now == 0 ? "it is truncated" : zip_file_strerror(file_));
      done += static_cast<std::size_t>(now);
    }
    char beyond = 0;
    // libzip compares the checksum only on a read beyond the last byte.
    if (end == size_ && zip_fread(file_, &beyond, 1) < 0) fail(zip_file_strerror(file_));
  }

  [[noreturn]] void fail(const std::string& reason) const {
    bytes_.clear();
    zip_->fail(name_, reason);
  }

  mutable std::string bytes_;
};

/// Approximate limit of deflate's compression ratio. Larger claims are refused before memory is
/// allocated.
constexpr std::size_t kMostDeflated = 1100;

/// Members of more than 1 GB may unpack to at most 512 times their stored bytes, so that a small
/// file cannot fill the memory.
constexpr std::size_t kUnpackedBytes = std::size_t{1} << 30, kUnpackedShare = 512;

/// ZIP archive, read with libzip.
class ZipReader {
 public:
  /// Throws IoError.
  explicit ZipReader(const fs::path& path);

  /// Names of the members, in archive order.
  std::vector<std::string> names() const;
  /// Opens a member. Stored members are read in parts. Compressed ones are decoded into memory,
  /// completely if more than their first 128 kB are read. The result may outlive the reader. Throws
  /// IoError.
  std::unique_ptr<const InputBytes> member(const std::string& name) const;

 private:
  std::shared_ptr<OpenZip> zip_;
};

ZipReader::ZipReader(const fs::path& path) : zip_(std::make_shared<OpenZip>()) {
  require_regular_file(path);
  zip_->path = path;
  int error = 0;
  zip_->archive = zip_open(path.c_str(), ZIP_RDONLY, &error);
  if (!zip_->archive) throw IoError(path.string(), "is no ZIP archive: " + zip_reason(error));
}

std::vector<std::string> ZipReader::names() const {
  std::vector<std::string> names;
  std::set<std::string> seen;
  const zip_int64_t count = zip_get_num_entries(zip_->archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(zip_->archive, static_cast<zip_uint64_t>(i), 0);
    if (!name) continue;
    if (!seen.insert(name).second) {
      throw IoError(zip_->path.string(), std::string("holds '") + name + "' twice");
    }
    names.emplace_back(name);
  }
  return names;
}

std::unique_ptr<const InputBytes> ZipReader::member(const std::string& name) const {
  const std::lock_guard lock(zip_->mutex);
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(zip_->archive, name.c_str(), 0, &stat) != 0) {
    zip_->fail(name, zip_strerror(zip_->archive));
  }
  // The archive states both sizes, and either may be wrong.
  const bool stored = stat.comp_method == ZIP_CM_STORE;
  if (stat.comp_size > fs::file_size(zip_->path) ||
      stat.size / (stored ? 1 : kMostDeflated) > stat.comp_size) {
    zip_->fail(name, "it lies about its size");
  }
  if (stat.size > kUnpackedBytes && stat.size / kUnpackedShare > stat.comp_size) {
    zip_->fail(name, "it would take " + readable(static_cast<double>(stat.size) / 1e6, 3) +
                         " MB, more than " + std::to_string(kUnpackedShare) +
                         " times what is stored");
  }
  std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen(zip_->archive, name.c_str(), 0),
                                                          zip_fclose);
  if (!file) zip_->fail(name, zip_strerror(zip_->archive));
  if (stored) {
    return std::make_unique<const StoredMember>(zip_, name, file.release(), stat.size);
  }
  return std::make_unique<const DeflatedMember>(zip_, name, file.release(), stat.size);
}

/// ZIP archive, written with libzip.
class ZipWriter {
 public:
  /// Throws OutputError.
  explicit ZipWriter(fs::path path) : path_(std::move(path)) {
    int error = 0;
    archive_ = zip_open(path_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    if (!archive_) fail(zip_reason(error));
  }
  ~ZipWriter() {
    if (archive_) zip_discard(archive_);
  }
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  /// Add a member without compression and without the current time. Throw OutputError.
  void add(const std::string& name, std::string bytes) {
    const std::string& kept = contents_.emplace_back(std::move(bytes));
    add(name, zip_source_buffer(archive_, kept.data(), kept.size(), 0));
  }
  void add_file(const std::string& name, const fs::path& file) {
    add(name, zip_source_file(archive_, file.c_str(), 0, -1));
  }

  /// Writes the archive. Throws OutputError.
  void close() {
    if (zip_close(archive_) != 0) fail(zip_strerror(archive_));
    archive_ = nullptr;
  }

 private:
  void add(const std::string& name, zip_source_t* source) {
    // First date of the format, so that the bytes depend only on the content.
    constexpr zip_uint16_t kFirstDate = 1 << 5 | 1;
    if (!source) fail(zip_strerror(archive_));
    const zip_int64_t index = zip_file_add(archive_, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      fail(zip_strerror(archive_));
    }
    const auto place = static_cast<zip_uint64_t>(index);
    // Readable by everyone, whatever the umask.
    constexpr zip_uint32_t kMode = 0100644U << 16;
    if (zip_set_file_compression(archive_, place, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_external_attributes(archive_, place, 0, ZIP_OPSYS_UNIX, kMode) != 0 ||
        zip_file_set_dostime(archive_, place, 0, kFirstDate, 0) != 0) {
      fail(zip_strerror(archive_));
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw OutputError(committed_name(path_).string(), "cannot be written: " + reason);
  }

  fs::path path_;
  zip_t* archive_ = nullptr;
  /// Bytes of members, which libzip reads when it closes the archive.
  std::deque<std::string> contents_;
};

// Accepted names of the arrays; the writer uses the first of each. An array without a name is
// NumPy's arr_0.
const std::vector<std::string> kPositionNames = {"positions", "vertices", "verts",
                                                 "points",    "frames",   "arr_0"};
const std::vector<std::string> kFaceNames = {"faces", "triangles", "tris", "polygons"};
const std::vector<std::string> kTimeNames = {"times", "time"};
const std::vector<std::string> kRateNames = {"fps", "mocap_framerate", "mocap_frame_rate",
                                             "frame_rate", "framerate"};
const std::vector<std::string> kRestNames = {"rest", "neutral"};

/// Padding of faces with fewer corners than the widest one.
constexpr std::int32_t kNoCorner = -1;

/// Arrays of an archive.
class NpzFile {
 public:
  explicit NpzFile(const fs::path& path) : path_(path), archive_(path), names_(archive_.names()) {}

  /// First of `names` in the archive; empty if there is none.
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

  /// Content of the archive, for messages.
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

OpenSequence open_npz(const fs::path& path, const ReadOptions& options, const Context& context) {
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
  if (const std::string faces = file.find(kFaceNames); !faces.empty() && !options.topology) {
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
  return open_point_cache(std::move(cache), options, std::move(parts), context);
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

/// Temporary file that its destructor removes.
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

/// Writes the positions to a temporary file first, since the members of an archive are written one
/// after the other.
class NpzSink : public FrameSink {
 public:
  NpzSink(const SequenceHeader& header, const fs::path& target, const WriteOptions& options)
      : header_(header),
        target_(target),
        outputs_(options.overwrite, options.inputs, options.together),
        archive_(outputs_.add(target, PendingOutput::Kind::file)),
        scratch_(target),
        positions_(begin_npy_cache(scratch_.path, static_cast<std::size_t>(header.times.size()),
                                   static_cast<std::size_t>(header.connectivity->vertices),
                                   options.single_precision)) {
    add_extra_beside(outputs_, target_, options.extra, extra_files_);
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
                                     const WriteOptions& options, const Context&) {
  return std::make_unique<NpzSink>(header, target, options);
}

}  // namespace

Format npz_format() {
  return {.name = "NumPy archive",
          .extensions = {".npz"},
          .reading = reading_parameters(),
          .writing = writing_parameters({"single"}),
          .holds = [](const WriteOptions&) { return HeldParts{.polygons = true}; },
          .open = open_npz,
          .create = begin_npz};
}

}  // namespace mimetra
