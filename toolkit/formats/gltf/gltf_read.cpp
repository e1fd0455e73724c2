#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

#include "toolkit/formats/gltf/gltf_motion.h"
#include "toolkit/formats/gltf/gltf_values.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

std::string number_name(const char* stem, std::size_t number) {
  std::string digits = std::to_string(number);
  return stem + std::string(3 - std::min<std::size_t>(3, digits.size()), '0') + digits;
}

/// A part of the scene, and flags of the vertices that its placement mirrors.
struct PlacedPart {
  ScenePart part;
  std::vector<bool> mirrored;
};

class GltfReader {
 public:
  GltfReader(const fs::path& path, const Context& context)
      : context_(context),
        document_(read_gltf_document(path)),
        values_(document_),
        placed_(placed_nodes(document_)) {
    for (const PlacedNode& node : placed_) worlds_.emplace(node.node, node.world);
  }

  Scene read() {
    look_through();
    read_motion();
    std::vector<ScenePart> parts;
    bool shows_mesh = false;
    for (const PlacedNode& placed : placed_) {
      if (!document_.nodes[placed.node].mesh) continue;
      add_parts(placed, parts);
      shows_mesh = true;
    }
    if (!shows_mesh && !document_.meshes.empty()) {
      throw IoError(document_.path, "has meshes, and no node of its scene shows one");
    }
    note_moved_nodes();
    motion_notes_.swap(notes_);
    note(left_out_, "primitives that are no triangles are left out");
    note(unread_, "further texture coordinates and colours of vertices are left out");
    Scene scene = joined_scene(document_.path, std::move(parts), document_.file_bytes);
    scene.motion_notes.insert(scene.motion_notes.begin(), motion_notes_.begin(),
                              motion_notes_.end());
    scene.rest_is_known = document_.rest_is_known;
    scene.files = document_.files;
    std::vector<std::string> notes = document_.notes;
    notes.insert(notes.end(), notes_.begin(), notes_.end());
    notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
    scene.notes = std::move(notes);
    return scene;
  }

 private:
  void note(const std::set<std::string>& names, const std::string& text) {
    if (names.empty()) return;
    const std::vector<std::string> words(names.begin(), names.end());
    notes_.push_back(document_.path + ": " + text + ": " + listed(words));
  }

  [[noreturn]] void fail(const std::string& what, const std::string& message) const {
    throw IoError(document_.path, what + ": " + message);
  }

  const GltfMesh& mesh_at(std::size_t node) const {
    return document_.meshes[*document_.nodes[node].mesh];
  }

  /// Checks the counts before anything is allocated.
  void look_through() {
    double vertices = 0;
    std::size_t targets = 0;
    for (const PlacedNode& placed : placed_) {
      if (!document_.nodes[placed.node].mesh) continue;
      for (const GltfPrimitive& primitive : mesh_at(placed.node).primitives) {
        if (primitive.positions) {
          vertices += static_cast<double>(document_.accessors[*primitive.positions].count);
        }
        targets = std::max(targets, primitive.targets.size());
        all_targets_ += primitive.targets.size();
        has_materials_ = has_materials_ || primitive.material;
      }
    }
    check_scene_size(document_.path, vertices, static_cast<double>(targets) + 1,
                     document_.file_bytes);
  }

  void read_motion() {
    std::set<std::size_t> shown;
    for (const PlacedNode& placed : placed_) shown.insert(placed.node);
    motion_ = gltf_motion(document_, values_, shown);
    const std::vector<std::string> read(motion_.clips.begin(), motion_.clips.end());
    note(motion_.other_clips, "several clips drive the same weights: " + listed(read) +
                                  (read.size() > 1 ? " are read together" : " is read") +
                                  ", others are left out as a whole (export each to a file of its "
                                  "own)");
    note(motion_.unread,
         "animations point to weights by other than '/nodes/N/weights', which is left out");
  }

  /// Weights of a node's mesh, animated or constant.
  std::shared_ptr<const WeightCurve> weights_of(std::size_t node) const {
    if (motion_.weights[node]) return motion_.weights[node];
    const std::vector<double>& own = document_.nodes[node].weights;
    const std::vector<double>& still = own.empty() ? mesh_at(node).weights : own;
    auto curve = std::make_shared<WeightCurve>();
    const auto columns = static_cast<Eigen::Index>(mesh_at(node).most_targets);
    curve->values = Eigen::MatrixXd::Zero(1, columns);
    for (Eigen::Index j = 0; j < std::min(columns, Eigen::Index(still.size())); ++j) {
      curve->values(0, j) = still[static_cast<std::size_t>(j)];
    }
    return curve;
  }

  static std::string shown_name(const PlacedNode& placed) {
    return "'" + std::string(placed.name) + "'";
  }

  static bool has_faces(const GltfPrimitive& primitive) {
    constexpr int kFirstOfFaces = 4;
    return primitive.mode >= kFirstOfFaces && primitive.positions;
  }

  void add_parts(const PlacedNode& placed, std::vector<ScenePart>& parts) {
    const GltfMesh& mesh = mesh_at(placed.node);
    const bool is_named = !document_.nodes[placed.node].name.empty() || mesh.name.empty();
    std::string name(is_named ? placed.name : mesh.name);
    if (name.empty()) name = number_name("mesh_", *document_.nodes[placed.node].mesh);
    // Primitives that share vertices become one part.
    std::map<decltype(mesh.primitives[0].vertices()), std::size_t> made;
    std::vector<PlacedPart> own;
    for (const GltfPrimitive& primitive : mesh.primitives) {
      if (!has_faces(primitive)) {
        left_out_.insert("'" + name + "'");
        continue;
      }
      unread_.insert(primitive.unread.begin(), primitive.unread.end());
      const auto [same, is_new] = made.emplace(primitive.vertices(), own.size());
      if (is_new || primitive.draco) {
        own.push_back(part_of(placed, name, mesh, primitive));
      } else {
        add_faces(primitive, own[same->second]);
      }
    }
    for (PlacedPart& part : own) parts.push_back(std::move(part.part));
  }

  PlacedPart part_of(const PlacedNode& placed, const std::string& name, const GltfMesh& mesh,
                     const GltfPrimitive& primitive) {
    PlacedPart made;
    ScenePart& part = made.part;
    part.name = name;
    std::optional<DracoMesh> draco;
    if (primitive.draco) {
      draco = decoded(primitive, name);
      part.positions = draco->positions;
    } else {
      part.positions = values_.read(*primitive.positions, 3);
    }
    const Eigen::Index vertices = part.positions.rows();
    const Placement placement = placement_of(placed, primitive, draco, vertices);
    placement.apply(part.positions, false);
    made.mirrored = placement.mirrored(vertices);
    for (std::size_t j = 0; j < primitive.targets.size(); ++j) {
      context_.report(static_cast<double>(targets_read_++) / static_cast<double>(all_targets_));
      const bool is_named = j < mesh.target_names.size() && !mesh.target_names[j].empty();
      SceneTarget target{is_named ? mesh.target_names[j] : number_name("target_", j),
                         Positions::Zero(vertices, 3)};
      if (!is_named) target.unnamed_in = *document_.nodes[placed.node].mesh;
      if (primitive.targets[j]) {
        target.displacements = values_.read(*primitive.targets[j], 3, vertices);
        placement.apply(target.displacements, true);
      }
      part.targets.push_back(std::move(target));
    }
    part.weights = weights_of(placed.node);
    if (primitive.texture) {
      part.texture.coordinates = shown(texture_of(primitive, stored_texture(primitive, draco)));
    }
    if (draco) {
      add_group(primitive, part);
      append_triangles({draco->triangles.data(), draco->triangles.data() + draco->triangles.size()},
                       primitive, made);
    } else {
      add_faces(primitive, made);
    }
    return made;
  }

  /// Decodes a primitive's compressed mesh and scales its numbers as their accessors normalise
  /// them. \pre the primitive has positions
  DracoMesh decoded(const GltfPrimitive& primitive, const std::string& name) {
    DracoMesh mesh = decode_draco(document_.path, "'" + name + "'", *primitive.draco,
                                  values_.bytes(primitive.draco->view));
    mesh.positions = values_.scaled(*primitive.positions, std::move(mesh.positions));
    if (primitive.texture) {
      mesh.texture = values_.scaled(*primitive.texture, std::move(mesh.texture));
    }
    for (std::size_t set = 0; set < mesh.joints.size(); ++set) {
      Frames& weights = mesh.joints[set].weights;
      weights = values_.scaled(primitive.joints[set].second, std::move(weights));
    }
    return mesh;
  }

  /// Returns `held`, the numbers of the compressed mesh, or reads the accessor if `held` is empty.
  Frames held_or_read(const Frames& held, std::size_t accessor, int components,
                      Eigen::Index vertices) {
    return held.rows() > 0 ? held : values_.read(accessor, components, vertices);
  }

  /// \pre the primitive has texture coordinates
  Frames stored_texture(const GltfPrimitive& primitive, const std::optional<DracoMesh>& draco) {
    const auto vertices =
        draco ? draco->positions.rows()
              : static_cast<Eigen::Index>(document_.accessors[*primitive.positions].count);
    return held_or_read(draco ? draco->texture : Frames(), *primitive.texture, 2, vertices);
  }

  /// Moves the origin from the upper left to the lower left corner.
  static std::vector<Eigen::Vector2d> shown(const Frames& stored) {
    std::vector<Eigen::Vector2d> coordinates;
    coordinates.reserve(static_cast<std::size_t>(stored.rows()));
    for (Eigen::Index v = 0; v < stored.rows(); ++v) {
      coordinates.emplace_back(stored(v, 0), 1 - stored(v, 1));
    }
    return coordinates;
  }

  /// True if a material's coordinates fill only a corner of the 16-bit range, and its transform
  /// maps them into the picture. Quantisation to at most 14 bits, in a range of its own, does this.
  bool brings_from_corner(std::size_t material) {
    constexpr double kCorner = 16383. / 65535, kLeastScale = 2, kRounding = 1. / 256;
    const auto& transform = document_.materials[material].texture;
    const bool is_turned = transform(0, 1) != 0 || transform(1, 0) != 0;
    const auto scale = transform.leftCols<2>().diagonal();
    if (is_turned || scale.minCoeff() <= kLeastScale) return false;
    Eigen::RowVector2d least = Eigen::RowVector2d::Ones(), most = -least;
    for (const PlacedNode& placed : placed_) {
      if (!document_.nodes[placed.node].mesh) continue;
      for (const GltfPrimitive& primitive : mesh_at(placed.node).primitives) {
        if (primitive.material != material || !primitive.texture || !has_faces(primitive)) continue;
        std::optional<DracoMesh> draco;
        if (primitive.draco) draco = decoded(primitive, std::string(placed.name));
        const Frames stored = stored_texture(primitive, draco);
        least = least.cwiseMin(stored.colwise().minCoeff());
        most = most.cwiseMax(stored.colwise().maxCoeff());
      }
    }
    const auto shown = [&transform](const Eigen::RowVector2d& stored) -> Eigen::Array2d {
      return transform.leftCols<2>() * stored.transpose() + transform.col(2);
    };
    return most.maxCoeff() <= kCorner && (shown(least) >= -kRounding).all() &&
           (shown(most) <= 1 + kRounding).all();
  }

  /// True if a material's transform undoes quantisation; other transforms move or repeat its
  /// picture. \pre a primitive that is shown uses the material
  bool undoes_quantisation(std::size_t material, const GltfAccessor& accessor) {
    constexpr int kUnsignedShort = 5123, kFloat = 5126;
    const auto& transform = document_.materials[material].texture;
    if (accessor.type == kFloat) return false;
    // gltfpack normalises coordinates to the range that its material uses.
    if (!accessor.normalized || document_.generator.starts_with("gltfpack")) return true;
    if (accessor.type != kUnsignedShort) return false;
    // Coordinates from 0 to 1, quantised to fewer than 16 bits.
    constexpr double kRounding = 1e-6;
    for (int bits = 8; bits < 16; ++bits) {
      const double scale = 65535. / ((1 << bits) - 1);
      if (transform.leftCols<2>().isApprox(scale * Eigen::Matrix2d::Identity(), kRounding)) {
        return true;
      }
    }
    // The file may come from gltfpack and then from another program that replaced `generator`.
    const auto [known, is_new] = brings_from_corner_.try_emplace(material, false);
    if (is_new) known->second = brings_from_corner(material);
    return known->second;
  }

  /// Texture coordinates after the material's transform, if the transform undoes quantisation;
  /// otherwise unchanged. \pre the primitive has texture coordinates
  Frames texture_of(const GltfPrimitive& primitive, Frames texture) {
    if (!primitive.material) return texture;
    if (!undoes_quantisation(*primitive.material, document_.accessors[*primitive.texture])) {
      return texture;
    }
    const auto& transform = document_.materials[*primitive.material].texture;
    texture =
        ((texture * transform.leftCols<2>().transpose()).rowwise() + transform.col(2).transpose())
            .eval();
    return texture;
  }

  std::vector<VertexJoints> joint_sets(const GltfPrimitive& primitive,
                                       const std::optional<DracoMesh>& draco,
                                       Eigen::Index vertices) {
    std::vector<VertexJoints> sets;
    for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
      const auto& [joints, weights] = primitive.joints[set];
      const VertexJoints held = draco ? draco->joints[set] : VertexJoints();
      sets.push_back({held_or_read(held.joints, joints, 4, vertices),
                      held_or_read(held.weights, weights, 4, vertices)});
    }
    return sets;
  }

  Placement placement_of(const PlacedNode& placed, const GltfPrimitive& primitive,
                         const std::optional<DracoMesh>& draco, Eigen::Index vertices) {
    const auto& skin = document_.nodes[placed.node].skin;
    if (!skin) return Placement(placed.world);
    const std::vector<VertexJoints> sets = joint_sets(primitive, draco, vertices);
    if (sets.empty()) return Placement(placed.world);
    const Frames joints = joints_of(document_.skins[*skin]);
    for (const std::size_t joint : document_.skins[*skin].joints) joints_.insert(joint);
    Frames blended = Frames::Zero(vertices, 12);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(vertices);
    for (const auto& [which, weights] : sets) {
      for (Eigen::Index v = 0; v < vertices; ++v) {
        for (int k = 0; k < 4; ++k) {
          if (weights(v, k) == 0) continue;
          if (which(v, k) < 0 || which(v, k) >= static_cast<double>(joints.rows())) {
            fail(shown_name(placed), "vertex " + std::to_string(v) + " hangs on joint " +
                                         readable(which(v, k)) + " of " +
                                         std::to_string(joints.rows()) + ", which count from 0");
          }
          blended.row(v) += weights(v, k) * joints.row(static_cast<Eigen::Index>(which(v, k)));
          sums[v] += weights(v, k);
        }
      }
    }
    for (Eigen::Index v = 0; v < vertices; ++v) {
      // Weights stored in bytes do not sum to exactly 1; some sum to 0.
      if (sums[v] > 0) {
        blended.row(v) /= sums[v];
      } else {
        blended.row(v) = joints.row(0);
      }
    }
    return Placement(std::move(blended));
  }

  /// Transforms from stored vertices to the pose of each joint (J x 12, rows as in Placement).
  Frames joints_of(const GltfSkin& skin) {
    const auto count = static_cast<Eigen::Index>(skin.joints.size());
    if (count == 0) fail("a skin", "has no joints");
    Frames inverse;
    if (skin.inverse_bind) inverse = values_.read(*skin.inverse_bind, 16);
    if (skin.inverse_bind && inverse.rows() < count) {
      fail("a skin", "has fewer matrices than joints");
    }
    Frames joints(count, 12);
    for (Eigen::Index j = 0; j < count; ++j) {
      const std::size_t node = skin.joints[static_cast<std::size_t>(j)];
      const auto world = worlds_.find(node);
      if (world == worlds_.end()) {
        fail("a skin", "its joint nodes[" + std::to_string(node) + "] is in no scene");
      }
      Eigen::Matrix4d bound = world->second;
      if (skin.inverse_bind) bound *= Eigen::Map<const Eigen::Matrix4d>(inverse.row(j).data());
      const Eigen::Matrix<double, 3, 4> transform = bound.topRows<3>();
      joints.row(j) = Eigen::Map<const Eigen::RowVectorXd>(transform.data(), transform.size());
    }
    return joints;
  }

  void add_faces(const GltfPrimitive& primitive, PlacedPart& placed) {
    ScenePart& part = placed.part;
    const Eigen::Index vertices = part.positions.rows();
    std::vector<int> corners;
    if (primitive.indices) {
      corners = values_.indices(*primitive.indices, vertices);
    } else {
      for (int v = 0; v < vertices; ++v) corners.push_back(v);
    }
    add_group(primitive, part);
    append_triangles(triangles_of(primitive.mode, corners, part.name), primitive, placed);
  }

  /// Starts a group of faces. Faces without a material get a group as well, or they would join the
  /// previous one.
  void add_group(const GltfPrimitive& primitive, ScenePart& part) const {
    if (!has_materials_) return;
    std::string name = "none";
    if (primitive.material) {
      name = document_.materials[*primitive.material].name;
      if (name.empty()) name = number_name("material_", *primitive.material);
    }
    part.groups.push_back({part.polygons.size(), std::move(name)});
  }

  /// Corners of triangles, one triangle after the other. [glTF 2.0, 3.7.2.1]
  std::vector<int> triangles_of(int mode, const std::vector<int>& corners,
                                const std::string& name) const {
    constexpr int kTriangles = 4, kStrip = 5;
    if (mode == kTriangles) {
      if (corners.size() % 3 == 0) return corners;
      fail("'" + name + "'", std::to_string(corners.size()) + " corners make no triangles");
    }
    std::vector<int> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      const std::size_t odd = i % 2;
      const std::array<std::size_t, 3> at = mode == kStrip
                                                ? std::array{i, i + 1 + odd, i + 2 - odd}
                                                : std::array{i + 1, i + 2, std::size_t{0}};
      for (const std::size_t corner : at) triangles.push_back(corners[corner]);
    }
    return triangles;
  }

  /// True if most corners of a polygon are mirrored.
  static bool is_mirrored(const std::vector<bool>& vertices, std::span<const int> corners) {
    const auto count = std::ranges::count_if(
        corners, [&](int corner) { return vertices[static_cast<std::size_t>(corner)]; });
    return 2 * static_cast<std::size_t>(count) > corners.size();
  }

  /// Appends triangles, or the polygons that they triangulate.
  static void append_triangles(const std::vector<int>& corners, const GltfPrimitive& primitive,
                               PlacedPart& placed) {
    ScenePart& part = placed.part;
    Polygons& polygons = part.polygons;
    const std::size_t first = polygons.corners.size();
    int last_start = -1;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      const int start = corners[t];
      if (primitive.polygons && start == last_start && polygons.corners.back() == corners[t + 1]) {
        polygons.corners.push_back(corners[t + 2]);
        polygons.offsets.back() += 1;
        continue;
      }
      polygons.corners.insert(polygons.corners.end(), &corners[t], &corners[t] + 3);
      polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
      last_start = start;
    }
    for (std::size_t face = polygons.offsets.size() - 1; face > 0; --face) {
      const auto begin = static_cast<std::size_t>(polygons.offsets[face - 1]);
      if (begin < first) break;
      const std::span<int> face_corners(&polygons.corners[begin],
                                        polygons.corners.data() + polygons.offsets[face]);
      // Keeping the first corner keeps the triangulation.
      if (is_mirrored(placed.mirrored, face_corners)) std::ranges::reverse(face_corners.subspan(1));
    }
    if (part.texture.coordinates.empty()) return;
    // Each vertex has its own texture coordinates.
    part.texture.corners.insert(part.texture.corners.end(),
                                polygons.corners.begin() + static_cast<std::ptrdiff_t>(first),
                                polygons.corners.end());
  }

  /// Notes animated nodes that move meshes or the joints of their vertices.
  void note_moved_nodes() {
    std::vector<bool> moves_face(document_.nodes.size(), false);
    for (auto placed = placed_.rbegin(); placed != placed_.rend(); ++placed) {
      const GltfNode& node = document_.nodes[placed->node];
      bool holds = node.mesh.has_value() || joints_.contains(placed->node);
      for (const std::size_t child : node.children) holds = holds || moves_face[child];
      moves_face[placed->node] = holds;
    }
    std::set<std::string> names;
    for (const std::size_t node : motion_.moved) {
      if (!moves_face[node]) continue;
      const std::string& name = document_.nodes[node].name;
      names.insert("'" + (name.empty() ? "nodes[" + std::to_string(node) + ']' : name) + "'");
    }
    note(names,
         "the movement of nodes is left out, every frame has them as they stand at rest (head "
         "motion, eyes)");
  }

  const Context& context_;
  GltfDocument document_;
  GltfValues values_;
  std::vector<PlacedNode> placed_;
  std::map<std::size_t, Eigen::Matrix4d> worlds_;
  GltfMotion motion_;
  std::set<std::size_t> joints_;
  std::map<std::size_t, bool> brings_from_corner_;  ///< key: material
  std::size_t all_targets_ = 0, targets_read_ = 0;
  bool has_materials_ = false;  ///< true if a primitive that is shown has one
  std::set<std::string> left_out_, unread_;
  std::vector<std::string> notes_, motion_notes_;
};

}  // namespace

Scene read_gltf(const fs::path& path, const Context& context) {
  return GltfReader(path, context).read();
}

}  // namespace mimetra
