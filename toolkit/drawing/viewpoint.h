#pragma once

#include "toolkit/mesh/option.h"
#include "toolkit/operations/up_axis.h"

namespace mimetra {

/// From where meshes are seen.
struct Viewpoint {
  /// 0 looks at what faces +z (-y where z is up).
  double yaw = 15;
  /// Positive looks from above.
  double pitch = 5;
  UpAxis up = UpAxis::y;

  static constexpr Option kYaw{
      "yaw", &Viewpoint::yaw, {.minimum = -360, .maximum = 360}, "degrees"};
  static constexpr Option kPitch{
      "pitch", &Viewpoint::pitch, {.minimum = -90, .maximum = 90}, "degrees"};
  static constexpr Option kUp{"up", &Viewpoint::up};
  static constexpr auto declared() { return std::tuple(kYaw, kPitch, kUp); }
};

}  // namespace mimetra
