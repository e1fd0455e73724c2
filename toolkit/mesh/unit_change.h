#pragma once

#include <memory>
#include <string_view>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// How what is up is turned.
enum class UpTurn { keep, y_to_z, z_to_y };

/// As people choose it.
constexpr std::string_view choice_name(UpTurn value) {
  switch (value) {
    case UpTurn::keep:
      return "keep";
    case UpTurn::y_to_z:
      return "y-to-z";
    case UpTurn::z_to_y:
      return "z-to-y";
  }
  return {};
}

/// A change of unit and axes.
struct UnitChange {
  /// Factor of all positions, the rest pose's too.
  double scale = 1;
  /// `y_to_z` turns by 90 degrees about x, so that what was up along y is up along z and x stays:
  /// (x, y, z) becomes (x, -z, y). `z_to_y` is the way back.
  UpTurn up = UpTurn::keep;

  static constexpr Option kScale{
      "scale", &UnitChange::scale, {.minimum = 1e-9, .maximum = 1e9}, "a factor"};
  static constexpr Option kUp{"up", &UnitChange::up};
  static constexpr auto declared() { return std::tuple(kScale, kUp); }
};

using CoordinatesView = Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;

/// Changes points or displacements (N x 3) in place. Turns exactly: coordinates change places and
/// signs.
void change_units(CoordinatesView positions, const UnitChange& change);

/// The header of a sequence in other units and axes.
SequenceHeader in_units(SequenceHeader header, const UnitChange& change);

/// The same sequence in other units and axes, read when it is needed; the source itself where
/// nothing changes. Throws std::invalid_argument for options out of range.
std::shared_ptr<const FrameSource> with_units(std::shared_ptr<const FrameSource> source,
                                              const UnitChange& change);

}  // namespace mimetra
