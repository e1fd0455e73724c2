// Another character follows a performance in an OpenMesh program. The mesh has quads, texture
// coordinates and a property of the application. Regions become properties and vertices move;
// everything else is unchanged.

#include <iostream>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/mesh/openmesh.h>
#include <mimetra/toolkit/regions/regions.h>
#include <mimetra/toolkit/transfer/vertex_transfer.h>
using namespace mimetra;
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;
using Vertex = OpenMesh::VertexHandle;

/// Mesh with the texture coordinates and the property of an application.
Mesh textured(const TriMesh& shape) {
  Mesh mesh = to_openmesh<Mesh>(shape);
  mesh.request_vertex_texcoords2D();
  auto stiffness = OpenMesh::getOrMakeProperty<Vertex, double>(mesh, "stiffness");
  for (const auto v : mesh.vertices()) {
    mesh.set_texcoord2D(v, Mesh::TexCoord2D(mesh.point(v)[0], mesh.point(v)[1]));
    stiffness[v] = 0.5 * v.idx();
  }
  return mesh;
}

int main() {
  const MorphableModel head = samples::parametric_head();
  const BlendshapeModel actor = head.person(Eigen::Vector4d(1, 0, 0, 0));
  const MeshSequence given = actor.animate(samples::parametric_performance().weights);

  // Data of the application: a mesh for every frame, and the character that follows.
  std::vector<Mesh> take;
  for (int f = 0; f < given.frames(); f += 4) {
    take.push_back(textured({Positions(given.frame(f)), given.connectivity()}));
  }
  const Mesh source = textured({given.rest(), given.connectivity()});
  Mesh character =
      textured({head.person(Eigen::Vector4d(0, 1, 0, 0)).neutral(), head.connectivity()});
  const Mesh before = character;

  const TriMesh rest = from_openmesh(source), target = from_openmesh(character);
  const MeshSequence performance = sequence_from_openmesh(take).with_rest(rest.positions);
  const Components components = decompose(performance, {.count = 10});
  const Regions regions = find_regions(components, {.radius = 0.1 * performance.diameter()});
  const VertexTransfer transfer(rest.positions, target.positions, target.connectivity.triangles,
                                regions.triangles, {.inside = regions.inside});
  set_fields(character, fields_of(regions));
  set_positions(character, performance.with_frames(transfer.frames(performance)).frame(15));

  const auto stiffness = OpenMesh::getProperty<Vertex, double>(character, "stiffness");
  const auto roi = OpenMesh::getProperty<Vertex, int>(character, "v:roi");
  int moved = 0;
  for (const auto v : character.vertices()) {
    if (character.texcoord2D(v) != before.texcoord2D(v) || stiffness[v] != 0.5 * v.idx()) return 1;
    const bool moves = character.point(v) != before.point(v);
    if (moves && roi[v] == 0) return 1;
    moved += moves ? 1 : 0;
  }
  std::cout << moved << " of " << character.n_vertices()
            << " vertices moved, all of them in regions; all else is the same\n";
  return moved > 0 ? 0 : 1;
}
