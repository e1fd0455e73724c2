#pragma once

namespace mimetra {

/// A length that may depend on the mesh: a share of its diameter, up to kLargestShare, or in the
/// unit of its file.
struct Length {
  double value = 0;  ///< >= 0
  bool absolute = false;

  /// A share that is larger is a length whose unit was forgotten.
  static constexpr double kLargestShare = 1;

  static constexpr Length share(double of_diameter) { return {of_diameter, false}; }
  static constexpr Length of(double length) { return {length, true}; }

  /// In the unit of a mesh of this diameter().
  constexpr double in(double diameter) const { return absolute ? value : value * diameter; }
};

}  // namespace mimetra
