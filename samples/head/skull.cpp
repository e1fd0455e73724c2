#include "samples/head/skull.h"

#include <array>

namespace mimetra::samples {
namespace {

/// One horizontal section: its foremost, widest and rearmost point.
struct Section {
  double front_y, front_z;
  double side_x, side_y, side_z;
  double back_y, back_z;
};

// From the first section below the crown to the neck's end; they rise towards the back from the
// cheeks down, as a jaw does.
constexpr std::array<Section, 12> kSections = {{
    {107, 26, 38, 106, -11, 103, -50},     // 1
    {91, 55, 57, 89, -12, 85, -81},        //
    {67, 75, 70, 65, -13, 56, -97},        //
    {34, 84, 75, 33, -12, 20, -101},       // 4: brows
    {0, 80, 72, 0, -10, -14, -97},         // kEyeRow
    {-46, 82, 68, -34, -8, -42, -84},      // 6: below the nose
    {-66, 82, 64, -50, -8, -53, -76},      // kMouthRow
    {-98, 76, 56, -68, -10, -66, -70},     // 8: chin
    {-112, 62, 50, -78, -14, -76, -67},    //
    {-115, 36, 47, -88, -18, -88, -65},    // 10: below the jaw
    {-124, 14, 48, -108, -24, -110, -65},  //
    {-150, 8, 54, -149, -26, -148, -70},   // kNeckRow
}};

double Section::*const kQuantities[] = {&Section::front_y, &Section::front_z, &Section::side_x,
                                        &Section::side_y,  &Section::side_z,  &Section::back_y,
                                        &Section::back_z};

constexpr double kCrownY = 113.5;
constexpr double kCrownZ = -12;

/// Section 0 is the crown itself, -1 the first one seen from behind: the surface is round there.
Section section_at(int index) {
  if (index > 12) index = 12;
  if (index >= 1) return kSections[static_cast<std::size_t>(index - 1)];
  if (index == 0) return {kCrownY, kCrownZ, 0, kCrownY, kCrownZ, kCrownY, kCrownZ};
  const Section& first = kSections[0];
  return {first.back_y, first.back_z,  -first.side_x, first.side_y,
          first.side_z, first.front_y, first.front_z};
}

/// Between the sections by the cubic of Catmull and Rom.
Section section_between(double v) {
  int index = static_cast<int>(v);
  if (index > 11) index = 11;
  const double t = v - index;
  const double weights[4] = {t * (t * (2 - t) - 1) / 2, (t * t * (3 * t - 5) + 2) / 2,
                             t * (t * (4 - 3 * t) + 1) / 2, t * t * (t - 1) / 2};
  Section result{};
  for (int i = 0; i < 4; ++i) {
    const Section section = section_at(index - 1 + i);
    for (const auto quantity : kQuantities) result.*quantity += weights[i] * section.*quantity;
  }
  return result;
}

}  // namespace

Eigen::Vector3d skull_point(double u, double v) {
  const Section section = section_between(v);
  const double side = u < 0 ? -1 : 1;
  const double a = side * u;
  const bool front = a <= 1;
  const double t = front ? a : 2 - a;  // tangent of half the angle from the front, or the back
  const double sine = 2 * t / (1 + t * t);
  const double cosine = (1 - t * t) / (1 + t * t);
  const double end_y = front ? section.front_y : section.back_y;
  const double end_z = front ? section.front_z : section.back_z;
  // The fourth power keeps the rows of the face level and bends them on the cheeks.
  const double to_side = sine * sine * sine * sine;
  return {side * section.side_x * sine, end_y + (section.side_y - end_y) * to_side,
          section.side_z + (end_z - section.side_z) * cosine};
}

}  // namespace mimetra::samples
