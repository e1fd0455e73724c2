#include "toolkit/correspondence/found_correspondence.h"

#include <algorithm>

#include "toolkit/correspondence/marker_check.h"
#include "toolkit/correspondence/reached_triangles.h"
#include "toolkit/correspondence/unmarked_parts.h"
#include "toolkit/mesh/normals.h"

namespace mimetra {
namespace {

/// Of `triangles`, those of `counted` only.
int folded_triangles(const Positions& positions, const Triangles& triangles,
                     const std::vector<bool>& counted) {
  const Positions at_vertices = vertex_normals(positions, triangles);
  const Positions normals = triangle_normals(positions, triangles);
  int folded = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Eigen::RowVector3d around = Eigen::RowVector3d::Zero();
    for (const VertexIndex v : triangles.row(t)) around += at_vertices.row(v).normalized();
    if (counted[t] && normals.row(t).dot(around) < 0) ++folded;
  }
  return folded;
}

/// With triangles that lead the other way round.
TriMesh turned_over(TriMesh mesh) {
  mesh.connectivity.triangles.col(1).swap(mesh.connectivity.triangles.col(2));
  return mesh;
}

}  // namespace

FoundCorrespondence find_correspondence(const TriMesh& source, const TriMesh& target,
                                        const std::vector<Marker>& markers,
                                        const SurfaceFitOptions& options, const Context& context) {
  check_fit(source, target, markers);
  FoundCorrespondence found;
  found.inside_out = is_inside_out(source, target, markers);
  const TriMesh facing = found.inside_out ? turned_over(target) : target;
  found.fit = fit_to_surface(source, facing, markers, options, context);
  const Triangles& triangles = source.connectivity.triangles;
  const Context at_end = context.part(1, 1);
  found.correspondence = with_unmarked_parts(pair_triangles(found.fit, triangles, facing, at_end),
                                             found.fit, source, facing, at_end);
  found.quality = quality_of(found.correspondence, found.fit.target_box.diagonal);
  const ReachedTriangles parts(found.fit.positions, triangles, found.fit.reached);
  std::vector<bool> is_partner(triangles.rows(), false);
  for (const Correspondence::Part& part : found.correspondence.parts) {
    is_partner[part.triangle] = true;
  }
  std::vector<bool> counted;
  for (const int number : parts.numbers) counted.push_back(is_partner[number]);
  found.quality.partners = static_cast<int>(std::ranges::count(is_partner, true));
  found.quality.folded = folded_triangles(found.fit.positions, parts.triangles, counted);
  return found;
}

}  // namespace mimetra
