#include <algorithm>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "toolkit/io/scene.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/usd_prims.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

Eigen::Map<const Positions> as_points(const std::vector<double>& numbers) {
  return {numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3};
}

/// A mesh of the layer, where it stands, and what moves it.
struct UsdMesh {
  const UsdPrim* prim;
  UsdStack stack;
  ScenePart part;
  /// Whose transforms place it, and where it stands within: its own, or those of its skeleton.
  UsdStack placing = {};
  Eigen::Matrix4d bound = Eigen::Matrix4d::Identity();
  /// Time codes at which it is told by other than weights.
  std::set<double> codes = {};
  std::vector<double> weight_codes = {};
  bool rest_is_known = true;
};

class UsdReader {
 public:
  UsdReader(const fs::path& path, std::string_view text)
      : path_(path.string()), bytes_(text.size()), layer_(parse_usd(path_, text)) {
    rate_ = setting("timeCodesPerSecond", setting("framesPerSecond", 24));
    if (!(rate_ > 0) || std::isinf(rate_))
      throw IoError(path_, "has " + readable(rate_) + " time codes per second");
    const auto up = layer_.metadata.find("upAxis");
    z_is_up_ = up != layer_.metadata.end() && up->second.words == std::vector<std::string>{"Z"};
    if (z_is_up_) {
      notes_.push_back(path_ + ": its up axis is z; convert with option 'up' z-to-y turns it");
    }
    note_unit();
  }

  Scene read(const Context& context) {
    for (const UsdPrim& prim : layer_.prims) visit(prim, {});
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      context.report(static_cast<double>(i) / static_cast<double>(2 * meshes_.size()));
      fill(meshes_[i]);
    }
    const bool is_baked =
        std::ranges::any_of(meshes_, [](const UsdMesh& mesh) { return !mesh.codes.empty(); });
    std::vector<ScenePart> parts;
    parts.reserve(meshes_.size());
    for (const UsdMesh& mesh : meshes_) {
      parts.push_back(mesh.part);
      if (is_baked) parts.back().weights = nullptr;
    }
    Scene scene = joined_scene(path_, std::move(parts), bytes_);
    if (is_baked) bake(scene, context.part(0.5, 1));
    scene.z_is_up = z_is_up_;
    scene.files = {path_};
    scene.notes.insert(scene.notes.begin(), notes_.begin(), notes_.end());
    if (!left_out_.empty()) {
      scene.notes.push_back(path_ +
                            ": is left out: " + listed({left_out_.begin(), left_out_.end()}));
    }
    return scene;
  }

 private:
  [[noreturn]] void fail(int line, const std::string& message) const {
    usd_fail(path_, line, message);
  }

  double setting(const std::string& name, double fallback) const {
    const auto found = layer_.metadata.find(name);
    if (found == layer_.metadata.end() || found->second.numbers.empty()) return fallback;
    return found->second.numbers.front();
  }

  /// Positions stay as they are, and nothing that is written has a unit but glTF, by its rules.
  void note_unit() {
    const double metres = setting("metersPerUnit", 1);
    if (metres == 1 || !(metres > 0) || std::isinf(metres)) return;
    const std::string number = readable(metres, 6);
    notes_.push_back(
        path_ + ": its unit is " + number +
        " m (metersPerUnit) and positions are read as they are; convert with option 'scale' " +
        number + " makes metres, as glTF has them");
  }

  void visit(const UsdPrim& prim, UsdStack stack) {
    // What only adds to another layer, or is only a pattern for others.
    if (prim.specifier != "def") return;
    const auto active = prim.metadata.find("active");
    if (active != prim.metadata.end() && active->second.words == std::vector<std::string>{"false"})
      return;
    const std::string shown = prim.type + " '" + prim.name + "'";
    if (prim.type == "PointInstancer") fail(prim.line, shown + ": instances are not read");
    static const std::set<std::string> shapes = {
        "Sphere", "Cube",   "Cone",        "Cylinder",   "Capsule",       "Plane",  "BasisCurves",
        "Points", "Volume", "NurbsCurves", "NurbsPatch", "HermiteCurves", "TetMesh"};
    if (shapes.contains(prim.type)) left_out_.insert(shown);
    stack.push_back(&prim);
    if (prim.type == "SkelAnimation") animations_.emplace_back(path_of(stack), &prim);
    const bool is_hidden = usd_is_word(prim, "visibility", "invisible") ||
                           usd_is_word(prim, "purpose", "guide") ||
                           usd_is_word(prim, "purpose", "proxy");
    if (is_hidden) {
      left_out_.insert(shown + ", which is not shown");
      return;
    }
    if (prim.type == "Mesh") {
      if (!usd_property(prim, "points")) fail(prim.line, shown + " has no points");
      meshes_.push_back({&prim, stack, {}});
    }
    for (const UsdPrim& child : prim.children) visit(child, stack);
  }

  static std::string path_of(const UsdStack& stack) {
    std::string path;
    for (const UsdPrim* prim : stack) path += '/' + prim->name;
    return path;
  }

  /// Numbers of `property` at a time, of which there must be three for each vertex.
  Positions points_at(const UsdProperty& property, std::optional<double> time,
                      Eigen::Index vertices) const {
    const std::vector<double> numbers = usd_numbers(path_, property, time);
    if (vertices < 0 ? numbers.size() % 3 != 0 || numbers.empty()
                     : static_cast<Eigen::Index>(numbers.size()) != 3 * vertices) {
      fail(property.line,
           std::to_string(numbers.size()) + " numbers, expected " +
               (vertices < 0 ? "x, y and z of each point" : std::to_string(3 * vertices)));
    }
    return as_points(numbers);
  }

  void fill(UsdMesh& mesh) {
    const UsdPrim& prim = *mesh.prim;
    ScenePart& part = mesh.part;
    part.name = prim.name;
    const UsdProperty& points = usd_needed(path_, prim, "points");
    part.positions = points_at(points, std::nullopt, -1);
    fill_usd_faces(path_, prim, part);
    for (const auto& [time, value] : points.samples) mesh.codes.insert(time);
    mesh.rest_is_known = points.samples.empty() || points.has_value;
    bind(mesh);
    for (const UsdPrim* parent : mesh.placing) {
      for (const auto& [name, property] : parent->properties) {
        if (!name.starts_with("xformOp:")) continue;
        for (const auto& [time, value] : property.samples) mesh.codes.insert(time);
        mesh.rest_is_known = mesh.rest_is_known && (property.samples.empty() || property.has_value);
      }
    }
    const Eigen::Matrix4d world = world_of(mesh);
    if (world.topLeftCorner<3, 3>().determinant() < 0) turn_faces(part);
    place(part.positions, world, true);
    fill_targets(mesh, world);
  }

  /// A mesh that hangs on the joints of a skeleton stands where they hold it, wherever its own
  /// transform would put it. [UsdSkelBindingAPI]
  void bind(UsdMesh& mesh) {
    mesh.placing = mesh.stack;
    if (!usd_inherited(mesh.stack, "primvars:skel:jointIndices").property) return;
    const std::string name = "'" + mesh.prim->name + "'";
    const UsdOwned named = usd_inherited(mesh.stack, "skel:skeleton");
    const bool is_named = named.property && !named.property->value.words.empty();
    const std::string path = is_named ? named.property->value.words.front() : "";
    const UsdStack skeleton = is_named ? usd_stack_at(layer_, path, named.owner) : UsdStack();
    if (skeleton.empty() || skeleton.back()->type != "Skeleton") {
      notes_.push_back(path_ + ": " + name + " has joints and " +
                       (is_named ? "there is no Skeleton <" + path + ">" : "names no skeleton") +
                       ": its own transform places it");
      return;
    }
    left_out_.insert("the skeleton of " + name + ": it stands as it is bound");
    mesh.placing = skeleton;
    const UsdHold hold = usd_hold(path_, *skeleton.back(), mesh.stack, mesh.part.positions);
    mesh.bound = hold.bound;
    if (hold.elsewhere.empty()) return;
    notes_.push_back(path_ + ": " + name + " stands as a whole where joint '" + hold.joint +
                     "' holds it at rest; other joints would hold their vertices elsewhere: " +
                     listed(hold.elsewhere));
  }

  Eigen::Matrix4d world_of(const UsdMesh& mesh, std::optional<double> code = {}) const {
    return usd_world(path_, mesh.placing, code) * mesh.bound;
  }

  static void place(Positions& points, const Eigen::Matrix4d& world, bool moved) {
    points = (points * world.topLeftCorner<3, 3>().transpose()).eval();
    if (moved) points.rowwise() += world.topRightCorner<3, 1>().transpose();
  }

  void fill_targets(UsdMesh& mesh, const Eigen::Matrix4d& world) {
    const UsdProperty* names = usd_property(*mesh.prim, "skel:blendShapes");
    const UsdProperty* paths = usd_property(*mesh.prim, "skel:blendShapeTargets");
    if (!names || !paths) return;
    if (names->value.words.size() != paths->value.words.size()) {
      fail(names->line, std::to_string(names->value.words.size()) + " names of blendshapes for " +
                            std::to_string(paths->value.words.size()) + " of them");
    }
    const Eigen::Index vertices = mesh.part.positions.rows();
    check_scene_size(path_, static_cast<double>(vertices),
                     static_cast<double>(names->value.words.size()) + 1, bytes_);
    for (std::size_t j = 0; j < names->value.words.size(); ++j) {
      const UsdStack found = usd_stack_at(layer_, paths->value.words[j], mesh.stack);
      if (found.empty() || found.back()->type != "BlendShape") {
        fail(paths->line, "there is no BlendShape <" + paths->value.words[j] + ">");
      }
      SceneTarget target{names->value.words[j], displacements_of(*found.back(), vertices)};
      place(target.displacements, world, false);
      mesh.part.targets.push_back(std::move(target));
    }
    mesh.part.weights = weights_of(mesh, names->value.words);
  }

  Positions displacements_of(const UsdPrim& shape, Eigen::Index vertices) const {
    for (const auto& [name, property] : shape.properties) {
      if (!name.starts_with("inbetweens:")) continue;
      fail(property.line, "'" + name + "': shapes in between are not read");
    }
    const UsdProperty& offsets = usd_needed(path_, shape, "offsets");
    const UsdProperty* indices = usd_property(shape, "pointIndices");
    if (!indices) return points_at(offsets, std::nullopt, vertices);
    const std::vector<int> points = usd_integers(path_, *indices, "pointIndices");
    const Positions given =
        points_at(offsets, std::nullopt, static_cast<Eigen::Index>(points.size()));
    Positions displacements = Positions::Zero(vertices, 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i] >= vertices) {
        fail(indices->line,
             "point " + std::to_string(points[i]) + " of " + std::to_string(vertices));
      }
      displacements.row(points[i]) = given.row(static_cast<Eigen::Index>(i));
    }
    return displacements;
  }

  /// The animation that the mesh or its skeleton names, itself or by what they stand in; where
  /// nobody names any, the only one.
  const UsdPrim* animation_of(const UsdMesh& mesh) {
    for (UsdStack prim = mesh.stack; !prim.empty(); prim.pop_back()) {
      std::vector<UsdStack> naming = {prim};
      const UsdProperty* skeleton = usd_property(*prim.back(), "skel:skeleton");
      if (skeleton && !skeleton->value.words.empty()) {
        naming.push_back(usd_stack_at(layer_, skeleton->value.words.front(), prim));
      }
      for (const UsdStack& owner : naming) {
        if (owner.empty()) continue;
        const UsdProperty* source = usd_property(*owner.back(), "skel:animationSource");
        if (!source || source->value.words.empty()) continue;
        const UsdStack animation = usd_stack_at(layer_, source->value.words.front(), owner);
        if (!animation.empty()) return animation.back();
        fail(source->line, "there is no SkelAnimation <" + source->value.words.front() + ">");
      }
    }
    if (animations_.empty()) return nullptr;
    if (animations_.size() > 1) {
      notes_.push_back(path_ + ": '" + mesh.prim->name + "' names none of its " +
                       std::to_string(animations_.size()) + " animations; " +
                       animations_.front().first + " drives it");
    }
    return animations_.front().second;
  }

  std::shared_ptr<const WeightCurve> weights_of(UsdMesh& mesh,
                                                const std::vector<std::string>& names) {
    const UsdPrim* animation = animation_of(mesh);
    if (!animation) return nullptr;
    const UsdProperty* weights = usd_property(*animation, "blendShapeWeights");
    const UsdProperty* driven = usd_property(*animation, "blendShapes");
    for (const char* moved : {"rotations", "translations", "scales"}) {
      const UsdProperty* joints = usd_property(*animation, moved);
      if (joints && joints->samples.size() > 1) {
        left_out_.insert("the movement of joints of '" + animation->name + "'");
      }
    }
    if (!weights || !driven) return nullptr;
    std::vector<double> times;
    for (const auto& [time, value] : weights->samples) times.push_back(time);
    auto curve = std::make_shared<WeightCurve>();
    curve->times = Eigen::Map<const Eigen::VectorXd>(times.data(), Eigen::Index(times.size()));
    const std::size_t rows = std::max<std::size_t>(1, times.size());
    check_scene_size(path_, static_cast<double>(names.size()) / 3, static_cast<double>(rows),
                     bytes_);
    std::map<std::string, std::size_t> column;
    for (const std::string& name : driven->value.words) column.emplace(name, column.size());
    if (column.size() != driven->value.words.size()) fail(driven->line, "a name stands twice");
    curve->values = Eigen::MatrixXd::Zero(Eigen::Index(rows), Eigen::Index(names.size()));
    for (std::size_t row = 0; row < rows; ++row) {
      const std::vector<double>& given =
          times.empty() ? weights->value.numbers : weights->samples[row].second.numbers;
      check_numbers(path_, *weights, given);
      if (given.size() != driven->value.words.size()) {
        fail(weights->line, std::to_string(given.size()) + " weights for " +
                                std::to_string(driven->value.words.size()) + " blendshapes");
      }
      for (std::size_t j = 0; j < names.size(); ++j) {
        const auto found = column.find(names[j]);
        if (found == column.end()) continue;
        curve->values(Eigen::Index(row), Eigen::Index(j)) = given[found->second];
      }
    }
    curve->times /= rate_;
    mesh.weight_codes = std::move(times);
    return curve;
  }

  /// Frames of points and transforms that are told over time, with the weights on top.
  void bake(Scene& scene, const Context& context) const {
    std::map<double, double> codes;  // by their seconds, of which two codes may have the same
    const auto add = [&](double code) { codes.emplace(code / rate_, code); };
    bool rest_is_known = true;
    for (const UsdMesh& mesh : meshes_) {
      std::ranges::for_each(mesh.codes, add);
      std::ranges::for_each(mesh.weight_codes, add);
      rest_is_known = rest_is_known && mesh.rest_is_known;
    }
    const auto frames = static_cast<Eigen::Index>(codes.size());
    check_scene_size(path_, scene.model->vertices(), static_cast<double>(frames), bytes_);
    Frames poses(frames, 3 * scene.model->vertices());
    Eigen::VectorXd times(frames);
    Eigen::Index frame = 0;
    for (const auto& [seconds, code] : codes) {
      context.report(static_cast<double>(frame) / static_cast<double>(frames));
      Eigen::Index at = 0;
      for (const UsdMesh& mesh : meshes_) {
        const Positions points = pose_at(mesh, code);
        poses.row(frame).segment(at, points.size()) =
            Eigen::Map<const Eigen::RowVectorXd>(points.data(), points.size());
        at += points.size();
      }
      times[frame++] = seconds;
    }
    check_times(path_, times);
    std::optional<Positions> rest;
    if (rest_is_known) rest = scene.model->neutral();
    scene.frames = std::make_shared<const MeshSequence>(
        scene.model->shared_connectivity(), std::move(poses), std::move(times), std::move(rest));
  }

  Positions pose_at(const UsdMesh& mesh, double code) const {
    const UsdProperty& points = usd_needed(path_, *mesh.prim, "points");
    const Eigen::Index vertices = mesh.part.positions.rows();
    Positions pose = points_at(points, code, vertices);
    const Eigen::Matrix4d world = world_of(mesh, code);
    place(pose, world, true);
    if (!mesh.part.weights) return pose;
    // Targets stand as at rest: they turn with the mesh.
    const Eigen::Matrix4d rest = world_of(mesh);
    const Eigen::Matrix3d turned =
        world.topLeftCorner<3, 3>() * rest.topLeftCorner<3, 3>().inverse();
    const Eigen::RowVectorXd weights = mesh.part.weights->at(code / rate_);
    for (std::size_t j = 0; j < mesh.part.targets.size(); ++j) {
      const double weight = weights[Eigen::Index(j)];
      if (weight == 0) continue;
      pose += weight * (mesh.part.targets[j].displacements * turned.transpose());
    }
    return pose;
  }

  std::string path_;
  std::size_t bytes_;
  UsdLayer layer_;
  double rate_;
  bool z_is_up_;
  std::vector<UsdMesh> meshes_;
  std::vector<std::pair<std::string, const UsdPrim*>> animations_;
  std::set<std::string> left_out_;
  std::vector<std::string> notes_;
};

}  // namespace

Scene read_usd(const fs::path& path, const Context& context) {
  const std::string text = read_file(path);
  const std::string remedy = ", which is not read; export .usda, the text form (usdcat " +
                             path.filename().string() + " -o NAME.usda)";
  if (text.starts_with("PXR-USDC")) throw IoError(path.string(), "is binary USD" + remedy);
  if (text.starts_with("PK")) throw IoError(path.string(), "is a package of USD" + remedy);
  check_encoding(path.string(), text);
  return UsdReader(path, without_byte_order_mark(text)).read(context);
}

}  // namespace mimetra
