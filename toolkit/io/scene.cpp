#include "toolkit/io/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "toolkit/io/sequence_parts.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Key number `key` of a curve and the part of the way to the next one.
struct KeyPlace {
  Eigen::Index key;
  double share;
};

KeyPlace key_place(const Eigen::VectorXd& times, double time) {
  const double* after = std::upper_bound(times.data(), times.data() + times.size(), time);
  const Eigen::Index next = after - times.data();
  if (next == 0) return {0, 0};
  if (next == times.size()) return {next - 1, 0};
  return {next - 1, (time - times[next - 1]) / (times[next] - times[next - 1])};
}

/// Targets of one name and one course of weights, wherever they are.
struct JoinedExpression {
  std::string name;
  Eigen::VectorXd weights;                        ///< one for each frame
  std::vector<std::pair<std::size_t, int>> from;  ///< part, target
};

/// Gathers targets by name.
class ExpressionList {
 public:
  void add(std::size_t part, const std::string& part_name, int target, const std::string& name,
           const Eigen::VectorXd& weights) {
    Namesakes& namesakes = by_name_[name];
    for (const std::size_t index : namesakes.expressions) {
      JoinedExpression& expression = expressions[index];
      // Two of one name in one mesh are two.
      if (expression.from.back().first == part || expression.weights != weights) continue;
      expression.from.emplace_back(part, target);
      return;
    }
    namesakes.expressions.push_back(expressions.size());
    std::string free = name;
    for (; !names_.insert(free).second; ++namesakes.next) {
      free = name + '_' + std::to_string(namesakes.next);
    }
    if (free != name) renamed.push_back("'" + name + "' of '" + part_name + "' is '" + free + "'");
    expressions.push_back({free, weights, {{part, target}}});
  }

  std::vector<JoinedExpression> expressions;
  std::vector<std::string> renamed;

 private:
  struct Namesakes {
    std::vector<std::size_t> expressions;
    int next = 2;  ///< the number of the next one that is not the same
  };

  std::map<std::string, Namesakes> by_name_;
  std::set<std::string> names_;
};

/// Many parts may share one.
std::set<const WeightCurve*> all_curves(const std::vector<ScenePart>& parts) {
  std::set<const WeightCurve*> curves;
  for (const ScenePart& part : parts) {
    if (part.weights) curves.insert(part.weights.get());
  }
  return curves;
}

/// How many equal steps between two keys show a curve no more coarsely than frames without times
/// are apart.
double steps_between(double key, double next) {
  // A third of a frame is no reason for another step: keys stand in single precision.
  constexpr double kAllowance = 1. / 3;
  return std::max(1., std::ceil((next - key) * kDefaultFramesPerSecond - kAllowance));
}

/// The keys of all curves, and times between those of splines, which move on a line nowhere.
Eigen::VectorXd shown_times(const std::string& path, const std::set<const WeightCurve*>& curves) {
  std::set<double> times;
  for (const WeightCurve* curve : curves) {
    const Eigen::VectorXd& keys = curve->times;
    times.insert(keys.begin(), keys.end());
    if (curve->between != WeightCurve::Between::cubic) continue;
    double most = 0;
    for (Eigen::Index k = 1; k < keys.size(); ++k) most += steps_between(keys[k - 1], keys[k]);
    constexpr double kMostFrames = 1e6;
    if (most > kMostFrames) {
      throw IoError(path, "an animation of weights on splines lasts " +
                              readable(keys[keys.size() - 1] - keys[0], 8) +
                              " s; expected at most " + readable(kMostFrames, 8) + " frames of it");
    }
    for (Eigen::Index k = 1; k < keys.size(); ++k) {
      const double steps = steps_between(keys[k - 1], keys[k]);
      for (double step = 1; step < steps; ++step) {
        times.insert(keys[k - 1] + step / steps * (keys[k] - keys[k - 1]));
      }
    }
  }
  Eigen::VectorXd all(static_cast<Eigen::Index>(times.size()));
  std::copy(times.begin(), times.end(), all.begin());
  return all;
}

/// Weights of a part's targets in all frames (frames x targets); 0 where nothing is said.
Eigen::MatrixXd weights_at(const ScenePart& part, const Eigen::VectorXd& times, int frames) {
  const auto targets = static_cast<Eigen::Index>(part.targets.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(frames, targets);
  if (!part.weights) return weights;
  for (int frame = 0; frame < frames; ++frame) {
    weights.row(frame) = part.weights->at(times.size() > 0 ? times[frame] : 0).head(targets);
  }
  return weights;
}

void append_texture(TextureCoordinates& all, TextureCoordinates part) {
  const auto shift = static_cast<int>(all.coordinates.size());
  for (const int corner : part.corners) all.corners.push_back(corner < 0 ? -1 : corner + shift);
  all.coordinates.insert(all.coordinates.end(), part.coordinates.begin(), part.coordinates.end());
}

void append_polygons(Polygons& all, const Polygons& part, int first_vertex) {
  const auto shift = static_cast<int>(all.corners.size());
  for (const int corner : part.corners) all.corners.push_back(corner + first_vertex);
  for (int face = 0; face < part.size(); ++face) {
    all.offsets.push_back(part.offsets[static_cast<std::size_t>(face) + 1] + shift);
  }
}

/// A name as one word of an OBJ file.
std::string as_word(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  }
  return name.empty() ? "unnamed" : name;
}

std::shared_ptr<const Connectivity> joined_faces(const std::string& path,
                                                 const std::vector<ScenePart>& parts,
                                                 int vertices) {
  Polygons polygons;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  int first_vertex = 0;
  for (const ScenePart& part : parts) {
    const int first_face = polygons.size();
    if (parts.size() > 1) groups.push_back({first_face, "g " + as_word(part.name)});
    for (const FaceGroup& group : part.groups) {
      groups.push_back({first_face + group.first_face, "usemtl " + as_word(group.statement)});
    }
    append_polygons(polygons, part.polygons, first_vertex);
    TextureCoordinates own = part.texture;
    own.corners.resize(part.polygons.corners.size(), -1);
    append_texture(texture, std::move(own));
    first_vertex += static_cast<int>(part.positions.rows());
  }
  try {
    Connectivity connectivity = Connectivity::from_polygons(vertices, std::move(polygons));
    if (!texture.coordinates.empty()) connectivity.texture = std::move(texture);
    connectivity.groups = std::move(groups);
    return std::make_shared<const Connectivity>(std::move(connectivity));
  } catch (const std::invalid_argument& error) {
    throw IoError(path, error.what());
  }
}

}  // namespace

Eigen::RowVectorXd WeightCurve::at(double time) const {
  if (times.size() == 0) return values.row(0);
  const auto [key, share] = key_place(times, time);
  if (share == 0 || between == Between::step) return values.row(key);
  if (between == Between::linear) {
    return (1 - share) * values.row(key) + share * values.row(key + 1);
  }
  // Hermite's polynomials. [glTF 2.0, appendix C.5]
  const double step = times[key + 1] - times[key];
  const double square = share * share, cube = square * share;
  return (2 * cube - 3 * square + 1) * values.row(key) +
         step * (cube - 2 * square + share) * slopes_out.row(key) +
         (3 * square - 2 * cube) * values.row(key + 1) +
         step * (cube - square) * slopes_in.row(key + 1);
}

void check_scene_size(const std::string& path, double vertices, double poses,
                      std::size_t file_bytes) {
  // A few thousand sparse targets of a large head take some hundred times their file.
  constexpr double kLeast = 1 << 30, kTimes = 512;
  constexpr double kMostVertices = 7e8;  // three coordinates each, counted by an int
  const double bytes = vertices * poses * 3 * sizeof(double);
  const double most = std::max(kLeast, kTimes * static_cast<double>(file_bytes));
  if (vertices <= kMostVertices && bytes <= most) return;
  throw IoError(path, readable(vertices, 8) + " vertices in " + readable(poses, 8) +
                          " poses would take " + readable(bytes / 1e9, 3) +
                          " GB, which a file of " + std::to_string(file_bytes) +
                          " bytes cannot mean");
}

Scene joined_scene(const std::string& path, std::vector<ScenePart> parts, std::size_t file_bytes) {
  if (parts.empty()) throw IoError(path, "holds no mesh of triangles");
  Eigen::Index vertices = 0;
  double targets = 0;
  bool still = true;
  for (const ScenePart& part : parts) {
    vertices += part.positions.rows();
    targets += static_cast<double>(part.targets.size());
  }
  const std::set<const WeightCurve*> curves = all_curves(parts);
  for (const WeightCurve* curve : curves) {
    check_times(path + ": an animation of weights", curve->times);
    still = still && curve->values.isZero(0);
  }
  Scene scene;
  const Eigen::VectorXd times = shown_times(path, curves);
  const int frames = times.size() > 0 ? static_cast<int>(times.size()) : still ? 0 : 1;
  check_scene_size(path, targets / 3, frames, file_bytes);
  ExpressionList list;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Eigen::MatrixXd weights = weights_at(parts[p], times, frames);
    for (int j = 0; j < weights.cols(); ++j) {
      list.add(p, parts[p].name, j, parts[p].targets[static_cast<std::size_t>(j)].name,
               weights.col(j));
    }
  }
  const auto count = static_cast<Eigen::Index>(list.expressions.size());
  check_scene_size(path, static_cast<double>(vertices), static_cast<double>(count) + 1, file_bytes);
  if (!list.renamed.empty()) {
    scene.notes.push_back(
        path + ": targets of one name that are not one expression: " + listed(list.renamed));
  }

  auto connectivity = joined_faces(path, parts, static_cast<int>(vertices));
  Positions neutral(vertices, 3);
  std::vector<Eigen::Index> first(parts.size());
  Eigen::Index at = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    first[p] = at;
    neutral.middleRows(at, parts[p].positions.rows()) = parts[p].positions;
    at += parts[p].positions.rows();
  }
  ShapeBasis basis{{}, Eigen::MatrixXd::Zero(3 * vertices, count)};
  scene.weights.resize(frames, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const JoinedExpression& expression = list.expressions[static_cast<std::size_t>(j)];
    basis.names.push_back(expression.name);
    scene.weights.col(j) = expression.weights;
    for (const auto& [p, target] : expression.from) {
      Positions& field = parts[p].targets[static_cast<std::size_t>(target)].displacements;
      basis.displacements.col(j).segment(3 * first[p], field.size()) =
          Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
      field.resize(0, 3);
    }
  }
  scene.times = times;
  scene.model = std::make_shared<const BlendshapeModel>(std::move(connectivity), std::move(neutral),
                                                        std::move(basis));
  return scene;
}

bool is_scene_file(const fs::path& path) {
  const std::string extension = lower_extension(path);
  std::error_code unreadable;
  if (fs::is_directory(path, unreadable)) return false;
  for (const char* known : {".glb", ".gltf", ".usda", ".usd", ".usdc", ".usdz"}) {
    if (extension == known) return true;
  }
  return false;
}

Scene read_scene(const fs::path& path) {
  return lower_extension(path).starts_with(".usd") ? read_usd(path) : read_gltf(path);
}

}  // namespace mimetra
