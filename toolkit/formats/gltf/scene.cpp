#include "toolkit/formats/gltf/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "toolkit/io/frame_times.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

/// Shorter interval between an element of rising times and its neighbours; infinite if there is no
/// other element.
template <typename Times, typename Iterator>
double shorter_interval(const Times& times, Iterator at) {
  double shortest = std::numeric_limits<double>::infinity();
  if (at != times.begin()) shortest = *at - *std::prev(at);
  if (std::next(at) != times.end()) shortest = std::min(shortest, *std::next(at) - *at);
  return shortest;
}

/// Whether two times differ only by rounding, as in curves of one take that were resampled
/// separately. `interval` is the shortest from either time to the next key, in seconds.
bool is_same_time(double a, double b, double interval) {
  constexpr double kSeconds = 2e-6;
  constexpr double kSinglePrecision = 2.4e-7;  // relative: two units in the last place
  // Limit relative to the interval. For a time of day in the evening, a unit in the last place is
  // half a frame at 60 a second.
  constexpr double kShare = 0.01;
  const double rounding = std::max(kSeconds, kSinglePrecision * std::abs(a));
  return std::abs(a - b) <= std::min(rounding, kShare * interval);
}

/// Key of a curve, and the fraction of the way to the next one.
struct KeyPlace {
  Eigen::Index key;
  double share;
};

KeyPlace key_place(const Eigen::VectorXd& times, double time) {
  const double* after = std::upper_bound(times.data(), times.data() + times.size(), time);
  const Eigen::Index next = after - times.data();
  const auto is_at = [&](Eigen::Index key) {
    return is_same_time(times[key], time, shorter_interval(times, times.begin() + key));
  };
  if (next > 0 && is_at(next - 1)) return {next - 1, 0};
  if (next == 0 || (next < times.size() && is_at(next))) return {next, 0};
  if (next == times.size()) return {next - 1, 0};
  return {next - 1, (time - times[next - 1]) / (times[next] - times[next - 1])};
}

/// Number of equal steps between two keys that shows a curve as finely as the default frame rate.
double steps_between(double key, double next) {
  // A third of a frame does not add a step, since keys are in single precision.
  constexpr double kAllowance = 1. / 3;
  return std::max(1., std::ceil((next - key) * kDefaultFramesPerSecond - kAllowance));
}

/// Keys of a curve, ascending. Cubic curves also get times between the keys, since they are not
/// linear there.
std::vector<double> shown_times(const std::string& path, const WeightCurve& curve) {
  const Eigen::VectorXd& keys = curve.times;
  std::vector<double> times(keys.begin(), keys.end());
  if (curve.between != WeightCurve::Between::cubic || times.empty()) return times;
  double most = 0;
  for (Eigen::Index k = 1; k < keys.size(); ++k) most += steps_between(keys[k - 1], keys[k]);
  constexpr double kMostFrames = 1e6;
  if (most > kMostFrames) {
    throw IoError(path, "an animation of weights on splines lasts " +
                            readable(keys[keys.size() - 1] - keys[0], 8) + " s; expected at most " +
                            readable(kMostFrames, 8) + " frames of it");
  }
  times.erase(times.begin() + 1, times.end());
  for (Eigen::Index k = 1; k < keys.size(); ++k) {
    const double steps = steps_between(keys[k - 1], keys[k]);
    for (double step = 1; step < steps; ++step) {
      times.push_back(keys[k - 1] + step / steps * (keys[k] - keys[k - 1]));
    }
    times.push_back(keys[k]);
  }
  return times;
}

/// Adds a frame before each jump of a step curve, up to which its value stays, unless there is one.
void add_times_before_jumps(const WeightCurve& curve, std::set<double>& times) {
  constexpr double kLongestFrame = 1. / 20;  // seconds; another curve's frame this close suffices
  const Eigen::VectorXd& keys = curve.times;
  for (Eigen::Index k = 1; k < keys.size(); ++k) {
    const double steps = steps_between(keys[k - 1], keys[k]);
    if (steps < 2 || curve.values.row(k) == curve.values.row(k - 1)) continue;
    const auto next = times.lower_bound(keys[k] - kLongestFrame);
    const bool has_frame = next != times.end() && *next < keys[k] && key_place(keys, *next).key < k;
    if (!has_frame) times.insert(keys[k] - (keys[k] - keys[k - 1]) / steps);
  }
}

/// Ascending times of the frames that show all curves: their keys, and times between the keys of
/// cubic curves, at the default frame rate. Keys that differ only by rounding take the first
/// curve's time. Step curves add a frame before each jump, unless another curve has one there.
/// Throws IoError with `path` if a cubic curve lasts too long.
Eigen::VectorXd shown_times(const std::string& path,
                            const std::vector<const WeightCurve*>& curves) {
  std::set<double> times;
  for (const WeightCurve* curve : curves) {
    const std::vector<double> own = shown_times(path, *curve);
    std::vector<double> added;
    for (auto time = own.begin(); time != own.end(); ++time) {
      const double interval = shorter_interval(own, time);
      const auto is_it = [&](std::set<double>::const_iterator known) {
        return is_same_time(*known, *time, std::min(interval, shorter_interval(times, known)));
      };
      const auto next = times.lower_bound(*time);
      const bool is_known =
          (next != times.end() && is_it(next)) || (next != times.begin() && is_it(std::prev(next)));
      if (!is_known) added.push_back(*time);
    }
    times.insert(added.begin(), added.end());
  }
  for (const WeightCurve* curve : curves) {
    if (curve->between == WeightCurve::Between::step) add_times_before_jumps(*curve, times);
  }
  Eigen::VectorXd all(static_cast<Eigen::Index>(times.size()));
  std::copy(times.begin(), times.end(), all.begin());
  return all;
}

}  // namespace

bool WeightCurve::is_still() const {
  const bool is_level = between != Between::cubic || (slopes_in.isZero(0) && slopes_out.isZero(0));
  return is_level && (values.rowwise() - values.row(0)).isZero(0);
}

Eigen::RowVectorXd WeightCurve::at(double time) const {
  if (times.size() == 0) return values.row(0);
  const auto [key, share] = key_place(times, time);
  if (share == 0 || between == Between::step) return values.row(key);
  if (between == Between::linear) {
    return (1 - share) * values.row(key) + share * values.row(key + 1);
  }
  // Hermite polynomials. [glTF 2.0, appendix C.5]
  const double step = times[key + 1] - times[key];
  const double square = share * share, cube = square * share;
  return (2 * cube - 3 * square + 1) * values.row(key) +
         step * (cube - 2 * square + share) * slopes_out.row(key) +
         (3 * square - 2 * cube) * values.row(key + 1) +
         step * (cube - square) * slopes_in.row(key + 1);
}

namespace {

/// Targets with the same name and the same weights over time, from any part.
struct JoinedExpression {
  std::string name;
  Eigen::VectorXd weights;                        ///< one for each frame
  std::vector<std::pair<std::size_t, int>> from;  ///< part, target
  /// Earlier expression that this one belongs to if weights other than the file's drive both.
  std::optional<std::size_t> joins = {};
};

/// Gathers targets by name.
class ExpressionList {
 public:
  /// `names` are the names of all targets; renamed targets get none of them.
  explicit ExpressionList(std::set<std::string> names) : of_targets_(std::move(names)) {}

  void add(std::size_t part, const std::string& part_name, int target, const std::string& name,
           const Eigen::VectorXd& weights) {
    constexpr double kRounding = 1e-6;
    Namesakes& namesakes = by_name_[name];
    std::set<std::size_t>& moving = namesakes.moving[part];
    // Two targets with one name in one mesh stay two.
    const bool all_move = moving.size() == namesakes.wholes;
    for (const std::size_t index : namesakes.expressions) {
      if (all_move) break;
      JoinedExpression& expression = expressions[index];
      if (moving.contains(whole_of(index))) continue;
      if (!(expression.weights - weights).isZero(kRounding)) continue;
      expression.from.emplace_back(part, target);
      moving.insert(whole_of(index));
      return;
    }
    std::string free = name;
    const auto is_taken = [&] {
      return (free != name && of_targets_.contains(free)) || !names_.insert(free).second;
    };
    for (; is_taken(); ++namesakes.next) free = name + '_' + std::to_string(namesakes.next);
    JoinedExpression expression{free, weights, {{part, target}}, {}};
    if (!all_move) expression.joins = joined_by(namesakes, moving);
    if (!expression.joins) ++namesakes.wholes;
    moving.insert(expression.joins.value_or(expressions.size()));
    if (free != name) {
      (expression.joins ? renamed_in_take : renamed)
          .push_back("'" + name + "' of '" + part_name + "' is '" + free + "'");
    }
    namesakes.expressions.push_back(expressions.size());
    expressions.push_back(std::move(expression));
  }

  std::vector<JoinedExpression> expressions;
  std::vector<std::string> renamed, renamed_in_take;

 private:
  struct Namesakes {
    std::vector<std::size_t> expressions;
    std::size_t wholes = 0;  ///< expressions of the model, which join no other
    /// For each part, the wholes that already move it, directly or through an expression that joins
    /// them.
    std::map<std::size_t, std::set<std::size_t>> moving = {};
    int next = 2;  ///< number for the next one that gets another name
  };

  std::size_t whole_of(std::size_t expression) const {
    return expressions[expression].joins.value_or(expression);
  }

  /// First whole of a name that does not move the part yet.
  std::optional<std::size_t> joined_by(const Namesakes& namesakes,
                                       const std::set<std::size_t>& moving) const {
    for (const std::size_t index : namesakes.expressions) {
      if (!expressions[index].joins && !moving.contains(index)) return index;
    }
    return std::nullopt;
  }

  std::map<std::string, Namesakes> by_name_;
  std::set<std::string> of_targets_, names_;
};

/// Weights of a part's targets in all frames (frames x targets); 0 if the part has none.
Eigen::MatrixXd weights_at(const ScenePart& part, const Eigen::VectorXd& times, int frames) {
  const auto targets = static_cast<Eigen::Index>(part.targets.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(frames, targets);
  if (!part.weights) return weights;
  for (int frame = 0; frame < frames; ++frame) {
    weights.row(frame) = part.weights->at(times.size() > 0 ? times[frame] : 0).head(targets);
  }
  return weights;
}

bool is_animated(const ScenePart& part) {
  return part.weights && part.weights->times.size() > 0;
}

/// Gathers animated parts first, so that their targets keep their names.
ExpressionList expressions_of(const std::vector<ScenePart>& parts, const Eigen::VectorXd& times,
                              int frames) {
  std::set<std::string> names;
  for (const ScenePart& part : parts) {
    for (const SceneTarget& target : part.targets) names.insert(target.name);
  }
  ExpressionList list(std::move(names));
  for (const bool animated : {true, false}) {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (is_animated(parts[p]) != animated) continue;
      const Eigen::MatrixXd weights = weights_at(parts[p], times, frames);
      for (int j = 0; j < weights.cols(); ++j) {
        list.add(p, parts[p].name, j, parts[p].targets[static_cast<std::size_t>(j)].name,
                 weights.col(j));
      }
    }
  }
  return list;
}

/// Names of parts whose unnamed targets share an expression with another mesh's.
std::vector<std::string> united_by_number(const std::vector<ScenePart>& parts,
                                          const std::vector<JoinedExpression>& expressions) {
  using MeshOfPart = std::map<std::size_t, std::size_t>;
  std::map<std::size_t, MeshOfPart> unnamed;  // of each expression
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    for (const auto& [p, target] : expressions[j].from) {
      const auto mesh = parts[p].targets[static_cast<std::size_t>(target)].unnamed_in;
      if (mesh) unnamed[expressions[j].joins.value_or(j)].emplace(p, *mesh);
    }
  }
  std::set<std::size_t> united;
  for (const auto& [expression, meshes] : unnamed) {
    const std::size_t first = meshes.begin()->second;
    const bool is_one =
        std::ranges::all_of(meshes, [&](const auto& part) { return part.second == first; });
    if (is_one) continue;
    for (const auto& [p, mesh] : meshes) united.insert(p);
  }
  std::vector<std::string> names;
  names.reserve(united.size());
  for (const std::size_t p : united) names.push_back("'" + parts[p].name + "'");
  return names;
}

/// Targets that the file shows at a constant weight other than 0, such as "'fatFace' at 1".
std::vector<std::string> standing_weights(const std::vector<ScenePart>& parts) {
  std::vector<std::string> standing;
  std::set<std::string> known;
  for (const ScenePart& part : parts) {
    if (!part.weights || is_animated(part)) continue;
    for (std::size_t j = 0; j < part.targets.size(); ++j) {
      const double weight = part.weights->values(0, static_cast<Eigen::Index>(j));
      if (weight == 0 || !known.insert(part.targets[j].name).second) continue;
      standing.push_back("'" + part.targets[j].name + "' at " + readable(weight));
    }
  }
  return standing;
}

/// All curves, each once; many parts may share one.
std::vector<const WeightCurve*> all_curves(const std::vector<ScenePart>& parts) {
  std::vector<const WeightCurve*> curves;
  std::set<const WeightCurve*> known;
  for (const ScenePart& part : parts) {
    if (part.weights && known.insert(part.weights.get()).second) {
      curves.push_back(part.weights.get());
    }
  }
  return curves;
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

/// Name as a single word of an OBJ file.
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

std::vector<std::string> notes_of(const std::string& path, const std::vector<ScenePart>& parts,
                                  const ExpressionList& list) {
  std::vector<std::string> notes;
  if (!list.renamed.empty()) {
    notes.push_back(path +
                    ": targets of one name that are not one expression: " + listed(list.renamed));
  }
  const std::vector<std::string> united = united_by_number(parts, list.expressions);
  if (!united.empty()) {
    notes.push_back(path +
                    ": targets without names are taken for one expression where they have the same "
                    "number in their meshes; name them (extras.targetNames) where they are not: " +
                    listed(united));
  }
  return notes;
}

/// Throws IoError for positions that are not usable, which a node's transform can produce from
/// finite ones.
void check_positions(const std::string& path, const ScenePart& part) {
  const auto check = [&](const Positions& positions, const std::string& of) {
    const Eigen::Index v = first_unusable(positions);
    if (v < 0) return;
    throw IoError(path, "mesh '" + part.name + "'" + of + ": vertex " + std::to_string(v) +
                            " has no usable position");
  };
  check(part.positions, "");
  for (const SceneTarget& target : part.targets) {
    check(target.displacements, ", target '" + target.name + "'");
  }
}

/// Displacements of the joined parts, with one column for each expression.
ShapeBasis joined_basis(std::vector<ScenePart> parts,
                        const std::vector<JoinedExpression>& expressions, Eigen::Index vertices) {
  std::vector<Eigen::Index> first;
  Eigen::Index at = 0;
  for (const ScenePart& part : parts) {
    first.push_back(at);
    at += part.positions.rows();
  }
  const auto count = static_cast<Eigen::Index>(expressions.size());
  ShapeBasis basis{{}, Eigen::MatrixXd::Zero(3 * vertices, count)};
  for (Eigen::Index j = 0; j < count; ++j) {
    const JoinedExpression& expression = expressions[static_cast<std::size_t>(j)];
    basis.names.push_back(expression.name);
    for (const auto& [p, target] : expression.from) {
      Positions& field = parts[p].targets[static_cast<std::size_t>(target)].displacements;
      basis.displacements.col(j).segment(3 * first[p], field.size()) =
          Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
      field.resize(0, 3);
    }
  }
  return basis;
}

/// Basis of the model, in which expressions that join others are added to them.
ShapeBasis basis_of_model(const ShapeBasis& take,
                          const std::vector<JoinedExpression>& expressions) {
  std::vector<Eigen::Index> own;
  ShapeBasis basis;
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    if (expressions[j].joins) continue;
    own.push_back(static_cast<Eigen::Index>(j));
    basis.names.push_back(expressions[j].name);
  }
  basis.displacements = take.displacements(Eigen::all, own);
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    if (!expressions[j].joins) continue;
    const auto whole = static_cast<Eigen::Index>(*expressions[j].joins);
    basis.displacements.col(std::ranges::find(own, whole) - own.begin()) +=
        take.displacements.col(static_cast<Eigen::Index>(j));
  }
  return basis;
}

}  // namespace

void check_scene_size(const std::string& path, double vertices, double poses,
                      std::size_t file_bytes) {
  // A few thousand sparse targets of a large head take some hundred times the size of their file.
  constexpr double kLeast = 1 << 30, kMostOfFile = 512;
  constexpr double kMostVertices = 7e8;  // three coordinates each, counted by an int
  const double bytes = vertices * poses * 3 * sizeof(double);
  const double most = std::max(kLeast, kMostOfFile * static_cast<double>(file_bytes));
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
    check_positions(path, part);
    vertices += part.positions.rows();
    targets += static_cast<double>(part.targets.size());
  }
  const std::vector<const WeightCurve*> curves = all_curves(parts);
  for (const WeightCurve* curve : curves) {
    check_times(path + ": an animation of weights", curve->times);
    still = still && curve->values.isZero(0);
  }
  Scene scene;
  const Eigen::VectorXd times = shown_times(path, curves);
  const int frames = times.size() > 0 ? static_cast<int>(times.size()) : still ? 0 : 1;
  check_scene_size(path, targets / 3, frames, file_bytes);
  const ExpressionList list = expressions_of(parts, times, frames);
  const auto count = static_cast<double>(list.expressions.size());
  check_scene_size(path, static_cast<double>(vertices), count + 1, file_bytes);
  scene.notes = notes_of(path, parts, list);
  if (!list.renamed_in_take.empty()) {
    scene.motion_notes.push_back(path +
                                 ": targets of one name in several meshes, whose weights differ: "
                                 "they are one expression of the model, and several where the "
                                 "file's own weights drive them: " +
                                 listed(list.renamed_in_take));
  }
  if (const std::vector<std::string> standing = standing_weights(parts); !standing.empty()) {
    scene.model_notes.push_back(
        path + ": its neutral is without weights that the file shows: " + listed(standing) +
        "; where they belong to the face itself, apply them to its mesh "
        "and export it again");
  }
  scene.times = times;
  scene.weights.resize(frames, static_cast<Eigen::Index>(list.expressions.size()));
  for (std::size_t j = 0; j < list.expressions.size(); ++j) {
    scene.weights.col(static_cast<Eigen::Index>(j)) = list.expressions[j].weights;
  }
  auto connectivity = joined_faces(path, parts, static_cast<int>(vertices));
  Positions neutral(vertices, 3);
  Eigen::Index at = 0;
  for (const ScenePart& part : parts) {
    neutral.middleRows(at, part.positions.rows()) = part.positions;
    at += part.positions.rows();
  }
  ShapeBasis basis = joined_basis(std::move(parts), list.expressions, vertices);
  if (!list.renamed_in_take.empty()) {
    scene.model = std::make_shared<const BlendshapeModel>(connectivity, neutral,
                                                          basis_of_model(basis, list.expressions));
  }
  scene.performer = std::make_shared<const BlendshapeModel>(std::move(connectivity),
                                                            std::move(neutral), std::move(basis));
  if (!scene.model) scene.model = scene.performer;
  return scene;
}

}  // namespace mimetra
