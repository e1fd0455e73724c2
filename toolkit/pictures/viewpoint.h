#pragma once

#include <string_view>

#include "toolkit/mesh/option.h"

namespace mimetra {

/// The axis that points up.
enum class UpAxis { y, z };

/// As people choose it.
constexpr std::string_view choice_name(UpAxis value) {
  switch (value) {
    case UpAxis::y:
      return "y";
    case UpAxis::z:
      return "z";
  }
  return {};
}

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
