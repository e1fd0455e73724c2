#pragma once

#include <functional>
#include <map>

#include "tests/transfer/faces.h"

/// A face that files cut along a seam.
namespace mimetra::test {

/// Triangles of which some have vertices of their own.
struct Cut {
  Triangles triangles;
  /// The vertex before the cut, for each vertex; copies follow the others.
  std::vector<VertexIndex> original;
};

/// Gives the triangles for which `beyond` is true copies of the vertices `along`.
inline Cut cut(const Triangles& triangles, int vertices, const std::vector<VertexIndex>& along,
               const std::function<bool(int triangle)>& beyond) {
  Cut result{triangles, std::vector<VertexIndex>(vertices)};
  for (int v = 0; v < vertices; ++v) result.original[v] = v;
  std::map<VertexIndex, VertexIndex> copies;
  for (const VertexIndex vertex : along) {
    copies[vertex] = static_cast<int>(result.original.size());
    result.original.push_back(vertex);
  }
  for (int t = 0; t < triangles.rows(); ++t) {
    if (!beyond(t)) continue;
    for (VertexIndex& vertex : result.triangles.row(t)) {
      if (copies.contains(vertex)) vertex = copies.at(vertex);
    }
  }
  return result;
}

/// patch() with a mouth: its upper lip 81, 82, 83 lies on the lower one 39, 40, 41 at rest. A seam
/// from the chin to the forehead crosses it: vertices from 84 on are copies of those on the line,
/// 82 and 40 among them, so that four vertices are at one place there.
struct SeamedFace {
  static constexpr int kVertices = 84;  ///< without the copies
  static constexpr VertexIndex kUpperLip = 81, kLowerLip = 39;

  SeamedFace() {
    const Shape plain = patch();
    const auto beyond = [](const Shape& of, int axis, double line) {
      return [&of, axis, line](int t) {
        double sum = 0;
        for (const VertexIndex v : of.triangles.row(t)) sum += of.positions(v, axis);
        return sum / 3 > line;
      };
    };
    const Cut mouth = cut(plain.triangles, 81, {39, 40, 41}, beyond(plain, 1, 4));
    lips = mouth.original;
    whole = {plain.positions(lips, Eigen::all), mouth.triangles};
    const Cut seam = cut(whole.triangles, kVertices, {4, 13, 22, 31, 40, 82, 49, 58, 67, 76},
                         beyond(whole, 0, 4));
    original = seam.original;
    triangles = seam.triangles;
  }

  /// The same with the copies, for one value a vertex.
  template <typename T>
  std::vector<T> with_copies(const std::vector<T>& values) const {
    std::vector<T> result;
    for (const VertexIndex v : original) result.push_back(values[v]);
    return result;
  }
  Positions with_copies(const Positions& pose) const { return pose(original, Eigen::all); }
  Shape with_copies(const Shape& shape) const { return {with_copies(shape.positions), triangles}; }
  Frames with_copies(const Frames& frames) const {
    Frames result(frames.rows(), 3 * static_cast<Eigen::Index>(original.size()));
    for (int f = 0; f < frames.rows(); ++f) {
      const Positions pose =
          with_copies(Positions(PositionsView(frames.row(f).data(), kVertices, 3)));
      result.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
    }
    return result;
  }
  MeshSequence with_copies(const MeshSequence& take) const {
    return {connectivity_of(with_copies(Shape{take.rest(), whole.triangles})),
            with_copies(take.positions()),
            {},
            with_copies(take.rest())};
  }

  /// The mesh without copies, squeezed and bent.
  Shape bent() const { return {bent_patch().positions(lips, Eigen::all), whole.triangles}; }

  /// Arbitrary poses of `rest`, the mesh without copies. The lips touch but in the frame `open`.
  static MeshSequence talking(const Shape& rest, int frames, int open) {
    Frames poses = shaken(rest, frames, 0.2).positions();
    for (int f = 0; f < frames; ++f) {
      const Eigen::RowVector3d gap =
          f == open ? Eigen::RowVector3d(0, 0.5, 0.25) : Eigen::RowVector3d::Zero();
      for (int i = 0; i < 3; ++i) {
        poses.row(f).segment<3>(3 * (kUpperLip + i)) =
            poses.row(f).segment<3>(3 * (kLowerLip + i)) + gap;
      }
    }
    return {connectivity_of(rest), poses, {}, rest.positions};
  }

  Shape whole;                        ///< the mesh without copies
  Triangles triangles;                ///< of the mesh with copies
  std::vector<VertexIndex> original;  ///< vertex of `whole`, for each vertex
  std::vector<VertexIndex> lips;      ///< vertex of patch(), for each vertex of `whole`
};

}  // namespace mimetra::test
