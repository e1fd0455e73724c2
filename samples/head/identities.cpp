#include "samples/head/expressions.h"

#include <cmath>
#include <utility>

#include "samples/head/curves.h"
#include "samples/head/features.h"
#include "samples/head/head_shape.h"

namespace mimetra::samples {
namespace {

using Vector = Eigen::Vector3d;
using Person = Vector (*)(const Vector&);

/// The same on both sides of the face.
double within_both(const Vector& p, const Vector& center, const Vector& radii) {
  return within({std::abs(p.x()), p.y(), p.z()}, center, radii);
}

double nose(const Vector& p) {
  return within(p, {0, -34, 98}, {24, 30, 36});
}

Vector wide(const Vector& p) {
  const double face = smooth_step((60 - p.y()) / 80);
  const double cheeks = within_both(p, {50, -45, 50}, {45, 50, 60});
  const double nostrils = within(p, {0, -40, 95}, {26, 18, 36});
  return {p.x() * (0.10 * face + 0.25 * nostrils) + 0.08 * p.x() * cheeks, -0.06 * p.y(),
          -5 * nose(p) + 2 * cheeks};
}

Vector narrow(const Vector& p) {
  const double lower = smooth_step(-p.y() / 60);
  const double hollow = within_both(p, {46, -60, 50}, {40, 40, 50});
  return {-0.13 * p.x() - 3 * hollow * p.x() / 46, 0.05 * p.y() - 9 * lower,
          5 * nose(p) - 3 * hollow};
}

Vector rugged(const Vector& p) {
  const double bridge = within(p, {0, -14, 90}, {20, 26, 36});
  const double brows = within_both(p, {25, 21, 80}, {38, 18, 50});
  const double chin = within(p, {0, -100, 80}, {36, 24, 50});
  const double jaw = within_both(p, {55, -75, 20}, {40, 36, 60});
  const double tip = nose(p);
  const double neck = smooth_step((-60 - p.y()) / 60);
  return {p.x() * (0.30 * tip + 0.10 * jaw + 0.12 * neck), -3 * tip - 2 * brows - 4 * chin,
          7 * tip + 6 * bridge + 5 * brows + 6 * chin + 4 * neck};
}

Vector child(const Vector& p) {
  constexpr double kSmaller = -0.10;
  const double lower = smooth_step(-p.y() / 90);
  const double face = smooth_step((p.z() + 20) / 60);
  const double cheeks = within_both(p, {42, -50, 58}, {46, 42, 70});
  const double forehead = within(p, {0, 48, 75}, {60, 40, 60});
  const double brows = within_both(p, {25, 21, 80}, {38, 18, 50});
  const double neck = smooth_step((-85 - p.y()) / 45);
  const double above_neck = smooth_step((p.y() + 150) / 45);
  return kSmaller * p + Vector(p.x() * (-0.08 * lower - 0.10 * neck + 0.08 * cheeks),
                               14 * lower * face * above_neck,
                               -9 * nose(p) + 4 * cheeks + 5 * forehead - 1.5 * brows);
}

/// The person with eyes that are those of all others, moved as a whole: eyeballs stay spheres, lids
/// stay on them, and a blink closes them.
Vector with_sound_eyes(Person person, const Vector& p) {
  constexpr double kReach = 30,
                   kSkin = 0.74;  // whole to 15 mm, not at all in the middle of the face
  const Vector center(p.x() < 0 ? -kLeftEye.x() : kLeftEye.x(), kLeftEye.y(), kLeftEye.z());
  const double beside = (p - center).squaredNorm() / (kReach * kReach);
  const double whole = smooth_step((1 - beside) / kSkin);
  return (1 - whole) * person(p) + whole * person(center);
}

}  // namespace

ShapeBasis head_identities(const Positions& mean) {
  const std::pair<const char*, Person> people[] = {{"identity000", wide},
                                                   {"identity001", narrow},
                                                   {"identity002", rugged},
                                                   {"identity003", child}};
  ShapeBasis basis{{}, Eigen::MatrixXd(mean.size(), static_cast<Eigen::Index>(std::size(people)))};
  for (const auto& [name, person] : people) {
    for (Eigen::Index i = 0; i < mean.rows(); ++i) {
      basis.displacements.col(basis.size()).segment<3>(3 * i) =
          with_sound_eyes(person, mean.row(i));
    }
    basis.names.emplace_back(name);
  }
  return basis;
}

}  // namespace mimetra::samples
