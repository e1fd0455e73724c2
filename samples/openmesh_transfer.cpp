// An OpenMesh character follows another one's performance: only its positions change.

#include <iostream>

#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/mesh/openmesh.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/transfer/vertex_transfer.h>
using namespace mimetra;
using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

/// A painted mesh with a property of its own, as an application would hold it.
Mesh painted(const TriMesh& shape) {
  Mesh mesh;
  for (const auto& p : shape.positions.rowwise()) mesh.add_vertex(Mesh::Point(p[0], p[1], p[2]));
  const auto vertex = [](int index) { return OpenMesh::VertexHandle(index); };
  for (const auto& t : shape.connectivity.triangles.rowwise()) {
    mesh.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  mesh.request_vertex_colors();
  mesh.request_vertex_texcoords2D();
  auto stiffness = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, double>(mesh, "stiffness");
  for (const auto v : mesh.vertices()) {
    mesh.set_color(v, Mesh::Color(v.idx() % 256, 100, 50));
    mesh.set_texcoord2D(v, Mesh::TexCoord2D(mesh.point(v)[0], mesh.point(v)[1]));
    stiffness[v] = 0.5 * v.idx();
  }
  return mesh;
}

int main() {
  const MorphableModel head = samples::parametric_head();
  const BlendshapeModel actor = head.person(Eigen::Vector4d(1, 0, 0, 0));
  const MeshSequence performance = actor.animate(samples::parametric_performance().weights);
  const Mesh character =
      painted({head.person(Eigen::Vector4d(0, 1, 0, 0)).neutral(), head.connectivity()});

  const Components components = decompose(performance.slice(0, 120, 4), {.count = 10});
  const Regions regions = find_regions(components, {.radius = 0.1 * performance.diameter()});
  const TriMesh target = from_openmesh(character);
  const VertexTransfer transfer(performance.rest(), target.positions, target.connectivity.triangles,
                                regions.triangles, {.inside = regions.inside});
  const MeshSequence result = performance.with_frames(transfer.frames(performance));

  Mesh smiling = with_positions(character, result.frame(60));
  auto stiffness = OpenMesh::getProperty<OpenMesh::VertexHandle, double>(smiling, "stiffness");
  int moved = 0;
  for (const auto v : character.vertices()) {
    if (smiling.color(v) != character.color(v) || smiling.texcoord2D(v) != character.texcoord2D(v))
      return 1;
    if (stiffness[v] != 0.5 * v.idx()) return 1;
    if (smiling.point(v) != character.point(v)) ++moved;
  }
  std::cout << moved << " of " << character.n_vertices()
            << " vertices moved, all else is the same\n";
  return moved > 0 ? 0 : 1;
}
