#include "samples/head/teeth.h"

#include <array>
#include <cmath>

#include "samples/head/curves.h"
#include "samples/head/features.h"

namespace mimetra::samples {
namespace {

/// z of the upper teeth in front, and height of the edges of both jaws' teeth above the line
/// between the lips, mm.
constexpr double kFront = 80, kEdge = -3;

/// A point around a tooth: before (+) or behind the arch of the jaw, and from the edge to the gum,
/// mm.
struct Around {
  double out;
  double up;
};
constexpr std::array<Around, kToothPoints> kIncisor = {{{0.6, 0},
                                                        {1.6, 4},
                                                        {1.3, 8.5},
                                                        {2.4, 9.8},
                                                        {1.8, 15},
                                                        {-5, 15},
                                                        {-4.5, 9.5},
                                                        {-2.2, 4},
                                                        {-0.6, 0}}};
constexpr std::array<Around, kToothPoints> kMolar = {
    {{1.6, 0}, {2.6, 3}, {2, 6.5}, {3, 7.8}, {2.4, 15}, {-8, 15}, {-7.5, 8}, {-6.4, 3}, {-5, 0}}};
/// Added to a tooth's points between two of them: a groove, with the gum in its corner.
constexpr std::array<Around, kToothPoints> kBetween = {{{-0.5, 0.6},
                                                        {-1.2, 0},
                                                        {-0.8, -2.2},
                                                        {-0.4, -1.6},
                                                        {0, 0},
                                                        {0, 0},
                                                        {0.3, -2},
                                                        {0.9, 0},
                                                        {0.3, 0.6}}};

/// The arch of the jaw at `u` of HeadVertex (u >= 0): x, and z behind its middle.
Eigen::Vector2d arch(double u) {
  static const Curve beside({{-1, -8.4},
                             {0, 0},
                             {1, 8.4},
                             {2, 14.2},
                             {3, 19.4},
                             {4, 22.6},
                             {5, 24.8},
                             {6, 26.6},
                             {7, 27.5}});
  static const Curve behind({{-1, -1},
                             {0, 0},
                             {1, -1},
                             {2, -3.8},
                             {3, -9.2},
                             {4, -15.4},
                             {5, -22},
                             {6, -31.8},
                             {7, -41.8}});
  return {beside(u), behind(u)};
}

}  // namespace

Eigen::Vector3d teeth_point(const HeadVertex& vertex) {
  constexpr double kStep = 0.01;
  const double u = std::abs(vertex.u);
  const Eigen::Vector2d middle = arch(u);
  const Eigen::Vector2d along = (arch(u + kStep) - arch(u)).normalized();
  const Eigen::Vector2d out(-along.y(), along.x());
  const double molar = smooth_step((u - 2.5) / 2);
  const auto blend = [molar](const Around& a, const Around& b) {
    return Around{(1 - molar) * a.out + molar * b.out, (1 - molar) * a.up + molar * b.up};
  };
  const auto point = static_cast<std::size_t>(vertex.v);
  Around around = blend(kIncisor[point], kMolar[point]);
  if (u > kTeeth) around = {-1.5, 8};  // closes the end
  if (u == std::floor(u)) {
    around.out += kBetween[point].out;
    around.up += kBetween[point].up;
  }
  Eigen::Vector2d place = middle + around.out * out;
  // The lower teeth close behind the upper ones, on a gum that leans back above the chin.
  if (vertex.rim < 0) {
    around.up *= 0.8;
    place = {0.93 * place.x(), 0.97 * place.y() - 3.5 - square(around.up / 7)};
  }
  const double side = vertex.u < 0 ? -1 : vertex.u > 0;
  return {side * place.x(), kMouthHeight + kEdge + vertex.rim * around.up, kFront + place.y()};
}

Eigen::Vector3d tongue_point(const Eigen::Vector3d& ball) {
  const Eigen::Vector3d center(0, kMouthHeight - 11, 51), radii(16, 6, 22);
  Eigen::Vector3d p = center + radii.cwiseProduct(ball);
  p.y() += 6 * (1 - square(ball.z()));                                // its back is round
  if (ball.y() > 0) p.y() -= 2 * bump(square(p.x() / 8)) * ball.y();  // with a furrow along it
  return p;
}

}  // namespace mimetra::samples
