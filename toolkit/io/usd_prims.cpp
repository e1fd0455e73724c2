#include "toolkit/io/usd_prims.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace mimetra {

UsdStack usd_stack_at(const UsdLayer& layer, const std::string& path, const UsdStack& from) {
  const bool is_absolute = path.starts_with('/');
  UsdStack found = is_absolute ? UsdStack() : from;
  for (std::size_t at = is_absolute ? 1 : 0; at <= path.size();) {
    const std::size_t slash = std::min(path.find('/', at), path.size());
    const std::string name = path.substr(at, slash - at);
    at = slash + 1;
    if (name == "..") {
      if (found.empty()) return {};
      found.pop_back();
      continue;
    }
    const std::vector<UsdPrim>& children = found.empty() ? layer.prims : found.back()->children;
    const auto child = std::ranges::find(children, name, &UsdPrim::name);
    if (child == children.end()) return {};
    found.push_back(&*child);
  }
  return found;
}

UsdOwned usd_inherited(const UsdStack& stack, const std::string& name) {
  for (UsdStack owner = stack; !owner.empty(); owner.pop_back()) {
    const UsdProperty* property = usd_property(*owner.back(), name);
    if (property) return {owner, property};
  }
  return {};
}

namespace {

/// A step of a prim's transform. [UsdGeomXformOp]
Eigen::Matrix4d usd_step(const std::string& path, const std::string& name,
                         const UsdProperty& operation, std::optional<double> code) {
  constexpr std::string_view kPrefix = "xformOp:";
  const auto end = name.find(':', kPrefix.size());
  const std::string kind =
      name.starts_with(kPrefix) ? name.substr(kPrefix.size(), end - kPrefix.size()) : "";
  const std::vector<double> numbers = usd_numbers(path, operation, code);
  const auto need = [&](std::size_t count) {
    if (numbers.size() == count) return;
    usd_fail(path, operation.line,
             "'" + name + "' has " + std::to_string(numbers.size()) + " numbers, expected " +
                 std::to_string(count));
  };
  Eigen::Affine3d step = Eigen::Affine3d::Identity();
  const auto turn = [&step](char axis, double degrees) {
    step.prerotate(
        Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::Unit(axis - 'X')));
  };
  if (kind == "transform") {
    need(16);
    return Eigen::Map<const Eigen::Matrix4d>(numbers.data());  // its rows are our columns
  }
  if (kind == "translate" || kind == "scale") {
    need(3);
    const Eigen::Vector3d xyz(numbers[0], numbers[1], numbers[2]);
    if (kind == "scale") return step.scale(xyz).matrix();
    return step.translate(xyz).matrix();
  }
  if (kind == "orient") {
    need(4);
    const Eigen::Quaterniond turned(numbers[0], numbers[1], numbers[2], numbers[3]);
    if (turned.norm() == 0) usd_fail(path, operation.line, "'" + name + "' is no rotation");
    return step.rotate(turned.normalized()).matrix();
  }
  const std::string axes = kind.starts_with("rotate") ? kind.substr(6) : "";
  const bool known =
      (axes.size() == 1 || axes.size() == 3) && axes.find_first_not_of("XYZ") == std::string::npos;
  if (!known) usd_fail(path, operation.line, "'" + name + "' is not read; use a matrix");
  need(axes.size());
  for (const char axis : axes) turn(axis, numbers[axes.size() == 1 ? 0 : axis - 'X']);
  return step.matrix();
}

}  // namespace

Eigen::Matrix4d usd_world(const std::string& path, const UsdStack& stack,
                          std::optional<double> code) {
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
  for (const UsdPrim* prim : stack) {
    const UsdProperty* order = usd_property(*prim, "xformOpOrder");
    if (!order) continue;
    for (const std::string& name : order->value.words) {
      if (name == "!resetXformStack!") {
        world.setIdentity();
        continue;
      }
      constexpr std::string_view kInverse = "!invert!";
      const bool inverse = name.starts_with(kInverse);
      const std::string own = inverse ? name.substr(kInverse.size()) : name;
      const UsdProperty* operation = usd_property(*prim, own);
      if (!operation) usd_fail(path, order->line, "there is no '" + own + "'");
      const Eigen::Matrix4d step = usd_step(path, own, *operation, code);
      if (inverse && step.determinant() == 0) usd_fail(path, operation->line, "has no inverse");
      world *= inverse ? Eigen::Matrix4d(step.inverse()) : step;
    }
  }
  return world;
}

namespace {

using Matrices = std::vector<Eigen::Matrix4d>;

Matrices matrices_of(const std::string& path, const UsdProperty& property) {
  const std::vector<double> numbers = usd_numbers(path, property);
  if (numbers.empty() || numbers.size() % 16 != 0) {
    usd_fail(path, property.line,
             std::to_string(numbers.size()) + " numbers, expected 16 of each matrix");
  }
  Matrices matrices;
  for (std::size_t at = 0; at < numbers.size(); at += 16) {
    matrices.emplace_back(Eigen::Map<const Eigen::Matrix4d>(&numbers[at]));  // rows are our columns
  }
  return matrices;
}

using JointNames = std::vector<std::string>;

JointNames names_of(const UsdProperty* property) {
  return property ? property->value.words : JointNames();
}

/// From each joint to the skeleton, of transforms that each lead to the joint above. The name of a
/// joint is a path: "root/neck/jaw".
Matrices chained(Matrices transforms, const JointNames& names) {
  std::map<std::string, std::size_t> index;
  for (std::size_t j = 0; j < names.size(); ++j) index.emplace(names[j], j);
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // What stands above has a shorter path.
  std::ranges::stable_sort(order, {}, [&](std::size_t j) { return names[j].size(); });
  for (const std::size_t j : order) {
    for (std::string above = names[j]; above.find('/') != std::string::npos;) {
      above.resize(above.rfind('/'));
      const auto found = index.find(above);
      if (found == index.end()) continue;
      transforms[j] = (transforms[found->second] * transforms[j]).eval();
      break;
    }
  }
  return transforms;
}

/// Joints of a skeleton that vertices of a mesh hang on, from the first on.
std::set<std::size_t> joints_in_use(const std::string& path, const UsdStack& mesh,
                                    const JointNames& names) {
  const UsdProperty* indices = usd_inherited(mesh, "primvars:skel:jointIndices").property;
  const UsdProperty* weights = usd_inherited(mesh, "primvars:skel:jointWeights").property;
  const JointNames own = names_of(usd_inherited(mesh, "skel:joints").property);
  const std::vector<int> which = usd_integers(path, *indices, "jointIndices");
  const std::vector<double> shares = weights ? usd_numbers(path, *weights) : std::vector<double>();
  std::set<std::size_t> used;
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (i < shares.size() && shares[i] == 0) continue;
    auto joint = static_cast<std::size_t>(which[i]);
    const std::size_t count = own.empty() ? names.size() : own.size();
    if (which[i] < 0 || joint >= count) {
      usd_fail(path, indices->line,
               "joint " + std::to_string(which[i]) + " of " + std::to_string(count) +
                   ", which count from 0");
    }
    if (!own.empty()) {
      joint = static_cast<std::size_t>(std::ranges::find(names, own[joint]) - names.begin());
    }
    if (joint < names.size()) used.insert(joint);
  }
  return used;
}

/// The corners of a box around points, as columns of homogeneous coordinates.
Eigen::Matrix<double, 4, 8> box_of(const Positions& points) {
  const Eigen::RowVector3d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  Eigen::Matrix<double, 4, 8> corners = Eigen::Matrix<double, 4, 8>::Ones();
  for (int corner = 0; corner < 8; ++corner) {
    for (int c = 0; c < 3; ++c) corners(c, corner) = (corner >> c) % 2 == 0 ? low[c] : high[c];
  }
  return corners;
}

}  // namespace

UsdHold usd_hold(const std::string& path, const UsdPrim& skeleton, const UsdStack& stack,
                 const Positions& points) {
  UsdHold hold;
  const UsdProperty* geometry = usd_inherited(stack, "primvars:skel:geomBindTransform").property;
  Eigen::Matrix4d bind = Eigen::Matrix4d::Identity();
  if (geometry) bind = matrices_of(path, *geometry).front();
  hold.bound = bind;
  const UsdProperty* rest_property = usd_property(skeleton, "restTransforms");
  const UsdProperty* bound_property = usd_property(skeleton, "bindTransforms");
  if (!rest_property || !bound_property) return hold;
  Matrices rest = matrices_of(path, *rest_property);
  const Matrices bound = matrices_of(path, *bound_property);
  const JointNames names = names_of(usd_property(skeleton, "joints"));
  std::set<std::size_t> used;
  if (names.size() == rest.size() && names.size() == bound.size()) {
    rest = chained(std::move(rest), names);
    used = joints_in_use(path, stack, names);
  }
  const auto held_by = [&](std::size_t joint) -> Eigen::Matrix4d {
    if (bound[joint].determinant() == 0) {
      usd_fail(path, bound_property->line,
               (joint == 0 ? "the first" : "number " + std::to_string(joint + 1)) +
                   " of bindTransforms has no inverse");
    }
    return rest[joint] * bound[joint].inverse() * bind;
  };
  const std::size_t first = used.empty() ? 0 : *used.begin();
  hold.bound = held_by(first);
  if (first < names.size()) hold.joint = names[first];
  const Eigen::Matrix<double, 4, 8> box = box_of(points);
  const Eigen::Matrix<double, 4, 8> placed = hold.bound * box;
  // Of the size: files have their matrices in six digits or so.
  constexpr double kRounding = 1e-3;
  const double size = (placed.rowwise().maxCoeff() - placed.rowwise().minCoeff()).maxCoeff();
  for (const std::size_t joint : used) {
    const double away = (held_by(joint) * box - placed).colwise().norm().maxCoeff();
    if (away > kRounding * size) hold.elsewhere.push_back("'" + names[joint] + "'");
  }
  return hold;
}

namespace {

std::vector<int> counts_of(const std::string& path, const UsdPrim& prim, const std::string& name) {
  const UsdProperty& property = usd_needed(path, prim, name);
  for (const auto& [time, value] : property.samples) {
    if (value.numbers == property.samples.front().second.numbers) continue;
    usd_fail(path, property.line, name + " change over time, which is not read");
  }
  return usd_integers(path, property, name);
}

/// Without the faces that are not shown, and the coordinates of their corners.
void leave_out_holes(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  const UsdProperty* holes = usd_property(prim, "holeIndices");
  if (!holes) return;
  std::vector<bool> is_hole(static_cast<std::size_t>(part.polygons.size()), false);
  for (const int face : counts_of(path, prim, "holeIndices")) {
    if (face >= part.polygons.size()) {
      usd_fail(path, holes->line,
               "face " + std::to_string(face) + " of " + std::to_string(part.polygons.size()) +
                   " is no hole");
    }
    is_hole[static_cast<std::size_t>(face)] = true;
  }
  const Polygons all = std::exchange(part.polygons, {});
  const std::vector<int> texture = std::exchange(part.texture.corners, {});
  for (std::size_t face = 0; face < is_hole.size(); ++face) {
    if (is_hole[face]) continue;
    const int begin = all.offsets[face], end = all.offsets[face + 1];
    const auto append = [begin, end](std::vector<int>& to, const std::vector<int>& from) {
      to.insert(to.end(), from.begin() + begin, from.begin() + end);
    };
    append(part.polygons.corners, all.corners);
    if (!texture.empty()) append(part.texture.corners, texture);
    part.polygons.offsets.push_back(static_cast<int>(part.polygons.corners.size()));
  }
}

/// `primvars:st`, or the first that has the type of texture coordinates.
std::string texture_name(const UsdPrim& prim) {
  if (usd_property(prim, "primvars:st")) return "primvars:st";
  for (const auto& [name, property] : prim.properties) {
    if (name.starts_with("primvars:") && property.type.starts_with("texCoord2")) return name;
  }
  return {};
}

void fill_texture(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  const std::string name = texture_name(prim);
  if (name.empty()) return;
  const UsdProperty& texture = *usd_property(prim, name);
  const std::vector<double> numbers = usd_numbers(path, texture);
  if (numbers.size() % 2 != 0) usd_fail(path, texture.line, "a texture coordinate has no v");
  const std::size_t corners = part.polygons.corners.size();
  const bool by_corner = texture.interpolation == "faceVarying";
  if (!by_corner && texture.interpolation != "vertex" && texture.interpolation != "varying") {
    return;  // one for a whole face, or for the mesh
  }
  const std::size_t wanted = by_corner ? corners : static_cast<std::size_t>(part.positions.rows());
  std::vector<int> index;
  if (const UsdProperty* indices = usd_property(prim, name + ":indices")) {
    index = usd_integers(path, *indices, name + ":indices");
  } else {
    for (std::size_t i = 0; i < numbers.size() / 2; ++i) index.push_back(static_cast<int>(i));
  }
  if (index.size() != wanted) {
    usd_fail(
        path, texture.line,
        std::to_string(index.size()) + " texture coordinates, expected " + std::to_string(wanted));
  }
  for (const int i : index) {
    if (static_cast<std::size_t>(i) >= numbers.size() / 2) {
      usd_fail(path, texture.line, "there is no texture coordinate " + std::to_string(i));
    }
  }
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    part.texture.coordinates.emplace_back(numbers[i], numbers[i + 1]);
  }
  for (std::size_t corner = 0; corner < corners; ++corner) {
    const auto vertex = static_cast<std::size_t>(part.polygons.corners[corner]);
    part.texture.corners.push_back(index[by_corner ? corner : vertex]);
  }
}

}  // namespace

void turn_faces(ScenePart& part) {
  for (int face = 0; face < part.polygons.size(); ++face) {
    const auto begin = part.polygons.offsets[static_cast<std::size_t>(face)];
    const auto end = part.polygons.offsets[static_cast<std::size_t>(face) + 1];
    std::reverse(part.polygons.corners.begin() + begin + 1, part.polygons.corners.begin() + end);
    if (part.texture.corners.empty()) continue;
    std::reverse(part.texture.corners.begin() + begin + 1, part.texture.corners.begin() + end);
  }
}

void fill_usd_faces(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  part.polygons.corners = counts_of(path, prim, "faceVertexIndices");
  std::size_t all = 0;
  const UsdProperty& counts = usd_needed(path, prim, "faceVertexCounts");
  for (const int count : counts_of(path, prim, "faceVertexCounts")) {
    all += static_cast<std::size_t>(count);
    if (all > part.polygons.corners.size()) break;
    part.polygons.offsets.push_back(static_cast<int>(all));
  }
  if (all != part.polygons.corners.size()) {
    usd_fail(path, counts.line,
             "the faces have other corners than the " +
                 std::to_string(part.polygons.corners.size()) + " that are named");
  }
  for (const int corner : part.polygons.corners) {
    if (corner < part.positions.rows()) continue;
    usd_fail(path, usd_needed(path, prim, "faceVertexIndices").line,
             "a face uses point " + std::to_string(corner) + " of " +
                 std::to_string(part.positions.rows()));
  }
  fill_texture(path, prim, part);
  leave_out_holes(path, prim, part);
  if (usd_is_word(prim, "orientation", "leftHanded")) turn_faces(part);
}

}  // namespace mimetra
