#include "samples/head/expressions.h"

#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "samples/head/anatomy.h"
#include "samples/head/curves.h"
#include "samples/head/head_shape.h"

namespace mimetra::samples {

namespace {

using Vector = Eigen::Vector3d;
/// Displacement of a vertex at a place by an expression.
using Motion = std::function<Vector(const HeadVertex&, const Vector&)>;

/// Motion with the head's left and right sides exchanged.
Motion mirrored(const Motion& motion) {
  const Eigen::Vector3d mirror(-1, 1, 1);
  return [motion, mirror](const HeadVertex& vertex, const Vector& p) -> Vector {
    HeadVertex other = vertex;
    other.u = -vertex.u;
    return motion(other, p.cwiseProduct(mirror)).cwiseProduct(mirror);
  };
}

// Middle, radii, push.
const Stroke kSmileLeft[] = {
    {{31, -65, 68}, {30, 26, 46}, {7, 8, -4}},     // corner of the mouth, up and out
    {{12, -60, 84}, {22, 14, 40}, {1.5, 1.5, 0}},  // upper lip
    {{41, -34, 68}, {26, 24, 44}, {1.5, 4, 4.5}},  // cheek, up and round
    {{30, -47, 74}, {9, 16, 40}, {1, 0, -1.2}},    // fold from nose to mouth
};
const Stroke kCheekPuff[] = {
    {{44, -56, 52}, {34, 35, 56}, {7.5, 0, 6}},  // cheeks
    {{0, -66, 86}, {34, 16, 40}, {0, 0, 2}},     // lips
};
const Stroke kBrowInnerUp[] = {
    {{12, 26, 84}, {26, 26, 40}, {0, 6, 0.5}},  // inner ends of the brows
    {{38, 25, 74}, {24, 22, 46}, {0, 4, 0}},    // the rest follows
};
const Stroke kBrowDownLeft[] = {
    {{24, 23, 80}, {30, 21, 44}, {-2.5, -6, 1}},
    {{7, 20, 86}, {8, 16, 40}, {0, -1, 1.5}},  // bulge between the brows
};

Vector pucker(const HeadVertex&, const Vector& p) {
  const double lips = within(p, {0, kMouthHeight, 78}, {42, 27, 45});
  return lips * Vector(-0.42 * p.x(), 0.25 * (p.y() - kMouthHeight), 9);
}

Motion sculpting(std::span<const Stroke> strokes) {
  return
      [strokes](const HeadVertex&, const Vector& p) -> Vector { return sculpted(p, strokes) - p; };
}

Motion sculpting_both_sides(std::span<const Stroke> strokes) {
  return [strokes](const HeadVertex&, const Vector& p) -> Vector {
    return sculpted_on_both_sides(p, strokes) - p;
  };
}

/// Share of the jaw's rotation that the skin takes at a place. It is 1 at the lower lip and the
/// chin, 0 at the upper lip, and about a third at the corners of the mouth.
double jaw_share(const HeadVertex& vertex, const Vector& p) {
  constexpr double kCornerShare = 0.35, kLipReach = 30, kCheekReach = 38;
  const double s = std::abs(p.x()) / kMouthHalfWidth;
  const double to_corner = s < 1 ? s * s * (1 + s * s) / 2 : 1;
  const double d = p.y() - kMouthHeight;
  const bool above = vertex.v < kMouthRow || (vertex.v == kMouthRow && vertex.rim > 0);
  const double beside =
      above ? to_corner * kCornerShare * (1 - smooth_step(d / kCheekReach))
            : 1 - to_corner * (1 - kCornerShare) * (1 - smooth_step(-d / kLipReach));
  const double in_front = smooth_step((p.z() + 5) / 50);
  const double below_jaw = 1 - smooth_step((vertex.v - 8.8) / 2.4);
  return beside * in_front * below_jaw;
}

/// Displacement of a place when the whole jaw opens, by a rotation about the joints at the ears.
Vector jaw_turn(const Vector& p) {
  const Vector hinge(0, -25, -5);
  constexpr double kSine = 0.24;
  const double cosine_less_one = std::sqrt(1 - kSine * kSine) - 1;
  const Vector arm = p - hinge;
  return {0, cosine_less_one * arm.y() - kSine * arm.z(),
          kSine * arm.y() + cosine_less_one * arm.z()};
}

Vector jaw_open(const HeadVertex& vertex, const Vector& p) {
  return jaw_share(vertex, p) * jaw_turn(p);
}

/// Displacement inside the mouth. The upper jaw does not move; the lower jaw with teeth and tongue
/// moves by jaw_turn(), and places in between by half of it.
Vector jaw_open_inside(const HeadVertex& vertex, const Vector& p) {
  return (1 - vertex.rim) / 2.0 * jaw_turn(p);
}

Vector still(const HeadVertex&, const Vector&) {
  return Vector::Zero();
}

/// Displacements (3N) of the skin by `motion`, and of teeth and tongue by `inside`. The backs of
/// the lids move with the lids. Behind the lips, the motion blends from the lips' to `inside`.
Eigen::VectorXd field_of(const HeadGrid& grid, const Positions& mean, const Motion& motion,
                         const Motion& inside) {
  Positions field = Positions::Zero(mean.rows(), 3);
  for (Eigen::Index i = 0; i < field.rows(); ++i) {
    const HeadVertex& vertex = grid.vertices[static_cast<std::size_t>(i)];
    switch (vertex.part) {
      case HeadVertex::Part::skin:
        field.row(i) = motion(vertex, mean.row(i));
        break;
      case HeadVertex::Part::eyelid:
        field.row(i) = field.row(vertex.source);
        break;
      case HeadVertex::Part::mouth: {
        const double depth = square((vertex.ring - 1) / (kMouthRings - 1.0));
        field.row(i) = (1 - depth) * field.row(vertex.source) +
                       depth * inside(vertex, mean.row(i)).transpose();
        break;
      }
      case HeadVertex::Part::teeth:
      case HeadVertex::Part::tongue:
        field.row(i) = inside(vertex, mean.row(i));
        break;
      case HeadVertex::Part::eyeball:
        break;
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
}

/// Displacements (3N) that change the eyelids to `left` and `right`.
Eigen::VectorXd lid_field(const HeadGrid& grid, const Positions& mean, const Eyelids& left,
                          const Eyelids& right) {
  const Positions field = head_positions(grid, left, right) - mean;
  return Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
}

}  // namespace

ShapeBasis head_expressions(const HeadGrid& grid) {
  const Positions mean = head_positions(grid);
  const Eyelids open, shut{0.2, 0.2}, wide{12.8, 2.2};
  const auto moved = [&](const Motion& motion, const Motion& inside = still) {
    return field_of(grid, mean, motion, inside);
  };
  const std::pair<const char*, Eigen::VectorXd> fields[] = {
      {"eyeBlinkLeft", lid_field(grid, mean, shut, open)},
      {"eyeBlinkRight", lid_field(grid, mean, open, shut)},
      {"eyeWideLeft", lid_field(grid, mean, wide, open)},
      {"eyeWideRight", lid_field(grid, mean, open, wide)},
      {"browInnerUp", moved(sculpting_both_sides(kBrowInnerUp))},
      {"browDownLeft", moved(sculpting(kBrowDownLeft))},
      {"browDownRight", moved(mirrored(sculpting(kBrowDownLeft)))},
      {"jawOpen", moved(jaw_open, jaw_open_inside)},
      {"mouthPucker", moved(pucker)},
      {"mouthSmileLeft", moved(sculpting(kSmileLeft))},
      {"mouthSmileRight", moved(mirrored(sculpting(kSmileLeft)))},
      {"cheekPuff", moved(sculpting_both_sides(kCheekPuff))},
  };
  ShapeBasis basis{{}, Eigen::MatrixXd(mean.size(), static_cast<Eigen::Index>(std::size(fields)))};
  for (const auto& [name, field] : fields) {
    basis.displacements.col(basis.size()) = field;
    basis.names.emplace_back(name);
  }
  return basis;
}

namespace {

using Person = Vector (*)(const Vector&);

/// Value of within() mirrored to both sides of the face.
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

/// Displacement by `person` with the eye region moved as a whole. Eyeballs stay spheres, lids stay
/// on them, and a blink closes them.
Vector with_sound_eyes(Person person, const Vector& p) {
  constexpr double kReach = 30,
                   kSkin = 0.74;  // whole up to 15 mm, none in the middle of the face
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
