#pragma once

#include <string_view>

namespace mimetra {

/// The axis that points up; faces look along +z, or -y where z is up.
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

}  // namespace mimetra
