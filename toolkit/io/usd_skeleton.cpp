#include "toolkit/io/usd_skeleton.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <Eigen/LU>

namespace mimetra {
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

using Names = std::vector<std::string>;

Names names_of(const UsdProperty* property) {
  return property ? property->value.words : Names();
}

/// From each joint to the skeleton, of transforms that each lead to the joint above. The name of a
/// joint is a path: "root/neck/jaw".
Matrices joined(Matrices transforms, const Names& names) {
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
                                    const Names& names) {
  const UsdProperty* indices = usd_inherited(mesh, "primvars:skel:jointIndices").property;
  const UsdProperty* weights = usd_inherited(mesh, "primvars:skel:jointWeights").property;
  const Names own = names_of(usd_inherited(mesh, "skel:joints").property);
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

Eigen::Matrix4d usd_first_matrix(const std::string& path, const UsdProperty& property) {
  return matrices_of(path, property).front();
}

UsdHold usd_hold(const std::string& path, const UsdPrim& skeleton, const UsdStack& stack,
                 const Positions& points) {
  UsdHold hold;
  const UsdProperty* geometry = usd_inherited(stack, "primvars:skel:geomBindTransform").property;
  const Eigen::Matrix4d bind =
      geometry ? usd_first_matrix(path, *geometry) : Eigen::Matrix4d::Identity();
  hold.bound = bind;
  const UsdProperty* rest_property = usd_property(skeleton, "restTransforms");
  const UsdProperty* bound_property = usd_property(skeleton, "bindTransforms");
  if (!rest_property || !bound_property) return hold;
  Matrices rest = matrices_of(path, *rest_property);
  const Matrices bound = matrices_of(path, *bound_property);
  const Names names = names_of(usd_property(skeleton, "joints"));
  std::set<std::size_t> used;
  if (names.size() == rest.size() && names.size() == bound.size()) {
    rest = joined(std::move(rest), names);
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

}  // namespace mimetra
