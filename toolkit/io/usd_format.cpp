#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_formats.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

template <typename Numbers>
std::string usd_list(const Numbers& numbers) {
  std::string text = "[";
  for (const auto number : numbers) {
    if (text.size() > 1) text += ", ";
    if constexpr (std::is_integral_v<decltype(number)>) {
      append_integer(text, number);
    } else {
      append_number(text, number, false);
    }
  }
  return text + ']';
}

/// `(x, y, z)` of `count` points, in single precision.
std::string usd_points(const double* xyz, Eigen::Index count) {
  std::string text = "[";
  text.reserve(static_cast<std::size_t>(count) * 36 + 2);
  for (Eigen::Index point = 0; point < count; ++point) {
    text += point == 0 ? "(" : ", (";
    for (Eigen::Index c = 0; c < 3; ++c) {
      if (c > 0) text += ", ";
      append_number(text, xyz[3 * point + c], false);
    }
    text += ')';
  }
  return text + ']';
}

std::string usd_text(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c == '\n' || c == '\r' || c == '\0' ? ' ' : c;
  }
  return text + '"';
}

std::string usd_names(const std::vector<std::string>& names) {
  std::string text = "[";
  for (const std::string& name : names) text += (text.size() > 1 ? ", " : "") + usd_text(name);
  return text + ']';
}

/// Time codes per second for which codes of even times are whole numbers.
double usd_rate(const Eigen::VectorXd& times) {
  const auto last = times.size() - 1;
  if (last < 1) return kDefaultFramesPerSecond;
  const double rate = static_cast<double>(last) / (times[last] - times[0]);
  const double even = std::round(1000 * rate) / 1000;
  return std::abs(even - rate) < 1e-6 * rate ? even : kDefaultFramesPerSecond;
}

/// The time code that reads back as `time`.
std::string usd_code(double time, double rate) {
  const double code = time * rate, whole = std::round(code);
  std::string text;
  append_number(text, whole / rate == time ? whole : code);
  return text;
}

std::string usd_head(const SequenceHeader& header, const char* first_prim) {
  const Eigen::VectorXd& times = header.times;
  const double rate = usd_rate(times);
  std::string rate_text;
  append_number(rate_text, rate);
  return std::string("#usda 1.0\n(\n    defaultPrim = \"") + first_prim +
         "\"\n    startTimeCode = " + usd_code(times[0], rate) +
         "\n    endTimeCode = " + usd_code(times[times.size() - 1], rate) +
         "\n    timeCodesPerSecond = " + rate_text + "\n    upAxis = \"" +
         (header.z_is_up ? "Z" : "Y") + "\"\n)\n\n";
}

/// Faces and texture coordinates of a mesh.
std::string usd_faces(const Connectivity& faces) {
  std::vector<int> counts;
  for (int face = 0; face < faces.polygons.size(); ++face) {
    const auto at = static_cast<std::size_t>(face);
    counts.push_back(faces.polygons.offsets[at + 1] - faces.polygons.offsets[at]);
  }
  std::string text = "    int[] faceVertexCounts = " + usd_list(counts) +
                     "\n    int[] faceVertexIndices = " + usd_list(faces.polygons.corners) +
                     "\n    uniform token subdivisionScheme = \"none\"\n";
  TextureCoordinates texture = faces.texture;
  if (!has_texture(faces)) return text;
  const auto none = static_cast<int>(texture.coordinates.size());
  if (std::ranges::any_of(texture.corners, [](int i) { return i < 0; })) {
    texture.coordinates.emplace_back(0, 0);
    std::ranges::replace_if(
        texture.corners, [](int i) { return i < 0; }, none);
  }
  text += "    texCoord2f[] primvars:st = [";
  for (std::size_t i = 0; i < texture.coordinates.size(); ++i) {
    text += i == 0 ? "(" : ", (";
    append_number(text, texture.coordinates[i].x(), false);
    text += ", ";
    append_number(text, texture.coordinates[i].y(), false);
    text += ')';
  }
  return text +
         "] (\n        interpolation = \"faceVarying\"\n    )\n    int[] primvars:st:indices = " +
         usd_list(texture.corners) + '\n';
}

/// A text file, with others beside it, that appears when it is whole.
class UsdFile {
 public:
  UsdFile(const fs::path& target, const SequenceWriteOptions& options, const ExtraFiles& extra)
      : outputs_(options.overwrite, options.inputs, options.together),
        file_(outputs_.add(target, PendingOutput::Kind::file)),
        files_{target} {
    add_extra_beside(outputs_, target, extra, files_);
  }

  void write(const std::string& text) { file_.write({text}); }
  std::vector<fs::path> commit() {
    file_.close();
    outputs_.commit();
    return files_;
  }

 private:
  PendingOutputs outputs_;
  OutputFile file_;
  std::vector<fs::path> files_;
};

/// Poses as time samples of the points.
class UsdFrames : public FrameSink {
 public:
  UsdFrames(const SequenceHeader& header, const fs::path& target,
            const SequenceWriteOptions& options, const ExtraFiles& extra)
      : target_(target),
        times_(header.times),
        rate_(usd_rate(header.times)),
        longest_(extent(header.rest)),
        file_(target, options, extra) {
    std::string text = usd_head(header, "face") + "def Mesh \"face\"\n{\n";
    text += usd_faces(*header.connectivity);
    if (header.rest_is_known) {
      const Positions& rest = header.rest;
      check_single_precision(target, {rest.data(), rest.rows(), 3}, longest_);
      text += "    point3f[] points = " + usd_points(rest.data(), rest.rows()) + '\n';
    }
    file_.write(text + "    point3f[] points.timeSamples = {\n");
  }

  void write(int first, const Frames& poses) override {
    check_single_range(target_, first, poses);
    check_single_precision(target_, {poses.data(), poses.size() / 3, 3}, longest_);
    std::string text;
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      text += "        " + usd_code(times_[first + row], rate_) + ": " +
              usd_points(poses.row(row).data(), poses.cols() / 3) + ",\n";
    }
    const std::lock_guard lock(mutex_);
    waiting_.emplace(first, Waiting{static_cast<int>(poses.rows()), std::move(text)});
    for (auto next = waiting_.find(next_); next != waiting_.end(); next = waiting_.find(next_)) {
      file_.write(next->second.text);
      next_ += next->second.frames;
      waiting_.erase(next);
    }
  }

  std::vector<fs::path> commit() override {
    file_.write("    }\n}\n");
    return file_.commit();
  }

 private:
  /// Text of frames that come after some that are not written yet.
  struct Waiting {
    int frames;
    std::string text;
  };

  fs::path target_;
  Eigen::VectorXd times_;
  double rate_, longest_;
  UsdFile file_;
  std::mutex mutex_;
  std::map<int, Waiting> waiting_;
  int next_ = 0;
};

std::unique_ptr<FrameSink> begin_usd(const SequenceHeader& header, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra,
                                     const Context&) {
  return std::make_unique<UsdFrames>(header, target, options, extra);
}

/// A shape of those points that it moves.
std::string usd_shape(const std::string& name, const double* displacements, Eigen::Index vertices) {
  std::vector<int> points;
  std::vector<double> offsets;
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const double* xyz = displacements + 3 * v;
    if (static_cast<float>(xyz[0]) == 0 && static_cast<float>(xyz[1]) == 0 &&
        static_cast<float>(xyz[2]) == 0) {
      continue;
    }
    points.push_back(static_cast<int>(v));
    offsets.insert(offsets.end(), xyz, xyz + 3);
  }
  return "\n        def BlendShape \"" + name +
         "\"\n        {\n            uniform vector3f[] offsets = " +
         usd_points(offsets.data(), static_cast<Eigen::Index>(points.size())) +
         "\n            uniform int[] pointIndices = " + usd_list(points) + "\n        }\n";
}

/// Blendshapes and their weights over time. [UsdSkel]
std::vector<fs::path> write_usd(const Animation& animation, const fs::path& target,
                                const SequenceWriteOptions& options, const ExtraFiles& extra,
                                const Context& context) {
  const SequenceHeader& header = animation.header();
  const ShapeBasis& shapes = animation.model().expressions();
  const Positions& neutral = header.rest;
  check_single_precision(target, {neutral.data(), neutral.rows(), 3}, extent(neutral));
  UsdFile file(target, options, extra);
  std::string targets = "[";
  for (int j = 0; j < shapes.size(); ++j) {
    targets += std::string(j > 0 ? ", " : "") + "</face/mesh/" +
               frame_name(j, shapes.size(), "").replace(0, 5, "shape") + '>';
  }
  constexpr const char* kBinds =
      " (\n        prepend apiSchemas = [\"SkelBindingAPI\"]\n    )\n    {\n";
  file.write(usd_head(header, "face") + "def SkelRoot \"face\"\n{\n    def Mesh \"mesh\"" + kBinds +
             usd_faces(*header.connectivity) +
             "    point3f[] points = " + usd_points(neutral.data(), neutral.rows()) +
             "\n    uniform token[] skel:blendShapes = " + usd_names(shapes.names) +
             "\n    rel skel:blendShapeTargets = " + targets +
             "]\n    rel skel:skeleton = </face/skeleton>\n");
  for (int j = 0; j < shapes.size(); ++j) {
    context.report(static_cast<double>(j) / shapes.size());
    file.write(usd_shape(frame_name(j, shapes.size(), "").replace(0, 5, "shape"),
                         shapes.displacements.col(j).data(), neutral.rows()));
  }
  file.write(std::string("    }\n\n    def Skeleton \"skeleton\"") + kBinds +
             "        rel skel:animationSource = </face/skeleton/performance>\n\n"
             "        def SkelAnimation \"performance\"\n        {\n"
             "            uniform token[] blendShapes = " +
             usd_names(shapes.names) + "\n            float[] blendShapeWeights.timeSamples = {\n");
  const double rate = usd_rate(header.times);
  for (Eigen::Index frame = 0; frame < header.times.size(); ++frame) {
    const Eigen::RowVectorXf weights = animation.weights().row(frame).cast<float>();
    file.write("                " + usd_code(header.times[frame], rate) + ": " +
               usd_list(std::vector<float>(weights.begin(), weights.end())) + ",\n");
  }
  file.write("            }\n        }\n    }\n}\n");
  return file.commit();
}

}  // namespace

SequenceFormat usd_format() {
  SequenceFormat format{"USD text", {".usda"}, false, SequenceFormat::Precision::single,
                        open_scene, begin_usd};
  format.holds = {.polygons = true, .texture = HeldParts::Texture::corners, .bare_faces = false};
  format.write_animation = write_usd;
  return format;
}

}  // namespace mimetra
