#include "toolkit/formats/gltf/gltf_write.h"

#include <array>
#include <limits>

#include <nlohmann/json.hpp>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/bytes.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr int kFloatType = 5126, kIndexType = 5125, kByteType = 5120;
constexpr int kVertexData = 34962, kFaceData = 34963;

/// Smallest and largest x, y and z.
using GltfBounds = std::array<std::array<double, 3>, 2>;

/// Number with the longest text that a bound can have; reserves room in the JSON.
constexpr double kLongestNumber = -std::numeric_limits<double>::min();
constexpr GltfBounds kUnknownBounds = {{{kLongestNumber, kLongestNumber, kLongestNumber},
                                        {kLongestNumber, kLongestNumber, kLongestNumber}}};

/// Extends bounds by a point. Point 0 replaces them.
void include(GltfBounds& bounds, Eigen::Index point, const float* xyz) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = static_cast<double>(xyz[c]);
    bounds[0][c] = point == 0 ? value : std::min(bounds[0][c], value);
    bounds[1][c] = point == 0 ? value : std::max(bounds[1][c], value);
  }
}

std::string float_bytes(const double* values, Eigen::Index count) {
  std::string bytes(static_cast<std::size_t>(count) * sizeof(float), '\0');
  for (Eigen::Index i = 0; i < count; ++i) {
    put_little_endian(bytes.data() + sizeof(float) * static_cast<std::size_t>(i),
                      static_cast<float>(values[i]));
  }
  return bytes;
}

/// Elements that are not 0, or the first one if all are 0.
struct SparseNumbers {
  std::string indices, values;
  std::size_t stored = 0;
};

/// Returns the elements of `size` numbers that are not 0; none if they are more than half of
/// `count`.
std::optional<SparseNumbers> sparse_numbers(const double* values, Eigen::Index count, int size) {
  SparseNumbers sparse;
  const auto keep = [&](Eigen::Index element) {
    append_little_endian(sparse.indices, static_cast<std::uint32_t>(element));
    sparse.values += float_bytes(values + size * element, size);
    ++sparse.stored;
  };
  for (Eigen::Index element = 0; element < count; ++element) {
    bool is_zero = true;
    for (int c = 0; c < size; ++c) {
      is_zero = is_zero && static_cast<float>(values[size * element + c]) == 0;
    }
    if (!is_zero) keep(element);
    if (2 * sparse.stored > static_cast<std::size_t>(count)) return std::nullopt;
  }
  if (sparse.stored == 0) keep(0);
  return sparse;
}

/// Layout of the file, decided before anything is written.
class GltfLayout {
 public:
  /// Reserves `bytes` bytes. Returns the number of the view.
  std::size_t add_view(std::size_t bytes, int use = 0) {
    Json view = {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}};
    if (use != 0) view["target"] = use;
    views_.push_back(std::move(view));
    bytes_ += bytes;
    return views_.size() - 1;
  }

  /// Adds an accessor whose elements fill a view. Returns its number.
  std::size_t add(std::size_t view, int type, const char* shape, std::size_t count) {
    accessors_.push_back(
        {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
    return accessors_.size() - 1;
  }
  /// Adds a sparse accessor, which stores only some elements. Returns its number.
  std::size_t add_sparse(int type, const char* shape, std::size_t count, std::size_t stored,
                         std::size_t indices, std::size_t values) {
    accessors_.push_back({{"componentType", type},
                          {"count", count},
                          {"type", shape},
                          {"sparse",
                           {{"count", stored},
                            {"indices", {{"bufferView", indices}, {"componentType", kIndexType}}},
                            {"values", {{"bufferView", values}}}}}});
    return accessors_.size() - 1;
  }
  void set_normalized(std::size_t accessor) { accessors_[accessor]["normalized"] = true; }
  void set_bounds(std::size_t accessor, const GltfBounds& bounds) {
    accessors_[accessor]["min"] = bounds[0];
    accessors_[accessor]["max"] = bounds[1];
  }
  void set_bounds(std::size_t accessor, double least, double most) {
    accessors_[accessor]["min"] = {least};
    accessors_[accessor]["max"] = {most};
  }

  std::size_t bytes() const { return bytes_; }
  std::size_t offset(std::size_t view) const {
    return views_[view]["byteOffset"].get<std::size_t>();
  }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  Json views_ = Json::array(), accessors_ = Json::array();
  std::size_t bytes_ = 0;
};

/// Corners of the polygons' fans. Successive fans start with different corners, so that successive
/// triangles with one first corner are one polygon. [FB_ngon_encoding]
std::vector<int> fan_corners(const Polygons& polygons) {
  std::vector<int> corners;
  corners.reserve(3 * polygons.corners.size());
  int last_start = -1;
  for (int face = 0; face < polygons.size(); ++face) {
    const int* polygon = polygons.corners.data() + polygons.offsets[static_cast<std::size_t>(face)];
    const int size = polygons.offsets[static_cast<std::size_t>(face) + 1] -
                     polygons.offsets[static_cast<std::size_t>(face)];
    // A quad keeps its diagonal if it starts with its opposite corner.
    int start = 0;
    if (polygon[0] == last_start) start = size == 4 && polygon[2] != last_start ? 2 : 1;
    for (int corner = 1; corner + 1 < size; ++corner) {
      corners.push_back(polygon[start]);
      corners.push_back(polygon[(start + corner) % size]);
      corners.push_back(polygon[(start + corner + 1) % size]);
    }
    last_start = polygon[start];
  }
  return corners;
}

/// Unit normals of vertices (N x 3). Vertices at one place share a normal; vertices without a
/// triangle get the z axis.
Positions unit_normals(const Positions& positions, const Triangles& triangles, const Weld& weld) {
  Positions normals = vertex_normals(positions, triangles, weld);
  for (auto normal : normals.rowwise()) {
    const double length = normal.norm();
    if (length > 0) {
      normal /= length;
    } else {
      normal = Eigen::RowVector3d::UnitZ();
    }
  }
  return normals;
}

/// Changes of normals in [-1, 1] as bytes, where 127 represents 1. [KHR_mesh_quantization]
struct NormalBytes {
  std::size_t stored = 0;
  std::string indices, values;  ///< vertices whose normal changes; at least one
};

std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  return bytes;
}

NormalBytes normal_bytes(const Positions& changes) {
  constexpr double kOne = 127;
  NormalBytes result;
  for (Eigen::Index v = 0; v < changes.rows(); ++v) {
    const Eigen::RowVector3d rounded = (kOne * changes.row(v)).array().round();
    if (rounded.isZero(0) && !(v + 1 == changes.rows() && result.stored == 0)) continue;
    append_little_endian(result.indices, static_cast<std::uint32_t>(v));
    for (const double value : rounded) result.values += static_cast<char>(value);
    ++result.stored;
  }
  result.values = padded(std::move(result.values));
  return result;
}

void check_gltf_times(const fs::path& target, const Eigen::VectorXd& times) {
  for (Eigen::Index frame = 0; frame < times.size(); ++frame) {
    const auto time = static_cast<float>(times[frame]);
    if (time < 0) {
      throw MismatchError(target.string() + ": frame " + std::to_string(frame) + " is at " +
                          readable(times[frame]) +
                          " s, and glTF has no times below 0; write .npz or .pvd");
    }
    if (frame == 0 || time > static_cast<float>(times[frame - 1])) continue;
    throw MismatchError(target.string() + ": frames " + std::to_string(frame - 1) + " and " +
                        std::to_string(frame) + " are at " + readable(times[frame], 12) +
                        " s, nearer than single precision tells apart; write .npz or .pvd");
  }
}

/// Writes a file: first faces and rest pose, then targets and weights.
class GltfFile {
 public:
  struct Plan {
    const SequenceHeader& header;
    std::vector<std::string> targets;
    /// Displacements of the targets (3N x D) if they are known already; otherwise room is reserved.
    const Eigen::MatrixXd* displacements = nullptr;
    /// Weights (F x D, row by row), empty for a model without motion.
    Frames weights = {};
  };

  GltfFile(const Plan& plan, const fs::path& target, const WriteOptions& options,
           const Context& context)
      : target_(target),
        is_binary_(lower_extension(target) == ".glb"),
        names_(plan.targets),
        has_polygons_(plan.header.connectivity->triangles.rows() !=
                      plan.header.connectivity->polygons.size()),
        name_(target.stem().string()),
        rest_is_known_(plan.header.rest_is_known),
        neutral_(plan.header.rest.cast<float>()),
        outputs_(options.overwrite, options.inputs, options.together) {
    const Positions& rest = plan.header.rest;
    check_single_precision(target, {rest.data(), rest.rows(), 3}, extent(rest));
    if (plan.weights.rows() > 0) check_gltf_times(target, plan.header.times);
    std::vector<std::pair<std::size_t, std::string>> known = laid_out(plan, context);
    check_length();
    const fs::path path = outputs_.add(target, PendingOutput::Kind::file);
    const fs::path data = is_binary_ ? path
                                     : outputs_.add(data_path(), PendingOutput::Kind::file,
                                                    PendingOutputs::Existing::same);
    json_path_ = path;
    file_ = std::make_unique<OutputFile>(data);
    for (const auto& [view, content] : known) write_view(view, content);
    add_extra_beside(outputs_, target, options.extra, extra_files_);
  }

  /// Writes one target into its reserved room. Several threads may write, each target once.
  void write_target(int target, const double* displacements) {
    const auto index = static_cast<std::size_t>(target);
    const std::string bytes = float_bytes(displacements, neutral_.size());
    GltfBounds& bounds = bounds_[index];
    for (Eigen::Index v = 0; v < neutral_.rows(); ++v) {
      const std::array<float, 3> xyz = {static_cast<float>(displacements[3 * v]),
                                        static_cast<float>(displacements[3 * v + 1]),
                                        static_cast<float>(displacements[3 * v + 2])};
      include(bounds, v, xyz.data());
    }
    write_view(views_of_targets_[index], bytes);
  }

  /// Neutral as stored. Targets are displacements from it.
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>& neutral() const {
    return neutral_;
  }

  std::vector<fs::path> commit() {
    for (std::size_t j = 0; j < bounds_.size(); ++j) {
      layout_.set_bounds(accessors_of_targets_[j], bounds_[j]);
    }
    const std::string text = json();
    std::vector<fs::path> files = {target_};
    if (is_binary_) {
      std::string head = "glTF";
      append_little_endian(head, std::uint32_t{2});
      append_little_endian(
          head, static_cast<std::uint32_t>(kHead + json_room_ + kChunkHead + layout_.bytes()));
      append_little_endian(head, static_cast<std::uint32_t>(json_room_));
      head += "JSON" + text + std::string(json_room_ - text.size(), ' ');
      append_little_endian(head, static_cast<std::uint32_t>(layout_.bytes()));
      head += std::string("BIN\0", 4);
      file_->write_at(0, head);
    } else {
      OutputFile(json_path_).write({text, "\n"});
      files.push_back(data_path());
    }
    file_->close();
    files.insert(files.end(), extra_files_.begin(), extra_files_.end());
    outputs_.commit();
    return files;
  }

 private:
  static constexpr std::size_t kHead = 20, kChunkHead = 8;

  fs::path data_path() const { return fs::path(target_).replace_extension(".bin"); }

  /// Decides where everything is stored. Returns the content that is known already, by view.
  std::vector<std::pair<std::size_t, std::string>> laid_out(const Plan& plan,
                                                            const Context& context) {
    std::vector<std::pair<std::size_t, std::string>> known;
    const auto put = [&](std::string bytes, int use = 0) {
      const std::size_t view = layout_.add_view(bytes.size(), use);
      known.emplace_back(view, std::move(bytes));
      return view;
    };
    const Connectivity& faces = *plan.header.connectivity;
    const auto vertices = static_cast<std::size_t>(faces.vertices);
    const std::vector<int> corners = fan_corners(faces.polygons);
    std::string indices;
    for (const int corner : corners) {
      append_little_endian(indices, static_cast<std::uint32_t>(corner));
    }
    faces_ = layout_.add(put(std::move(indices), kFaceData), kIndexType, "SCALAR", corners.size());
    positions_ =
        layout_.add(put(float_bytes(plan.header.rest.data(), plan.header.rest.size()), kVertexData),
                    kFloatType, "VEC3", vertices);
    GltfBounds bounds = kUnknownBounds;
    for (Eigen::Index v = 0; v < neutral_.rows(); ++v) include(bounds, v, neutral_.row(v).data());
    layout_.set_bounds(positions_, bounds);
    // Normals follow from the stored positions, so that reading and writing a file changes nothing.
    const Positions stored = neutral_.cast<double>();
    const Weld weld = Weld::exact(stored);
    const Positions normals = unit_normals(stored, faces.triangles, weld);
    normals_ = layout_.add(put(float_bytes(normals.data(), normals.size()), kVertexData),
                           kFloatType, "VEC3", vertices);
    if (auto texture = texture_of_vertices(faces)) {
      // glTF's origin is the upper left corner.
      for (Eigen::Vector2d& coordinates : *texture) coordinates.y() = 1 - coordinates.y();
      texture_ = layout_.add(
          put(float_bytes(texture->front().data(), 2 * static_cast<Eigen::Index>(texture->size())),
              kVertexData),
          kFloatType, "VEC2", vertices);
    }
    for (std::size_t j = 0; j < names_.size(); ++j) {
      context.report(static_cast<double>(j) / static_cast<double>(names_.size()));
      if (plan.displacements) {
        const double* displacements = plan.displacements->col(static_cast<Eigen::Index>(j)).data();
        add_known_target(displacements, put);
        const Positions moved = Eigen::Map<const Positions>(displacements, stored.rows(), 3)
                                    .cast<float>()
                                    .cast<double>();
        add_target_normals(unit_normals(stored + moved, faces.triangles, weld) - normals, put);
      } else {
        views_of_targets_.push_back(layout_.add_view(12 * vertices, kVertexData));
        accessors_of_targets_.push_back(
            layout_.add(views_of_targets_.back(), kFloatType, "VEC3", vertices));
        layout_.set_bounds(accessors_of_targets_.back(), kUnknownBounds);
        bounds_.push_back(kUnknownBounds);
      }
    }
    if (plan.weights.rows() > 0) add_weights(plan, put);
    return known;
  }

  template <typename Put>
  void add_known_target(const double* displacements, const Put& put) {
    const auto vertices = static_cast<std::size_t>(neutral_.rows());
    const auto sparse = sparse_numbers(displacements, neutral_.rows(), 3);
    std::size_t accessor = 0;
    if (sparse) {
      const std::size_t indices = put(sparse->indices), values = put(sparse->values);
      accessor = layout_.add_sparse(kFloatType, "VEC3", vertices, sparse->stored, indices, values);
    } else {
      accessor = layout_.add(put(float_bytes(displacements, neutral_.size()), kVertexData),
                             kFloatType, "VEC3", vertices);
    }
    GltfBounds bounds = kUnknownBounds;
    for (Eigen::Index v = 0; v < neutral_.rows(); ++v) {
      const std::array<float, 3> xyz = {static_cast<float>(displacements[3 * v]),
                                        static_cast<float>(displacements[3 * v + 1]),
                                        static_cast<float>(displacements[3 * v + 2])};
      include(bounds, v, xyz.data());
    }
    layout_.set_bounds(accessor, bounds);
    accessors_of_targets_.push_back(accessor);
  }

  /// Adds changes of normals as bytes, or in single precision if a component changes by more than
  /// 1. That requires a turn of more than 60 degrees.
  template <typename Put>
  void add_target_normals(const Positions& changes, const Put& put) {
    const auto vertices = static_cast<std::size_t>(changes.rows());
    if (changes.cwiseAbs().maxCoeff() > 1) {
      normals_of_targets_.push_back(
          layout_.add(put(float_bytes(changes.data(), changes.size()), kVertexData), kFloatType,
                      "VEC3", vertices));
      return;
    }
    NormalBytes bytes = normal_bytes(changes);
    const std::size_t indices = put(std::move(bytes.indices)),
                      values = put(std::move(bytes.values));
    normals_of_targets_.push_back(
        layout_.add_sparse(kByteType, "VEC3", vertices, bytes.stored, indices, values));
    layout_.set_normalized(normals_of_targets_.back());
    is_quantized_ = true;
  }

  template <typename Put>
  void add_weights(const Plan& plan, const Put& put) {
    const Eigen::VectorXd& times = plan.header.times;
    const auto frames = static_cast<std::size_t>(times.size());
    times_ =
        layout_.add(put(float_bytes(times.data(), times.size())), kFloatType, "SCALAR", frames);
    layout_.set_bounds(*times_, static_cast<double>(static_cast<float>(times[0])),
                       static_cast<double>(static_cast<float>(times[times.size() - 1])));
    const auto count = static_cast<std::size_t>(plan.weights.size());
    if (const auto sparse = sparse_numbers(plan.weights.data(), plan.weights.size(), 1)) {
      const std::size_t indices = put(sparse->indices), values = put(sparse->values);
      weights_ = layout_.add_sparse(kFloatType, "SCALAR", count, sparse->stored, indices, values);
    } else {
      weights_ = layout_.add(put(float_bytes(plan.weights.data(), plan.weights.size())), kFloatType,
                             "SCALAR", count);
    }
  }

  std::string json() const {
    Json primitive = {{"attributes", {{"POSITION", positions_}, {"NORMAL", normals_}}},
                      {"indices", faces_}};
    if (texture_) primitive["attributes"]["TEXCOORD_0"] = *texture_;
    for (std::size_t j = 0; j < accessors_of_targets_.size(); ++j) {
      primitive["targets"].push_back({{"POSITION", accessors_of_targets_[j]}});
      if (!normals_of_targets_.empty()) {
        primitive["targets"].back()["NORMAL"] = normals_of_targets_[j];
      }
    }
    if (has_polygons_) primitive["extensions"]["FB_ngon_encoding"] = Json::object();
    Json mesh = {{"name", name_}, {"primitives", Json::array({primitive})}};
    if (!names_.empty()) mesh["extras"] = {{"targetNames", names_}};
    Json root = {{"asset", {{"version", "2.0"}, {"generator", "mimetra"}}}};
    if (!rest_is_known_) root["asset"]["extras"] = {{"restIsFirstFrame", true}};
    if (has_polygons_) root["extensionsUsed"].push_back("FB_ngon_encoding");
    if (is_quantized_) {
      root["extensionsUsed"].push_back("KHR_mesh_quantization");
      root["extensionsRequired"] = {"KHR_mesh_quantization"};
    }
    root["scene"] = 0;
    root["scenes"] = Json::array({{{"nodes", {0}}}});
    root["nodes"] = Json::array({{{"name", name_}, {"mesh", 0}}});
    root["meshes"] = Json::array({mesh});
    if (times_) {
      const Json sampler = {{"input", *times_}, {"interpolation", "LINEAR"}, {"output", weights_}};
      const Json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
      root["animations"] = Json::array(
          {{{"name", "performance"}, {"samplers", {sampler}}, {"channels", {channel}}}});
    }
    root["accessors"] = layout_.accessors();
    root["bufferViews"] = layout_.views();
    Json buffer = {{"byteLength", layout_.bytes()}};
    if (!is_binary_) buffer["uri"] = uri_of(data_path().filename().string());
    root["buffers"] = Json::array({buffer});
    return root.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

  /// Returns a file's name as a URI. [RFC 3986, 2.3]
  static std::string uri_of(const std::string& name) {
    std::string uri;
    for (const char c : name) {
      const bool is_plain = is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                            c == '-' || c == '.' || c == '_' || c == '~';
      constexpr const char* kDigits = "0123456789ABCDEF";
      const auto byte = static_cast<unsigned char>(c);
      uri +=
          is_plain ? std::string(1, c) : std::string{'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
    return uri;
  }

  void check_length() {
    // The bounds still have their longest text.
    json_room_ = (json().size() + 3) / 4 * 4;
    const std::size_t length = kHead + json_room_ + kChunkHead + layout_.bytes();
    constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (!is_binary_ || length <= kMost) return;
    throw MismatchError(target_.string() + ": would have " + std::to_string(length) +
                        " bytes, and a .glb holds no more than " + std::to_string(kMost) +
                        "; write .gltf, .npz or .pvd");
  }

  void write_view(std::size_t view, const std::string& content) const {
    const std::size_t start = is_binary_ ? kHead + json_room_ + kChunkHead : 0;
    file_->write_at(start + layout_.offset(view), content);
  }

  fs::path target_;
  bool is_binary_;
  std::vector<std::string> names_;
  bool has_polygons_;
  std::string name_;
  bool rest_is_known_, is_quantized_ = false;
  Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> neutral_;
  GltfLayout layout_;
  std::size_t faces_ = 0, positions_ = 0, normals_ = 0, weights_ = 0, json_room_ = 0;
  std::optional<std::size_t> texture_, times_;
  std::vector<std::size_t> views_of_targets_, accessors_of_targets_, normals_of_targets_;
  std::vector<GltfBounds> bounds_;
  PendingOutputs outputs_;
  fs::path json_path_;
  std::unique_ptr<OutputFile> file_;
  std::vector<fs::path> extra_files_;
};

/// True if the only frame is the rest pose, so that nothing moves.
bool stands_still(const SequenceHeader& header) {
  return header.times.size() == 1 && header.times[0] == 0 && !header.rest_is_known;
}

GltfFile::Plan plan_of_frames(const SequenceHeader& header) {
  GltfFile::Plan plan{header, {}, nullptr, {}};
  const auto frames = static_cast<int>(header.times.size());
  if (stands_still(header)) return plan;
  for (int frame = 0; frame < frames; ++frame) {
    plan.targets.push_back(frame_name(frame, frames, ""));
  }
  plan.weights = Frames::Identity(frames, frames);
  return plan;
}

class GltfFrames : public FrameSink {
 public:
  GltfFrames(const SequenceHeader& header, const fs::path& target, const WriteOptions& options,
             const Context& context)
      : target_(target),
        longest_(extent(header.rest)),
        is_still_(stands_still(header)),
        file_(plan_of_frames(header), target, options, context) {}

  void write(int first, const Frames& poses) override {
    check_single_range(target_, first, poses);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), poses.cols() / 3, 3);
      check_single_precision(target_, pose, longest_);
      if (is_still_) continue;
      const Positions displacements = pose - file_.neutral().cast<double>();
      file_.write_target(first + static_cast<int>(row), displacements.data());
    }
  }

  std::vector<fs::path> commit() override { return file_.commit(); }

 private:
  fs::path target_;
  double longest_;
  bool is_still_;
  GltfFile file_;
};

std::vector<fs::path> write_driven(const SequenceHeader& header, const ShapeBasis& expressions,
                                   const Eigen::MatrixXd& weights, const fs::path& target,
                                   const WriteOptions& options, const Context& context) {
  const GltfFile::Plan plan{header, expressions.names, &expressions.displacements, weights};
  return GltfFile(plan, target, options, context).commit();
}

}  // namespace

std::unique_ptr<FrameSink> begin_gltf(const SequenceHeader& header, const fs::path& target,
                                      const WriteOptions& options, const Context& context) {
  if (header.times.size() > kMostGltfFrames) {
    throw MismatchError(target.string() + ": " + std::to_string(header.times.size()) +
                        " frames that no model drives would be as many morph targets, expected " +
                        std::to_string(kMostGltfFrames) +
                        " at most; write .pc2, .npz or .pvd, or a part with option 'frames'");
  }
  return std::make_unique<GltfFrames>(header, target, options, context);
}

std::vector<fs::path> write_gltf(const Animation& animation, const fs::path& target,
                                 const WriteOptions& options, const Context& context) {
  return write_driven(animation.header(), animation.model().expressions(), animation.weights(),
                      target, options, context);
}

std::vector<fs::path> write_gltf_model(const MorphableModel& model, const WeightTrack& performance,
                                       const fs::path& target, const WriteOptions& options,
                                       const Context& context) {
  if (model.identities().size() > 0) {
    throw MismatchError(target.string() + ": the model has " +
                        std::to_string(model.identities().size()) +
                        " identities, for which glTF has no place; write a folder");
  }
  SequenceHeader header{model.shared_connectivity(), performance.times, model.mean(), true};
  Eigen::MatrixXd weights;
  if (!performance.names.empty()) weights = weights_for(performance, model.expressions().names);
  if (header.times.size() == 0) header.times = default_times(static_cast<int>(weights.rows()));
  return write_driven(header, model.expressions(), weights, target, options, context);
}

}  // namespace mimetra
