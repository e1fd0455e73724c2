#pragma once

#include <vector>

#include "toolkit/correspondence/markers.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/surface_parts.h"

namespace mimetra {

struct SurfaceFitOptions {
  /// Weight of differences between the deformations of neighbouring triangles.
  double smoothness = 1;
  /// Weight of what each triangle's deformation differs from none.
  double identity = 0.001;
  /// Weights of the distances to the closest points, first and last; between them it grows by one
  /// factor a step. Distances are shares of the size of the target (SurfaceFit::target_box).
  double first_closest = 1;
  double last_closest = 5000;
  /// Solves with closest points, after the one with markers only.
  int steps = 4;

  static constexpr Option kSmoothness{
      "smoothness", &SurfaceFitOptions::smoothness, {.minimum = 0, .maximum = 1e6}};
  static constexpr Option kIdentity{
      "identity", &SurfaceFitOptions::identity, {.minimum = 1e-6, .maximum = 1e6}};
  static constexpr Option kFirstClosest{
      "first_closest", &SurfaceFitOptions::first_closest, {.minimum = 1e-6, .maximum = 1e9}};
  static constexpr Option kLastClosest{
      "last_closest", &SurfaceFitOptions::last_closest, {.minimum = 1e-6, .maximum = 1e9}};
  static constexpr Option kSteps{
      "steps", &SurfaceFitOptions::steps, {.minimum = 0, .maximum = 100}};
  static constexpr auto declared() {
    return std::tuple(kSmoothness, kIdentity, kFirstClosest, kLastClosest, kSteps);
  }
};

/// A source whose surface lies on the target's.
struct SurfaceFit {
  Positions positions;  ///< of the source's vertices (N x 3), in the target's unit and place
  /// False for vertices of parts that no marker reaches, which the similarity of the markers alone
  /// has carried (N).
  std::vector<bool> reached;
  /// The same of the target's vertices, which are no place for the source's.
  std::vector<bool> target_reached;
  /// Of the target's parts that a marker reaches: the unit of distances.
  SubjectBox target_box = {};
};

/// Throws std::invalid_argument for a mesh that has not a position for each vertex, and what
/// check_markers() throws.
void check_fit(const TriMesh& source, const TriMesh& target, const std::vector<Marker>& markers);

/// Deforms `source` so that its markers are on those of `target` and its surface on the target's:
/// the markers' similarity first, then the least sum of
/// - smoothness * |T_i - T_j|^2 over triangles i and their neighbours j, across edges,
/// - identity * |T_i - I|^2 over triangles,
/// - closest * |v - c|^2 over vertices, none in the first solve,
/// where T_i is what happens to triangle i and to a fourth vertex above it, and c the point of the
/// target that is nearest to v and faces less than 90 degrees from v's normal. A c on the target's
/// border does not count, unless v is on the source's border; such a v is matched to nothing else,
/// and only to border edges that lead the same way. A c does not count either where it is farther
/// from v than 10 % of the diagonal of the target's parts with markers, or 2 % on borders: what
/// reaches beyond an open target stays there; nor does one on a part of the target that no marker
/// reaches, such as teeth. Vertices at one place are one.
///
/// One sparse system for the x, y and z of vertices and fourth vertices; its pattern is analysed
/// once. Throws what check_fit() throws, std::invalid_argument for options out of range,
/// MismatchError for two markers at one place of the source or of the target, Cancelled.
///
/// [Sumner, Popovic. Deformation Transfer for Triangle Meshes. ACM TOG 23(3), 2004], section 4
SurfaceFit fit_to_surface(const TriMesh& source, const TriMesh& target,
                          const std::vector<Marker>& markers, const SurfaceFitOptions& options = {},
                          const Context& context = {});

}  // namespace mimetra
