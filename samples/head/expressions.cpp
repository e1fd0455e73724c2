#include <mimetra/samples/expressions.h>

#include <cmath>
#include <functional>
#include <utility>

#include <mimetra/samples/curves.h>
#include <mimetra/samples/head_shape.h>

namespace mimetra::samples {
namespace {

using Vector = Eigen::Vector3d;
/// How an expression moves a skin vertex at a place.
using Motion = std::function<Vector(const HeadVertex&, const Vector&)>;

/// The motion of the head's left half mirrored onto its right one, and the other way round.
Motion mirrored(const Motion& motion) {
  const Eigen::Vector3d mirror(-1, 1, 1);
  return [motion, mirror](const HeadVertex& vertex, const Vector& p) -> Vector {
    HeadVertex other = vertex;
    other.u = -vertex.u;
    return motion(other, p.cwiseProduct(mirror)).cwiseProduct(mirror);
  };
}

Vector smile(const HeadVertex&, const Vector& p) {
  const double corner = within(p, {28, -64, 68}, {33, 27, 42});
  const double cheek = within(p, {43, -36, 66}, {26, 26, 40});
  return corner * Vector(8, 8.5, -5) + cheek * Vector(1, 3, 4);
}

Vector cheek_puff(const HeadVertex&, const Vector& p) {
  const double left = within(p, {44, -62, 52}, {27, 26, 42});
  const double right = within(p, {-44, -62, 52}, {27, 26, 42});
  return left * Vector(9, 0, 9) + right * Vector(-9, 0, 9);
}

Vector pucker(const HeadVertex&, const Vector& p) {
  const double lips = within(p, {0, kMouthHeight, 78}, {42, 27, 45});
  return lips * Vector(-0.42 * p.x(), 0.25 * (p.y() - kMouthHeight), 9);
}

Vector brow_inner_up(const HeadVertex&, const Vector& p) {
  const double left = within(p, {12, 26, 84}, {26, 26, 40});
  const double right = within(p, {-12, 26, 84}, {26, 26, 40});
  return (left + right) * Vector(0, 6.5, 0.5);
}

Vector brow_down(const HeadVertex&, const Vector& p) {
  return within(p, {25, 22, 80}, {26, 20, 40}) * Vector(-3, -6, 1);
}

/// Share of the jaw's rotation that the skin takes at a place: all of it at the lower lip and the
/// chin, none at the upper lip, about a third at the corners of the mouth.
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

Vector jaw_open(const HeadVertex& vertex, const Vector& p) {
  const Vector hinge(0, -25, -5);
  constexpr double kSine = 0.24;
  const double cosine_less_one = std::sqrt(1 - kSine * kSine) - 1;
  const Vector arm = p - hinge;
  const Vector turned(0, cosine_less_one * arm.y() - kSine * arm.z(),
                      kSine * arm.y() + cosine_less_one * arm.z());
  return jaw_share(vertex, p) * turned;
}

/// Displacements (3N) of the skin by `motion`; what lies behind lips and lids moves with them.
Eigen::VectorXd field_of(const HeadGrid& grid, const Positions& mean, const Motion& motion) {
  Positions field = Positions::Zero(mean.rows(), 3);
  for (Eigen::Index i = 0; i < field.rows(); ++i) {
    const HeadVertex& vertex = grid.vertices[static_cast<std::size_t>(i)];
    if (vertex.part == HeadVertex::Part::eyeball) continue;
    if (vertex.source >= 0) {
      field.row(i) = field.row(vertex.source);
    } else {
      field.row(i) = motion(vertex, mean.row(i));
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
}

/// Displacements (3N) of other eyelids.
Eigen::VectorXd lid_field(const HeadGrid& grid, const Positions& mean, const Eyelids& left,
                          const Eyelids& right) {
  const Positions shape = head_positions(grid, left, right);
  return field_of(grid, Positions(shape - mean),
                  [](const HeadVertex&, const Vector& moved) { return moved; });
}

}  // namespace

ShapeBasis head_expressions(const HeadGrid& grid) {
  const Positions mean = head_positions(grid);
  const Eyelids open, shut{-3.0, -3.4}, wide{8.8, -5.0};
  const auto moved = [&](const Motion& motion) { return field_of(grid, mean, motion); };
  const std::pair<const char*, Eigen::VectorXd> fields[] = {
      {"eyeBlink_L", lid_field(grid, mean, shut, open)},
      {"eyeBlink_R", lid_field(grid, mean, open, shut)},
      {"eyeWide_L", lid_field(grid, mean, wide, open)},
      {"eyeWide_R", lid_field(grid, mean, open, wide)},
      {"browInnerUp", moved(brow_inner_up)},
      {"browDown_L", moved(brow_down)},
      {"browDown_R", moved(mirrored(brow_down))},
      {"jawOpen", moved(jaw_open)},
      {"mouthPucker", moved(pucker)},
      {"mouthSmile_L", moved(smile)},
      {"mouthSmile_R", moved(mirrored(smile))},
      {"cheekPuff", moved(cheek_puff)},
  };
  ShapeBasis basis{{}, Eigen::MatrixXd(mean.size(), static_cast<Eigen::Index>(std::size(fields)))};
  for (const auto& [name, field] : fields) {
    basis.displacements.col(basis.size()) = field;
    basis.names.emplace_back(name);
  }
  return basis;
}

}  // namespace mimetra::samples
