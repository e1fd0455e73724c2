#pragma once

#include <memory>
#include <string_view>

#include <Eigen/SparseCore>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// Placement of the vertices of finer triangles.
enum class SubdivisionScheme {
  loop,     ///< on a smooth surface; the given vertices also move
  midpoint  ///< on the given triangles, so that the surface does not change
};

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
  /// Number of times that each triangle is split into four.
  int times = 1;

  static constexpr Option kScheme{"scheme", &SubdivideOptions::scheme};
  static constexpr Option kTimes{"times", &SubdivideOptions::times, {.minimum = 1, .maximum = 6}};
  static constexpr auto declared() { return std::tuple(kScheme, kTimes); }
};

/// Finer triangles. Their vertices are the given ones, followed by the middles of edges.
struct Subdivision {
  /// Weights of the given vertices in each new vertex (N' x N); rows add up to 1.
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;
  /// Four triangles for each given one, with its texture coordinates, groups and materials.
  std::shared_ptr<const Connectivity> connectivity;
};

/// Subdivides the triangles of a mesh. Vertices that coincide in `rest` (N x 3) count as one, so
/// that texture seams do not open. Edges not shared by exactly two triangles are borders. Throws
/// std::invalid_argument for options out of range, or if the finer mesh would exceed the range of
/// int indices.
///
/// [Loop. Smooth subdivision surfaces based on triangles. 1987]
Subdivision subdivide(const Positions& rest, const Connectivity& connectivity,
                      const SubdivideOptions& options = {});

/// Frames and rest pose of a sequence on the finer mesh; frames are computed on reading. Throws
/// std::invalid_argument if the number of vertices differs.
std::shared_ptr<const FrameSource> subdivided(std::shared_ptr<const FrameSource> source,
                                              const Subdivision& subdivision);

}  // namespace mimetra
