#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
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

TYPED_TEST(AnyOpenMesh, GivesItsPositionsAndTrianglesAndTakesPositions) {
  test::Shape shape = test::octahedron();
  shape.positions.conservativeResize(8, 3);
  shape.positions.bottomRows(2).setConstant(3);  // without faces
  const auto given = openmesh_of<TypeParam>(shape);
  const TriMesh mesh = from_openmesh(given);
  EXPECT_EQ(mesh.positions, shape.positions);
  // OpenMesh may start a face at another corner.
  EXPECT_TRUE(same_faces(mesh.connectivity, Connectivity::from_triangles(8, shape.triangles)));
  const Positions moved = 2 * shape.positions;
  EXPECT_EQ(from_openmesh(with_positions(given, moved)).positions, moved);
  EXPECT_EQ(from_openmesh(given).positions, shape.positions) << "the given one stays as it is";
}

TYPED_TEST(AnyOpenMesh, IsMadeOfAMeshAndGivesItBack) {
  test::Shape shape = test::octahedron();
  shape.positions.conservativeResize(8, 3);
  shape.positions.bottomRows(2).setConstant(3);  // without faces
  const TriMesh given = test::mesh_of(shape);
  const TriMesh back = from_openmesh(to_openmesh<Mesh<TypeParam>>(given));
  EXPECT_EQ(back.positions, given.positions);
  EXPECT_EQ(back.connectivity.polygons, given.connectivity.polygons);
}

TEST(OpenMeshBridge, MakesAMeshAsAddFaceDoes) {
  const test::Shape shape = test::grid(4, 3);
  const auto expected = openmesh_of<RichTraits>(shape);
  const auto made = to_openmesh<Mesh<RichTraits>>(test::mesh_of(shape));
  EXPECT_EQ(made.n_edges(), expected.n_edges());
  for (const auto vertex : made.vertices()) {
    EXPECT_EQ(made.valence(vertex), expected.valence(vertex));
    EXPECT_EQ(made.is_boundary(vertex), expected.is_boundary(vertex));
    EXPECT_EQ(made.is_boundary(vertex), made.is_boundary(made.halfedge_handle(vertex)));
  }
  for (const auto face : made.faces()) {
    EXPECT_EQ(face.halfedge().to().idx(), shape.triangles(face.idx(), 0));
    EXPECT_EQ(expected.to_vertex_handle(expected.halfedge_handle(face)), face.halfedge().to());
  }
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

TEST(OpenMeshBridge, RefusesPositionsOfAnotherVertexCount) {
  EXPECT_THAT(
      [] { with_positions(openmesh_of<RichTraits>(test::octahedron()), Positions::Zero(5, 3)); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("5 positions for a mesh of 6 vertices")));
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

using QuadMesh = OpenMesh::PolyMesh_ArrayKernelT<RichTraits>;

/// Two quads and a triangle over them: vertices 0 1 2 / 3 4 5 / 6.
QuadMesh house() {
  QuadMesh mesh;
  for (const auto& p : {QuadMesh::Point(0, 0, 0),
                        {1, 0, 0},
                        {2, 0, 0},
                        {0, 1, 0},
                        {1, 1, 0},
                        {2, 1, 0},
                        {0.5f, 2, 0}}) {
    mesh.add_vertex(p);
  }
  for (const auto& corners : std::vector<std::vector<int>>{{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 6}}) {
    std::vector<OpenMesh::VertexHandle> face;
    face.reserve(corners.size());
    for (const int corner : corners) face.emplace_back(corner);
    mesh.add_face(face);
  }
  for (const auto vertex : mesh.vertices())
    mesh.set_texcoord2D(vertex, {0.5f, float(vertex.idx())});
  return mesh;
}

TEST(OpenMeshBridge, GivesPolygonsAndTextureCoordinates) {
  const TriMesh mesh = from_openmesh(house());
  EXPECT_TRUE(same_faces(
      mesh.connectivity,
      Connectivity::from_polygons(7, {{0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6}, {0, 4, 8, 11}})));
  EXPECT_EQ(mesh.connectivity.triangles.rows(), 5);
  const TextureCoordinates& texture = mesh.connectivity.texture;
  const std::vector<int>& corners = mesh.connectivity.polygons.corners;
  ASSERT_EQ(texture.corners.size(), corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(texture.coordinates[static_cast<std::size_t>(texture.corners[i])],
              Eigen::Vector2d(0.5, corners[i]));
  }
}

TEST(OpenMeshBridge, TakesTextureCoordinatesOfHalfedgesFirst) {
  QuadMesh mesh = house();
  mesh.request_halfedge_texcoords2D();
  for (const auto halfedge : mesh.halfedges()) {
    mesh.set_texcoord2D(halfedge, {float(halfedge.idx()), float(halfedge.to().idx())});
  }
  const Connectivity found = from_openmesh(mesh).connectivity;
  for (std::size_t i = 0; i < found.polygons.corners.size(); ++i) {
    const auto uv = found.texture.coordinates[static_cast<std::size_t>(found.texture.corners[i])];
    EXPECT_EQ(uv[1], found.polygons.corners[i]);
    EXPECT_EQ(mesh.to_vertex_handle(OpenMesh::HalfedgeHandle(int(uv[0]))).idx(), uv[1]);
  }
}

/// Texture coordinates at all corners of polygons.
std::vector<Eigen::Vector2d> at_corners(const TextureCoordinates& texture) {
  std::vector<Eigen::Vector2d> all;
  for (const int corner : texture.corners) {
    all.push_back(texture.coordinates[static_cast<std::size_t>(corner)]);
  }
  return all;
}

TEST(OpenMeshBridge, MakesPolygonsAndTextureCoordinatesOfVertices) {
  const TriMesh given = from_openmesh(house());
  const auto made = to_openmesh<OpenMesh::PolyMesh_ArrayKernelT<>>(given);
  EXPECT_TRUE(made.has_vertex_texcoords2D());
  EXPECT_FALSE(made.has_halfedge_texcoords2D());
  const TriMesh back = from_openmesh(made);
  EXPECT_EQ(back.positions, given.positions);
  EXPECT_EQ(back.connectivity.polygons, given.connectivity.polygons);
  EXPECT_EQ(at_corners(back.connectivity.texture), at_corners(given.connectivity.texture));
}

/// House whose corner c has the texture coordinates (c, vertex), but corner 2 none.
TriMesh house_with_a_seam() {
  TriMesh mesh = from_openmesh(house());
  TextureCoordinates& texture = mesh.connectivity.texture;
  texture = {};
  for (const int vertex : mesh.connectivity.polygons.corners) {
    const auto corner = static_cast<int>(texture.corners.size());
    texture.coordinates.emplace_back(corner, vertex);
    texture.corners.push_back(corner == 2 ? -1 : corner);
  }
  return mesh;
}

TEST(OpenMeshBridge, PutsTextureCoordinatesOfCornersOnHalfedges) {
  const TriMesh given = house_with_a_seam();
  const auto made = to_openmesh<QuadMesh>(given);
  std::vector<Eigen::Vector2d> expected = given.connectivity.texture.coordinates;
  expected[2] = {0, 0};
  EXPECT_EQ(at_corners(from_openmesh(made).connectivity.texture), expected);
  for (const auto halfedge : made.halfedges()) {
    if (!halfedge.is_boundary()) continue;
    EXPECT_EQ(made.texcoord2D(halfedge), QuadMesh::TexCoord2D(0, 0));
  }
  // The class has places on vertices.
  for (const auto vertex : made.vertices()) {
    EXPECT_EQ(made.texcoord2D(vertex), QuadMesh::TexCoord2D(0, 0));
  }
}

TEST(OpenMeshBridge, MakesTrianglesWhereTheClassHoldsNothingElse) {
  const TriMesh given = house_with_a_seam();
  const auto made = to_openmesh<Mesh<OpenMesh::DefaultTraits>>(given);
  const Connectivity found = from_openmesh(made).connectivity;
  EXPECT_EQ(found.triangles, given.connectivity.triangles);
  EXPECT_EQ(found.polygons.size(), 5);
  const std::vector<int> corners = {0, 1, -1, 0, -1, 3, 4, 5, 6, 4, 6, 7, 8, 9, 10};
  const std::vector<Eigen::Vector2d> uvs = at_corners(found.texture);
  ASSERT_EQ(uvs.size(), corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d expected = corners[i] < 0
                                         ? Eigen::Vector2d(0, 0)
                                         : Eigen::Vector2d(corners[i], found.polygons.corners[i]);
    EXPECT_EQ(uvs[i], expected) << i;
  }
}

TEST(OpenMeshBridge, MakesNoMeshThatHalfedgesCannotHold) {
  const auto refusal = [](int vertices, const Polygons& polygons) {
    const TriMesh mesh{Positions::Zero(vertices, 3),
                       Connectivity::from_polygons(vertices, polygons)};
    return test::message_of<MismatchError>([&] { to_openmesh<QuadMesh>(mesh); });
  };
  const std::string cannot = ", which OpenMesh's halfedges cannot hold; ";
  EXPECT_EQ(refusal(3, {{0, 1, 2, 0, 1, 1}, {0, 3, 6}}),
            "face 1 has a vertex twice" + cannot + "remove the face");
  EXPECT_EQ(refusal(4, {{0, 1, 2, 0, 1, 3}, {0, 3, 6}}),
            "face 1 is wound against its neighbors" + cannot + "wind all faces the same way");
  EXPECT_EQ(refusal(5, {{0, 1, 2, 1, 0, 3, 0, 1, 4}, {0, 3, 6, 9}}),
            "3 sheets of faces meet at vertex 0" + cannot + "give each sheet a vertex of its own");
  EXPECT_EQ(refusal(5, {{1, 2, 0, 0, 3, 4}, {0, 3, 6}}),
            "2 sheets of faces meet at vertex 0" + cannot + "give each sheet a vertex of its own");
}

TEST(OpenMeshBridge, MakesNoMeshOfPositionsOfAnotherVertexCount) {
  const TriMesh mesh{Positions::Zero(5, 3), test::mesh_of(test::octahedron()).connectivity};
  EXPECT_THAT([&] { to_openmesh<QuadMesh>(mesh); },
              ThrowsMessage<std::invalid_argument>("5 positions for a mesh of 6 vertices"));
}

TEST(OpenMeshBridge, MakesASequenceOfMeshes) {
  QuadMesh moved = house();
  moved.set_point(OpenMesh::VertexHandle(6), {3, 4, 5});
  const MeshSequence sequence =
      sequence_from_openmesh(std::vector<QuadMesh>{house(), moved}, Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(sequence.frames(), 2);
  EXPECT_FALSE(sequence.rest_is_known());
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(Positions(sequence.frame(0)), from_openmesh(house()).positions);
  EXPECT_EQ(Positions(sequence.frame(1)), from_openmesh(moved).positions);
}

TEST(OpenMeshBridge, NamesTheMeshWithOtherFaces) {
  QuadMesh other = house();
  other.delete_face(OpenMesh::FaceHandle(2), false);
  other.garbage_collection();
  EXPECT_THAT(
      [&] {
        sequence_from_openmesh(std::vector<QuadMesh>{house(), house(), other});
      },
      ThrowsMessage<std::invalid_argument>("mesh 2 has other faces than mesh 0"));
  EXPECT_THROW(sequence_from_openmesh(std::vector<QuadMesh>{}), std::invalid_argument);
}

TEST(OpenMeshBridge, MakesASequenceOfPointProperties) {
  QuadMesh mesh = house();
  auto open = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, QuadMesh::Point>(mesh, "open");
  auto wide = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, OpenMesh::Vec3d>(mesh, "wide");
  for (const auto vertex : mesh.vertices()) {
    open[vertex] = mesh.point(vertex) * 2.0f;
    wide[vertex] = OpenMesh::Vec3d(vertex.idx(), 0.1, 0);
  }
  const MeshSequence sequence = sequence_from_openmesh(mesh, {"open", "wide"});
  const Positions rest = from_openmesh(mesh).positions;
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(sequence.rest(), rest);
  EXPECT_EQ(Positions(sequence.frame(0)), 2 * rest);
  EXPECT_EQ(sequence.frame(1)(5, 0), 5);
  EXPECT_EQ(sequence.frame(1)(5, 1), 0.1);
  EXPECT_THAT(
      [&] {
        sequence_from_openmesh(mesh, {"open", "shut"});
      },
      ThrowsMessage<std::invalid_argument>("the mesh has no points of vertices 'shut'"));
}

struct IntegerPoints : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3i;
};

TEST(OpenMeshBridge, TakesPosesOfWhateverTypeTheMeshHasPointsOf) {
  OpenMesh::TriMesh_ArrayKernelT<IntegerPoints> mesh;
  mesh.add_face(mesh.add_vertex({0, 0, 0}), mesh.add_vertex({1, 0, 0}), mesh.add_vertex({0, 1, 0}));
  auto open = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, OpenMesh::Vec3i>(mesh, "open");
  for (const auto vertex : mesh.vertices()) open[vertex] = {vertex.idx(), 20, -3};
  const MeshSequence sequence = sequence_from_openmesh(mesh, {"open"});
  Positions expected(3, 3);
  expected << 0, 20, -3, 1, 20, -3, 2, 20, -3;
  EXPECT_EQ(Positions(sequence.frame(0)), expected);
}

TEST(OpenMeshBridge, PutsFieldsIntoPropertiesAndTakesThemBack) {
  QuadMesh mesh = house();
  Eigen::MatrixXd region(7, 1), way(7, 3), in_l(5, 1);
  region << 0, 0, 1, -1, -1, 1, 2;
  way.setRandom();
  in_l << 0, 1, 0, 0, 1;
  set_fields(mesh, {{"region", Field::Location::vertices, region, true},
                    {"component_0", Field::Location::vertices, way},
                    {"in_L", Field::Location::triangles, in_l, true}});
  const auto of_vertices = OpenMesh::getProperty<OpenMesh::VertexHandle, int>(mesh, "v:region");
  const auto of_faces = OpenMesh::getProperty<OpenMesh::FaceHandle, int>(mesh, "f:in_L");
  EXPECT_EQ(of_vertices[OpenMesh::VertexHandle(6)], 2);
  EXPECT_EQ(of_faces[OpenMesh::FaceHandle(0)], 1);
  EXPECT_EQ(of_faces[OpenMesh::FaceHandle(1)], 0);
  const Field back = field_from_openmesh(mesh, "v:region");
  EXPECT_EQ(back.name, "region");
  EXPECT_TRUE(back.integer);
  EXPECT_EQ(back.values, region);
  EXPECT_EQ(field_from_openmesh(mesh, "v:component_0").values, way);
  const Field faces = field_from_openmesh(mesh, "f:in_L");
  EXPECT_EQ(faces.location, Field::Location::triangles);
  EXPECT_EQ(faces.values, (Eigen::VectorXd(5) << 1, 1, 0, 0, 1).finished());
}

TEST(OpenMeshBridge, KeepsWholeNumbersThatAnIntDoesNotHold) {
  QuadMesh mesh = house();
  const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(7, 5e9, 5e9 + 6);
  set_fields(mesh, {{"id", Field::Location::vertices, numbers, true}});
  EXPECT_EQ(field_from_openmesh(mesh, "v:id").values, numbers);
}

TEST(OpenMeshBridge, TakesMasksAndWeightsOfAnyType) {
  QuadMesh mesh = house();
  auto mask = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, bool>(mesh, "v:roi");
  auto weight = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "v:weight");
  for (const auto vertex : mesh.vertices()) {
    mask[vertex] = vertex.idx() == 2;
    weight[vertex] = 0.25f * static_cast<float>(vertex.idx() % 5);
  }
  EXPECT_EQ(field_from_openmesh(mesh, "v:roi").values, Eigen::VectorXd::Unit(7, 2));
  EXPECT_EQ(field_from_openmesh(mesh, "v:weight").values(3, 0), 0.75);
}

TEST(OpenMeshBridge, DoesNotChooseAmongPropertiesOfOneName) {
  QuadMesh mesh = house();
  OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "v:x");
  OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, double>(mesh, "v:x");
  EXPECT_THAT([&] { field_from_openmesh(mesh, "v:x"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'v:x' of several types")));
  OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, OpenMesh::Vec3f>(mesh, "pose");
  EXPECT_EQ(sequence_from_openmesh(mesh, {"pose"}).frames(), 1);
  OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, OpenMesh::Vec3d>(mesh, "pose");
  EXPECT_THAT([&] { sequence_from_openmesh(mesh, {"pose"}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'pose' of several types")));
}

TEST(OpenMeshBridge, PutsAFieldInPlaceOfAnyPropertyOfItsName) {
  QuadMesh mesh = house();
  const auto held = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, double>(mesh, "v:x");
  OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, float>(mesh, "v:x");
  OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, float>(mesh, "v:y");
  set_fields(mesh, {{"x", Field::Location::vertices, Eigen::VectorXd::Constant(7, 7), false}});
  EXPECT_EQ(field_from_openmesh(mesh, "v:x").values, Eigen::VectorXd::Constant(7, 7));
  EXPECT_EQ(held[OpenMesh::VertexHandle(6)], 7);
  // On faces, which is another one.
  EXPECT_TRUE((OpenMesh::hasProperty<OpenMesh::FaceHandle, float>(mesh, "v:y")));
}

TEST(OpenMeshBridge, TakesPropertiesOfAnyName) {
  QuadMesh mesh = house();
  auto region = OpenMesh::getOrMakeProperty<OpenMesh::VertexHandle, int>(mesh, "region");
  auto in_l = OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, int>(mesh, "in_L");
  for (const auto vertex : mesh.vertices()) region[vertex] = vertex.idx();
  for (const auto face : mesh.faces()) in_l[face] = 1;
  const Field of_vertices = field_from_openmesh(mesh, "region");
  EXPECT_EQ(of_vertices.name, "region");
  EXPECT_EQ(of_vertices.values, Eigen::VectorXd::LinSpaced(7, 0, 6));
  EXPECT_EQ(field_from_openmesh(mesh, "in_L").location, Field::Location::triangles);
  OpenMesh::getOrMakeProperty<OpenMesh::FaceHandle, double>(mesh, "region");
  EXPECT_THAT([&] { field_from_openmesh(mesh, "region"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("on vertices and faces")));
}

TEST(OpenMeshBridge, LeavesTheMeshAsItWasWhereAFieldCannotBeHeld) {
  QuadMesh mesh = house();
  const Field good{"good", Field::Location::vertices, Eigen::VectorXd::Zero(7)};
  const Field wide{"wide", Field::Location::vertices, Eigen::MatrixXd::Zero(7, 2)};
  EXPECT_THROW(set_fields(mesh, {good, wide}), std::invalid_argument);
  const Field points{"points", Field::Location::vertices, Eigen::MatrixXd::Zero(7, 3)};
  const auto before = from_openmesh(mesh).positions;
  EXPECT_THAT(
      [&] {
        set_fields(mesh, {good, points});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("an attribute that OpenMesh keeps")));
  EXPECT_EQ(from_openmesh(mesh).positions, before);
  EXPECT_FALSE((OpenMesh::hasProperty<OpenMesh::VertexHandle, double>(mesh, "v:good")));
}

TEST(OpenMeshBridge, NamesWhatItCannotHoldOrFind) {
  QuadMesh mesh = house();
  EXPECT_THAT([&] { field_from_openmesh(mesh, "v:roi"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the mesh has no property 'v:roi'")));
  EXPECT_THAT([&] { field_from_openmesh(mesh, "roi"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("the mesh has no property 'roi'")));
  const Field wide{"wide", Field::Location::vertices, Eigen::MatrixXd::Zero(7, 2)};
  EXPECT_THAT([&] { set_fields(mesh, {wide}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("field 'wide' has 2 columns")));
  const Field short_one{"short", Field::Location::triangles, Eigen::MatrixXd::Zero(3, 1)};
  EXPECT_THAT([&] { set_fields(mesh, {short_one}); },
              ThrowsMessage<std::invalid_argument>(
                  "field 'short' has 3 values, expected 5, one a triangle"));
}

}  // namespace
}  // namespace mimetra
