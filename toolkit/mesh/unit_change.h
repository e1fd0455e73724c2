#pragma once

#include <memory>
#include <string_view>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// Change of the up axis.
enum class UpTurn { keep, y_to_z, z_to_y };

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
  /// Factor of all positions, including the rest pose.
  double scale = 1;
  /// `y_to_z` turns by 90 degrees about x, so that the up axis changes from y to z: (x, y, z)
  /// becomes (x, -z, y). `z_to_y` is the inverse.
  UpTurn up = UpTurn::keep;

  static constexpr Option kScale{
      "scale", &UnitChange::scale, {.minimum = 1e-9, .maximum = 1e9}, "a factor"};
  static constexpr Option kUp{"up", &UnitChange::up};
  static constexpr auto declared() { return std::tuple(kScale, kUp); }
};

using CoordinatesView = Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;

/// Changes points or displacements (N x 3) in place. The turn is exact: it only exchanges and
/// negates coordinates.
void change_units(CoordinatesView positions, const UnitChange& change);

SequenceHeader in_units(SequenceHeader header, const UnitChange& change);

/// The same sequence in other units and axes, changed on reading; the source itself if nothing
/// changes. Throws std::invalid_argument for options out of range.
std::shared_ptr<const FrameSource> with_units(std::shared_ptr<const FrameSource> source,
                                              const UnitChange& change);

}  // namespace mimetra
