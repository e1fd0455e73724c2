#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/option.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

struct Simplification;

/// What a region of interest holds.
enum class RegionShape {
  disc,    ///< vertices within a geodesic radius of the component's centre
  support  ///< fewest vertices that carry 95 % of the component's energy
};

/// As people choose it.
constexpr std::string_view choice_name(RegionShape value) {
  switch (value) {
    case RegionShape::disc:
      return "disc";
    case RegionShape::support:
      return "support";
  }
  return {};
}

struct RegionOptions {
  RegionShape shape = RegionShape::disc;
  /// Radius of a disc, length > 0; by default this share of the rest pose's diameter().
  static constexpr double kRadiusShare = 0.1;
  std::optional<double> radius = {};
  /// Take the strongest components until the union holds this share of the motion energy; without
  /// it, all components.
  std::optional<double> coverage = {};
  /// Where regions may lie (N), empty for everywhere: they hold no other vertex.
  std::vector<bool> inside = {};
  /// Vertices around which no region is made (N), empty for none of them: a component that moves
  /// one of them most gives none.
  std::vector<bool> no_centers = {};
  /// Distances along the rest pose; by default SurfaceDistances of its exactly welded vertices.
  DistanceFunction distances = {};

  static constexpr Option kShape{"shape", &RegionOptions::shape};
  static constexpr Option kCoverage{
      "coverage", &RegionOptions::coverage, {.minimum = 1e-9, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kShape, kCoverage); }
};

/// A region of interest: where one component moves the face.
struct Region {
  int component = -1;  ///< row of Components; -1 for a region that was read
  VertexIndex center = -1;
  double radius = 0;  ///< length; for RegionShape::support the distance of its farthest vertex
  std::vector<VertexIndex> vertices;  ///< ascending
  double energy = 0;                  ///< motion energy |w_k|^2 |c_k|^2 of its component(s)
  double energy_share = 0;            ///< share of all motion energy on its vertices
  /// Connected part of the surface that the centre lies on, 0 for the largest, and that part's
  /// share of the area; -1 for a region that was read.
  int surface_part = -1;
  double surface_share = 0;
  /// The target's expression that it was added for; empty for the source's own.
  std::string added_for = {};
};

/// Regions in the order of their component's motion energy, and the triangles they take part in.
struct Regions {
  int vertices = 0;  ///< N of the mesh
  std::vector<Region> regions;
  std::vector<bool> inside;    ///< vertex is in the union (N)
  std::vector<int> triangles;  ///< L: triangles with a vertex in the union, ascending
  int all_triangles = 0;       ///< M of the mesh
  double energy_share = 0;     ///< share of the motion energy that the union holds, 0 if unknown
  /// Share of the motion energy on each vertex (N); empty for regions that were read.
  Eigen::VectorXd vertex_energy;
  /// What the user should know: components with one centre were merged, the coverage asked for was
  /// not reached, a component died.
  std::vector<std::string> notes;
  /// Share of the motion that each vertex takes (N), in [0, 1], where the border is soft: vertices
  /// inside are then those that take some, while `regions` may hold only those that take all of it.
  /// Empty for a hard border.
  Eigen::VectorXd weights = {};

  int vertex_count() const;
  /// False for regions that were painted or read without it.
  bool energy_is_known() const { return vertex_energy.size() > 0 || energy_share > 0; }
  double vertex_share() const { return vertices ? double(vertex_count()) / vertices : 0; }
  double triangle_share() const {
    return all_triangles ? double(triangles.size()) / all_triangles : 0;
  }
};

/// Motion energy of each component, |w_k|^2 |c_k|^2 (K).
Eigen::VectorXd motion_energy(const Components& components);

/// Region k = the vertices within the radius of the centre of component k. Ordered by motion
/// energy; components with the same centre (also across a welded seam) are merged. A vertex that no
/// way along the surface reaches is in no region. Throws std::invalid_argument for options out of
/// range, and for numbers of vertices `inside` or `no_centers` that are not the mesh's.
Regions find_regions(const Components& components, const RegionOptions& options = {},
                     const Context& = {});

/// The first `count` regions only (all, where there are fewer). Throws std::invalid_argument where
/// count < 1.
Regions strongest(const Regions& regions, int count, const Triangles& triangles);

/// The first regions, as many as it takes until their union holds the share `coverage` of the
/// motion energy, or all, with a note. \pre vertex_energy is known. `rest` N x 3.
Regions covering(Regions regions, double coverage, const Positions& rest,
                 const Triangles& triangles);

/// How many of the first regions have no more than this share of the triangles in their union; 0
/// where the first has more.
int regions_within(const Regions& regions, double share, const Triangles& triangles);

/// The regions and further ones behind them, of which vertices, centre, radius and what they were
/// added for are known.
Regions with_added(const Regions& regions, std::vector<Region> added, const Triangles& triangles);

/// Discs that were found on a simplified mesh, on the one that it was made from: of the same radius
/// around the same vertices, by `distances` along that one, whose triangles these are (M x 3).
/// `vertex_energy` (N): each vertex' share of the motion energy on it, of which regions hold
/// theirs. Of vertices not `inside` (N, empty for all) none is in a region. Throws
/// std::invalid_argument for regions of another number of vertices than were kept, and for one that
/// has no centre; what the distances throw.
Regions carried_regions(const Regions& regions, const Simplification& simplified,
                        Eigen::VectorXd vertex_energy, const Triangles& triangles,
                        const DistanceFunction& distances, const std::vector<bool>& inside = {});

/// One region per entry from vertex lists. Throws MismatchError that names the first vertex
/// outside 0 .. vertices - 1.
Regions regions_from_vertices(int vertices, const Triangles& triangles,
                              const std::vector<std::vector<VertexIndex>>& lists);

/// Throws std::invalid_argument, which begins with `weights`, unless there is one weight in [0, 1]
/// for each of so many vertices.
void check_weights(const Eigen::VectorXd& weights, Eigen::Index vertices);

/// One region, of the vertices that take a share of the motion: `weights` (N), each in [0, 1], of
/// which one is above 0. Throws std::invalid_argument for others.
Regions painted_region(const Eigen::VectorXd& weights, const Triangles& triangles);

/// Regions with a soft border: the vertices of weight above 0 are inside, and no others. Throws
/// what check_weights() throws.
Regions with_weights(Regions regions, const Eigen::VectorXd& weights, const Triangles& triangles);

/// Triangles with a corner of weight above 0, ascending.
std::vector<int> triangles_in(const Eigen::VectorXd& weights, const Triangles& triangles);

/// Every triangle of a mesh: the regions of a full transfer.
std::vector<int> all_triangles(const Triangles& triangles);

/// Fields `region` (index of the strongest region, -1 outside), `region_count`, `roi` (0/1) on
/// vertices and `in_L` on triangles; `added` (1 in added regions only) on vertices where there are
/// any, and `weight` on vertices where the border is soft.
std::vector<Field> fields_of(const Regions& regions);

/// `support_k` (support map) and `component_k` (displacement vectors, unit of the mesh) of the
/// component of each region k of `regions`, numbered as in the field `region`. Regions that were
/// read have none.
std::vector<Field> component_fields(const Components& components, const Regions& regions);

}  // namespace mimetra
