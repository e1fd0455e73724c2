// CGAL's heat method takes 20 s to compile: no other file of the benchmarks sees it.
#include "tests/bench/cgal_geodesics.h"

#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

namespace mimetra::bench {
namespace {

using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
using Vertex = Mesh::Vertex_index;
using HeatMethod =
    CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh,
                                                           CGAL::Heat_method_3::Intrinsic_Delaunay>;

Mesh mesh_of(const geodesic::Positions& positions, const geodesic::Triangles& triangles) {
  Mesh mesh;
  for (const auto row : positions.rowwise()) mesh.add_vertex({row[0], row[1], row[2]});
  for (const auto row : triangles.rowwise()) {
    mesh.add_face(Vertex(static_cast<unsigned>(row[0])), Vertex(static_cast<unsigned>(row[1])),
                  Vertex(static_cast<unsigned>(row[2])));
  }
  return mesh;
}

}  // namespace

std::vector<Eigen::VectorXd> cgal_distances(const geodesic::Positions& positions,
                                            const geodesic::Triangles& triangles,
                                            const std::vector<int>& sources) {
  Mesh mesh = mesh_of(positions, triangles);
  HeatMethod method(mesh);
  auto map = mesh.add_property_map<Vertex, double>("v:distance").first;
  std::vector<Eigen::VectorXd> result;
  for (const int source : sources) {
    const Vertex vertex(static_cast<unsigned>(source));
    method.add_source(vertex);
    method.estimate_geodesic_distances(map);
    method.remove_source(vertex);
    Eigen::VectorXd& distances = result.emplace_back(positions.rows());
    for (const Vertex v : mesh.vertices()) distances[static_cast<int>(v)] = map[v];
  }
  return result;
}

}  // namespace mimetra::bench
