#pragma once

namespace mimetra {

/// A length that may depend on the mesh: a share of its longest side, up to kLargestShare, or in
/// the unit of its file.
struct Length {
  double value = 0;  ///< >= 0
  bool absolute = false;

  /// A share that is larger is a length whose unit was forgotten.
  static constexpr double kLargestShare = 1;

  static constexpr Length share(double of_longest_side) { return {of_longest_side, false}; }
  static constexpr Length of(double length) { return {length, true}; }

  /// In the unit of a mesh whose longest side is `longest_side`.
  constexpr double in(double longest_side) const { return absolute ? value : value * longest_side; }
};

}  // namespace mimetra
