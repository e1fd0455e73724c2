#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/mesh/openmesh.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct RichTraits : OpenMesh::DefaultTraits {
  VertexAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Color |
                   OpenMesh::Attributes::TexCoord2D);
  FaceAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
};

template <typename Traits>
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

template <typename Traits>
Mesh<Traits> openmesh_of(const test::Shape& shape) {
  using Point = typename Mesh<Traits>::Point;
  Mesh<Traits> mesh;
  for (const auto& p : shape.positions.rowwise()) mesh.add_vertex(Point(p[0], p[1], p[2]));
  for (const auto& t : shape.triangles.rowwise()) {
    mesh.add_face(mesh.vertex_handle(t[0]), mesh.vertex_handle(t[1]), mesh.vertex_handle(t[2]));
  }
  return mesh;
}

template <typename Traits>
class AnyOpenMesh : public testing::Test {};

using AllTraits =
    testing::Types<OpenMesh::DefaultTraits, OpenMesh::DefaultTraitsDouble, RichTraits>;
TYPED_TEST_SUITE(AnyOpenMesh, AllTraits);

TYPED_TEST(AnyOpenMesh, GivesItsPositionsAndTriangles) {
  const test::Shape shape = test::octahedron();
  const TriMesh mesh = from_openmesh(openmesh_of<TypeParam>(shape));
  EXPECT_EQ(mesh.positions, shape.positions);
  // OpenMesh may start a face at another corner.
  EXPECT_TRUE(same_faces(mesh.connectivity, Connectivity::from_triangles(6, shape.triangles)));
}

TYPED_TEST(AnyOpenMesh, GivesVerticesWithoutFaces) {
  test::Shape shape = test::octahedron();
  shape.positions.conservativeResize(8, 3);
  shape.positions.bottomRows(2).setConstant(3);
  EXPECT_EQ(from_openmesh(openmesh_of<TypeParam>(shape)).connectivity.vertices, 8);
}

TYPED_TEST(AnyOpenMesh, TakesNewPositions) {
  const test::Shape shape = test::octahedron();
  const Positions moved = 2 * shape.positions;
  EXPECT_EQ(from_openmesh(with_positions(openmesh_of<TypeParam>(shape), moved)).positions, moved);
}

TYPED_TEST(AnyOpenMesh, RefusesPositionsOfAnotherVertexCount) {
  EXPECT_THAT(
      [] { with_positions(openmesh_of<TypeParam>(test::octahedron()), Positions::Zero(5, 3)); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("5 positions for a mesh of 6 vertices")));
}

TEST(OpenMeshBridge, KeepsAllProperties) {
  Mesh<RichTraits> mesh = openmesh_of<RichTraits>(test::octahedron());
  OpenMesh::FPropHandleT<int> tag;
  mesh.add_property(tag, "tag");
  for (const auto vertex : mesh.vertices()) {
    mesh.set_color(vertex, {vertex.idx(), 1, 2});
    mesh.set_texcoord2D(vertex, {0.5f, float(vertex.idx())});
  }
  for (const auto face : mesh.faces()) mesh.property(tag, face) = 10 * face.idx();

  const auto moved = with_positions(mesh, Positions::Ones(6, 3));

  OpenMesh::FPropHandleT<int> found;
  ASSERT_TRUE(moved.get_property_handle(found, "tag"));
  for (const auto vertex : moved.vertices()) {
    EXPECT_EQ(moved.color(vertex), mesh.color(vertex));
    EXPECT_EQ(moved.texcoord2D(vertex), mesh.texcoord2D(vertex));
  }
  for (const auto face : moved.faces()) EXPECT_EQ(moved.property(found, face), 10 * face.idx());
}

TEST(OpenMeshBridge, KeepsTheOrderOfFaces) {
  const auto mesh = openmesh_of<RichTraits>(test::grid(4, 3));
  const auto moved = with_positions(mesh, Positions::Random(12, 3));
  EXPECT_EQ(from_openmesh(moved).connectivity.triangles,
            from_openmesh(mesh).connectivity.triangles);
}

TEST(OpenMeshBridge, LeavesTheGivenMeshAsItIs) {
  const test::Shape shape = test::octahedron();
  const auto mesh = openmesh_of<OpenMesh::DefaultTraitsDouble>(shape);
  with_positions(mesh, Positions::Zero(6, 3));
  EXPECT_EQ(from_openmesh(mesh).positions, shape.positions);
}

TEST(OpenMeshBridge, RefusesDeletedVertices) {
  auto mesh = openmesh_of<RichTraits>(test::octahedron());
  mesh.delete_vertex(mesh.vertex_handle(2));
  EXPECT_THAT([&] { from_openmesh(mesh); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("vertex 2 is deleted; call garbage_collection() first")));
}

TEST(OpenMeshBridge, RefusesDeletedFaces) {
  auto mesh = openmesh_of<RichTraits>(test::octahedron());
  mesh.delete_face(mesh.face_handle(3), /*delete_isolated_vertices=*/false);
  EXPECT_THAT([&] { from_openmesh(mesh); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("face 3 is deleted; call garbage_collection() first")));
}

}  // namespace
}  // namespace mimetra
