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
  /// Weight of the difference between each triangle's deformation and the identity.
  double identity = 0.001;
  /// First and last weight of the distances to the closest points. The weight grows by a constant
  /// factor a step. Distances are shares of the target's size (SurfaceFit::target_box).
  double first_closest = 1;
  double last_closest = 5000;
  /// Number of solves with closest points, after one solve with markers only.
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

/// A source deformed onto the target's surface.
struct SurfaceFit {
  Positions positions;  ///< of the source's vertices (N x 3), in the target's unit and place
  /// False for vertices of parts that no marker reaches (N). Only the similarity of the markers
  /// moves them.
  std::vector<bool> reached;
  /// Same for the target's vertices. The source is not drawn to parts that no marker reaches.
  std::vector<bool> target_reached;
  /// subject_box() of the target's markers. Its diagonal is the unit of distances.
  SubjectBox target_box = {};
};

/// Throws std::invalid_argument if a mesh does not have one finite position a vertex, and what
/// check_markers() throws.
void check_fit(const TriMesh& source, const TriMesh& target, const std::vector<Marker>& markers);

/// Deforms `source` so that its markers coincide with the markers of `target`, and its surface with
/// the target's surface. The similarity of the markers comes first. Each solve then minimises the
/// sum of
/// - smoothness * |T_i - T_j|^2 over triangles i and their neighbours j, across edges,
/// - identity * |T_i - I|^2 over triangles,
/// - closest * |v - c|^2 over vertices, except in the first solve.
///
/// T_i is the deformation of triangle i and of a fourth vertex above it. c is the nearest point of
/// the target that faces less than 90 degrees from v's normal. A vertex on the source's border is
/// matched only to border edges of the target that lead the same way. No other vertex is matched to
/// the border.
///
/// c does not count if it is farther from v than 10 % of target_box's diagonal, or 2 % on borders.
/// Source surface that reaches beyond an open target therefore stays. Parts of the target that no
/// marker reaches, such as teeth, have no c. Coinciding vertices are welded.
///
/// x, y and z of vertices and fourth vertices share one sparse system, whose pattern is analysed
/// once. Throws what check_fit() throws, and std::invalid_argument if an option is out of range.
/// Throws MismatchError if two markers are at one place of the source or of the target, and
/// Cancelled.
///
/// [Sumner, Popovic. Deformation Transfer for Triangle Meshes. ACM TOG 23(3), 2004], section 4
SurfaceFit fit_to_surface(const TriMesh& source, const TriMesh& target,
                          const std::vector<Marker>& markers, const SurfaceFitOptions& options = {},
                          const Context& context = {});

}  // namespace mimetra
