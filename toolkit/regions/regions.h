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

/// Vertices that a region of interest contains.
enum class RegionShape {
  disc,    ///< vertices within a geodesic radius of the component's centre
  support  ///< fewest vertices that contain 95 % of the component's energy
};

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
  /// Take the strongest components until the union contains this share of the motion energy. If
  /// empty, take all components.
  std::optional<double> coverage = {};
  /// Vertices that regions may contain (N); empty for all.
  std::vector<bool> inside = {};
  /// Vertices that may not be centres (N); empty for none. A component that moves one of them most
  /// gives no region.
  std::vector<bool> no_centers = {};
  /// Distances along the rest pose; by default SurfaceDistances of its exactly welded vertices.
  DistanceFunction distances = {};

  static constexpr Option kShape{"shape", &RegionOptions::shape};
  static constexpr Option kCoverage{
      "coverage", &RegionOptions::coverage, {.minimum = 1e-9, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kShape, kCoverage); }
};

/// A region of interest: vertices that one component moves.
struct Region {
  int component = -1;  ///< row of Components; -1 for a region from a file
  VertexIndex center = -1;
  double radius = 0;  ///< length; distance of the farthest vertex for RegionShape::support
  std::vector<VertexIndex> vertices;  ///< ascending
  double energy = 0;                  ///< motion energy |w_k|^2 |c_k|^2 of its component(s)
  double energy_share = 0;            ///< share of all motion energy on its vertices
  /// Connected part of the surface that contains the centre, 0 for the largest, and the part's
  /// share of the area. -1 for a region from a file.
  int surface_part = -1;
  double surface_share = 0;
  /// Target expression for which the region was added; empty for regions of the source.
  std::string added_for = {};
};

/// Regions in the order of their component's motion energy, and their triangles.
struct Regions {
  int vertices = 0;  ///< N of the mesh
  std::vector<Region> regions;
  std::vector<bool> inside;    ///< vertex is in the union (N)
  std::vector<int> triangles;  ///< L: triangles with a vertex in the union, ascending
  int all_triangles = 0;       ///< M of the mesh
  double energy_share = 0;     ///< share of the motion energy in the union, 0 if unknown
  /// Share of the motion energy on each vertex (N); empty for regions from files.
  Eigen::VectorXd vertex_energy;
  /// Notes for the user: components with one centre were merged, the requested coverage was not
  /// reached, or a component died.
  std::vector<std::string> notes;
  /// Share of the motion that each vertex takes (N), in [0, 1], for a soft border; empty for a hard
  /// border. With a soft border, all vertices with a positive share are inside. `regions` may
  /// contain only the vertices with share 1.
  Eigen::VectorXd weights = {};

  int vertex_count() const;
  /// False for painted regions and regions from files without energy.
  bool energy_is_known() const { return vertex_energy.size() > 0 || energy_share > 0; }
  double vertex_share() const { return vertices ? double(vertex_count()) / vertices : 0; }
  double triangle_share() const {
    return all_triangles ? double(triangles.size()) / all_triangles : 0;
  }
};

/// Motion energy of each component, |w_k|^2 |c_k|^2 (K).
Eigen::VectorXd motion_energy(const Components& components);

/// One region for each centre of the components, in the order of motion energy. Components with the
/// same centre (also across a welded seam) are merged. Vertices without a path to the centre are
/// left out. Throws std::invalid_argument for options out of range, and if `inside` or `no_centers`
/// does not have one entry per vertex.
Regions find_regions(const Components& components, const RegionOptions& options = {},
                     const Context& = {});

/// Keeps only the first `count` regions (all, if there are fewer). Throws std::invalid_argument if
/// count < 1.
Regions strongest(const Regions& regions, int count, const Triangles& triangles);

/// Keeps the first regions until their union contains the share `coverage` of the motion energy.
/// Keeps all, with a note, if they contain less. `rest` N x 3. \pre vertex_energy is known
Regions covering(Regions regions, double coverage, const Positions& rest,
                 const Triangles& triangles);

/// Number of first regions whose union contains at most this share of the triangles; 0 if the first
/// contains more.
int regions_within(const Regions& regions, double share, const Triangles& triangles);

/// Appends regions. Their vertices, centre, radius and added_for must be set.
Regions with_added(const Regions& regions, std::vector<Region> added, const Triangles& triangles);

/// Carries discs from a simplified mesh to the original mesh: discs of the same radius around the
/// same vertices. `distances` and `triangles` (M x 3) are the original mesh's. `vertex_energy` (N):
/// share of the motion energy on each vertex. `inside` (N, empty for all): vertices that regions
/// may contain. Throws std::invalid_argument if the regions do not fit the simplified mesh or have
/// no centre, and whatever the distances throw.
Regions carried_regions(const Regions& regions, const Simplification& simplified,
                        Eigen::VectorXd vertex_energy, const Triangles& triangles,
                        const DistanceFunction& distances, const std::vector<bool>& inside = {});

/// One region per list of vertices. Throws MismatchError that names the first vertex outside [0,
/// vertices).
Regions regions_from_vertices(int vertices, const Triangles& triangles,
                              const std::vector<std::vector<VertexIndex>>& lists);

/// Throws std::invalid_argument, which begins with `weights`, unless there are `vertices` weights
/// in [0, 1].
void check_weights(const Eigen::VectorXd& weights, Eigen::Index vertices);

/// A single region of the vertices that take a share of the motion. `weights` (N) are in [0, 1]; at
/// least one is positive. Throws std::invalid_argument otherwise.
Regions painted_region(const Eigen::VectorXd& weights, const Triangles& triangles);

/// Regions with a soft border: exactly the vertices of positive weight are inside. Throws as
/// check_weights().
Regions with_weights(Regions regions, const Eigen::VectorXd& weights, const Triangles& triangles);

/// Triangles with a corner of positive weight, ascending.
std::vector<int> triangles_in(const Eigen::VectorXd& weights, const Triangles& triangles);

/// Every triangle of a mesh, as used for a full transfer.
std::vector<int> all_triangles(const Triangles& triangles);

/// Fields `region` (index of the strongest region, -1 outside), `region_count` and `roi` (0/1) on
/// vertices, and `in_L` on triangles. If any regions were added, `added` is 1 on vertices whose
/// strongest region was added. Soft borders also have `weight` on vertices.
std::vector<Field> fields_of(const Regions& regions);

/// Fields `support_k` (support map) and `component_k` (displacement vectors, unit of the mesh) of
/// the component of each region k, numbered as in the field `region`. Regions from files have none.
std::vector<Field> component_fields(const Components& components, const Regions& regions);

}  // namespace mimetra
