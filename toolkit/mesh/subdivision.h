#pragma once

#include <memory>
#include <string_view>

#include <Eigen/SparseCore>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// Where the vertices of finer triangles lie.
enum class SubdivisionScheme {
  loop,     ///< on a smooth surface, to which the given vertices move, too
  midpoint  ///< on the given triangles: the surface stays as it is
};

/// As people choose it.
constexpr std::string_view choice_name(SubdivisionScheme value) {
  switch (value) {
    case SubdivisionScheme::loop:
      return "loop";
    case SubdivisionScheme::midpoint:
      return "midpoint";
  }
  return {};
}

struct SubdivideOptions {
  SubdivisionScheme scheme = SubdivisionScheme::loop;
  /// How often each triangle becomes four.
  int times = 1;

  static constexpr Option kScheme{"scheme", &SubdivideOptions::scheme};
  static constexpr Option kTimes{"times", &SubdivideOptions::times, {.minimum = 1, .maximum = 6}};
  static constexpr auto declared() { return std::tuple(kScheme, kTimes); }
};

/// Finer triangles, whose vertices are the given ones and behind them the middles of edges.
struct Subdivision {
  /// Each vertex is a sum of given ones (N' x N); rows add up to 1.
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  /// Four triangles for each given one, with its texture coordinates, groups and materials.
  std::shared_ptr<const Connectivity> connectivity;
};

/// Vertices at one place of `rest` (N x 3) are one, so that texture seams do not open. An edge that
/// not exactly two triangles share is a border. Throws std::invalid_argument for options out of
/// range, and where the vertices of a finer mesh could not be counted in an int.
///
/// [Loop. Smooth subdivision surfaces based on triangles. 1987]
Subdivision subdivide(const Positions& rest, const Connectivity& connectivity,
                      const SubdivideOptions& options = {});

/// The frames and the rest pose of a sequence on the finer mesh, made when they are read. Throws
/// std::invalid_argument for one of another number of vertices.
std::shared_ptr<const FrameSource> subdivided(std::shared_ptr<const FrameSource> source,
                                              const Subdivision& subdivision);

}  // namespace mimetra
