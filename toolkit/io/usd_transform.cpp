#include "toolkit/io/usd_transform.h"

#include <numbers>
#include <string_view>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace mimetra {

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

}  // namespace mimetra
