#include "toolkit/correspondence/renumbering.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A grid that no turn carries to itself: a triangle on its border is missing.
test::Shape notched_grid() {
  test::Shape shape = test::grid(6, 5);
  const Triangles rest = shape.triangles.bottomRows(shape.triangles.rows() - 3);
  Triangles triangles(rest.rows() + 2, 3);
  triangles << shape.triangles.topRows(2), rest;
  shape.triangles = triangles;
  return shape;
}

std::vector<int> shuffled(int count, std::mt19937& generator) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), generator);
  return order;
}

struct Shuffle {
  bool vertices = true;
  bool corners = false;
  bool faces = false;
};

/// A mesh numbered anew, and where its vertices went.
struct Shuffled {
  Shuffled(const TriMesh& mesh, const Shuffle& what) {
    std::mt19937 generator(7);
    const int count = mesh.connectivity.vertices;
    vertices.resize(count);
    std::iota(vertices.begin(), vertices.end(), 0);
    if (what.vertices) vertices = shuffled(count, generator);
    const Polygons& old = mesh.connectivity.polygons;
    std::vector<int> order(old.size());
    std::iota(order.begin(), order.end(), 0);
    if (what.faces) order = shuffled(old.size(), generator);
    Polygons polygons;
    for (const int face : order) {
      std::vector<VertexIndex> corners(old.corners.begin() + old.offsets[face],
                                       old.corners.begin() + old.offsets[face + 1]);
      if (what.corners) {
        std::rotate(corners.begin(), corners.begin() + face % corners.size(), corners.end());
      }
      for (const VertexIndex v : corners) polygons.corners.push_back(vertices[v]);
      polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
    }
    moved.positions.resize(count, 3);
    for (int v = 0; v < count; ++v) moved.positions.row(vertices[v]) = mesh.positions.row(v);
    moved.connectivity = Connectivity::from_polygons(count, polygons);
  }

  TriMesh moved;
  std::vector<VertexIndex> vertices;
};

TriMesh quads(int columns, int rows) {
  Polygons polygons;
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      const int a = y * columns + x;
      for (const int v : {a, a + 1, a + columns + 1, a + columns}) polygons.corners.push_back(v);
      polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
    }
  }
  return {test::grid(columns, rows).positions,
          Connectivity::from_polygons(columns * rows, polygons)};
}

TEST(Renumbering, OfAMeshToItselfMovesNothing) {
  const TriMesh mesh = test::mesh_of(test::sphere(1));
  const Renumbering found = renumbering(mesh.connectivity, mesh.connectivity);
  EXPECT_TRUE(found.found());
  EXPECT_EQ(found.moved(), 0);
  EXPECT_EQ(found.summary(), "the same faces");
}

TEST(Renumbering, FollowsFacesInOrderFromAnyFirstCorners) {
  // A sphere has many maps to itself: only the order of its faces tells which one it is.
  const TriMesh mesh = test::mesh_of(test::sphere(2));
  for (const bool corners : {false, true}) {
    const Shuffled other(mesh, {.corners = corners});
    const Renumbering found = renumbering(mesh.connectivity, other.moved.connectivity);
    EXPECT_EQ(found.vertices, other.vertices);
    EXPECT_THAT(found.summary(), HasSubstr("the same faces, "));
    EXPECT_THAT(found.summary(), HasSubstr("vertices renumbered"));
  }
}

TEST(Renumbering, FindsEachPartByTheGraphWhereFacesAreShuffled) {
  test::Shape other_part = test::grid(4, 6);
  other_part.triangles = Triangles(other_part.triangles.bottomRows(29));
  for (const test::Shape& shape : {notched_grid(), test::both(notched_grid(), other_part)}) {
    const TriMesh mesh = test::mesh_of(shape);
    const Shuffled other(mesh, {.corners = true, .faces = true});
    EXPECT_EQ(renumbering(mesh.connectivity, other.moved.connectivity).vertices, other.vertices);
  }
}

TEST(Renumbering, IsRefusedWhereTwoPartsAreAlike) {
  const TriMesh mesh = test::mesh_of(test::both(notched_grid(), notched_grid()));
  const Shuffled other(mesh, {.faces = true});
  EXPECT_THAT(renumbering(mesh.connectivity, other.moved.connectivity).why_not,
              HasSubstr("symmetric"));
}

TEST(Renumbering, IsRefusedWhereMoreThanOneMapFits) {
  // Half a turn carries a grid to itself.
  const TriMesh mesh = test::mesh_of(test::grid(4, 3));
  const Shuffled other(mesh, {.faces = true});
  const Renumbering found = renumbering(mesh.connectivity, other.moved.connectivity);
  EXPECT_FALSE(found.found());
  EXPECT_THAT(found.summary(), HasSubstr("more than one map of the part around face"));
}

TEST(Renumbering, LetsPositionsDecideBetweenSymmetricMaps) {
  test::Shape left_eye = test::sphere(1), right_eye = test::sphere(1);
  left_eye.positions.col(0).array() += 3;
  right_eye.positions.col(0).array() -= 3;
  const TriMesh mesh = test::mesh_of(test::both(notched_grid(), test::both(left_eye, right_eye)));
  Shuffled other(mesh, {.corners = true, .faces = true});
  EXPECT_EQ(renumbering(mesh, other.moved).vertices, other.vertices);
  // Also where the other one stands elsewhere in another unit: the grid tells how.
  other.moved.positions = (1000 * other.moved.positions.array() + 70).matrix();
  EXPECT_EQ(renumbering(mesh, other.moved).vertices, other.vertices);
}

TEST(Renumbering, LetsPositionsDecideWherePartsAreInAnotherOrder) {
  test::Shape left_eye = test::sphere(1), right_eye = test::sphere(1);
  left_eye.positions.col(0).array() += 3;
  right_eye.positions.col(0).array() -= 3;
  const TriMesh mesh = test::mesh_of(test::both(notched_grid(), test::both(left_eye, right_eye)));
  TriMesh other = test::mesh_of(test::both(notched_grid(), test::both(right_eye, left_eye)));
  std::vector<VertexIndex> expected(66);
  std::iota(expected.begin(), expected.end(), 0);
  std::rotate(expected.begin() + 30, expected.begin() + 48, expected.end());
  EXPECT_EQ(renumbering(mesh, other).vertices, expected);
  // The eye that has turned within its place is the one whose faces are in order.
  other = mesh;
  const int turned[] = {2, 3, 1, 0};
  for (int corner = 0; corner < 4; ++corner) {
    other.positions.row(30 + corner) = mesh.positions.row(30 + turned[corner]);
  }
  EXPECT_EQ(renumbering(mesh, other).moved(), 0);
}

TEST(Renumbering, IsRefusedWherePositionsDoNotDecide) {
  const TriMesh mesh = test::mesh_of(test::grid(4, 3));
  Shuffled other(mesh, {.faces = true});
  other.moved.positions.setZero();
  EXPECT_THAT(renumbering(mesh, other.moved).why_not, HasSubstr("positions do not tell"));
}

TEST(Renumbering, IsNoMirrorImage) {
  const TriMesh mesh = test::mesh_of(notched_grid());
  Triangles flipped = mesh.connectivity.triangles;
  flipped.col(1).swap(flipped.col(2));
  const Connectivity mirrored = Connectivity::from_triangles(30, flipped);
  EXPECT_THAT(renumbering(mesh.connectivity, mirrored).why_not, HasSubstr("the other way round"));
}

TEST(Renumbering, NamesCountsThatDiffer) {
  const Renumbering found = renumbering(test::mesh_of(test::grid(3, 3)).connectivity,
                                        test::mesh_of(test::grid(3, 4)).connectivity);
  EXPECT_EQ(found.summary(),
            "another mesh: 12 vertices and 12 faces, expected 9 vertices and 8 faces");
}

TEST(Renumbering, TellsAnotherMeshOfTheSameCounts) {
  const TriMesh mesh = test::mesh_of(notched_grid());
  Triangles other = mesh.connectivity.triangles;
  // The diagonal of the last square the other way.
  other.bottomRows(2) << 22, 23, 28, 23, 29, 28;
  EXPECT_THAT(renumbering(mesh.connectivity, Connectivity::from_triangles(30, other)).why_not,
              HasSubstr("joined and bounded"));
}

TEST(Renumbering, TellsQuadsFromTheirTriangles) {
  const TriMesh mesh = quads(5, 4);
  TriMesh split = {mesh.positions, Connectivity::from_triangles(20, mesh.connectivity.triangles)};
  // Some quads are split along the other diagonal.
  Triangles triangles = split.connectivity.triangles;
  triangles.topRows(2) << 1, 6, 5, 1, 5, 0;
  split.connectivity = Connectivity::from_triangles(20, triangles);
  const Shuffled other(split, {});
  for (const bool coarse_first : {true, false}) {
    const Renumbering found = coarse_first
                                  ? renumbering(mesh.connectivity, other.moved.connectivity)
                                  : renumbering(other.moved.connectivity, mesh.connectivity);
    EXPECT_TRUE(found.splits);
    EXPECT_THAT(found.summary(), HasSubstr("but for polygons that one of them splits"));
    std::vector<VertexIndex> expected = other.vertices;
    if (!coarse_first) {
      for (int v = 0; v < 20; ++v) expected[other.vertices[v]] = v;
    }
    EXPECT_EQ(found.vertices, expected);
  }
}

/// A grid whose last column is the first vertices of another: along it, each vertex is twice.
TriMesh with_seam() {
  test::Shape left = notched_grid(), right = test::grid(3, 5);
  right.positions.col(0).array() += 5;
  return test::mesh_of(test::both(left, right));
}

TEST(Renumbering, TellsSeamsFromWeldedVertices) {
  const TriMesh seamed = with_seam();
  Positions positions(40, 3);
  Triangles triangles = seamed.connectivity.triangles;
  std::vector<VertexIndex> number(45);
  int next = 0;
  for (int v = 0; v < 45; ++v) {
    const bool twice = v >= 30 && (v - 30) % 3 == 0;
    number[v] = twice ? (v - 30) / 3 * 6 + 5 : next++;
    if (!twice) positions.row(number[v]) = seamed.positions.row(v);
  }
  for (int& vertex : triangles.reshaped()) vertex = number[vertex];
  const TriMesh welded = {positions, Connectivity::from_triangles(40, triangles)};
  const Renumbering found = renumbering(seamed, welded);
  EXPECT_TRUE(found.seams);
  EXPECT_EQ(found.vertices, number);
  EXPECT_THAT(found.summary(), HasSubstr("seams along which one of them has its vertices twice"));
  const Renumbering back = renumbering(welded, seamed);
  ASSERT_TRUE(back.seams);
  for (int v = 0; v < 40; ++v) {
    EXPECT_EQ(positions.row(v), seamed.positions.row(back.vertices[v]));
  }
  EXPECT_FALSE(renumbering(seamed.connectivity, welded.connectivity).found())
      << "nothing but places tells seams";
}

TEST(Renumbering, PairsVerticesWithoutAFaceInOrder) {
  Triangles one(1, 3), other(1, 3);
  one << 0, 2, 4;
  other << 1, 2, 3;
  EXPECT_THAT(
      renumbering(Connectivity::from_triangles(5, one), Connectivity::from_triangles(5, other))
          .vertices,
      ElementsAre(1, 0, 2, 4, 3));
}

TEST(Renumbering, PairsPartsOfOneShapeByPlace) {
  // Two eyes above a face: in the order of their faces each would be paired with the other one.
  test::Shape left = test::octahedron(), right = left;
  left.positions.rowwise() += Eigen::RowVector3d(-1, 2, 3);
  right.positions.rowwise() += Eigen::RowVector3d(5, 2, 3);
  const TriMesh mesh = test::mesh_of(test::both(test::both(left, right), notched_grid()));
  const TriMesh other = test::mesh_of(test::both(test::both(right, left), notched_grid()));
  const std::vector<VertexIndex> vertices = renumbering(mesh, other).vertices;
  ASSERT_EQ(vertices.size(), 42U);
  for (int v = 0; v < 6; ++v) {
    EXPECT_EQ(vertices[std::size_t(v)], v + 6);
    EXPECT_EQ(vertices[std::size_t(v) + 6], v);
  }
}

TEST(Renumbering, PairsVerticesWithoutAFaceByPlace) {
  const TriMesh grid = test::mesh_of(notched_grid());
  TriMesh mesh = grid;
  mesh.positions.conservativeResize(34, 3);
  for (int v = 30; v < 34; ++v) mesh.positions.row(v) << v, 0.5 * v, 7;
  mesh.connectivity = Connectivity::from_triangles(34, grid.connectivity.triangles);
  for (const bool faces : {false, true}) {
    Shuffled other(mesh, {.faces = faces});
    other.moved.positions = (10 * other.moved.positions.array() + 3).matrix();
    EXPECT_EQ(renumbering(mesh, other.moved).vertices, other.vertices);
  }
}

TEST(Renumbering, TellsFacesThatLeadTheOtherWayRound) {
  // Curved squares around a gap: a mirror image has the same faces, with left and right exchanged.
  TriMesh mesh = quads(4, 4);
  mesh.positions.col(2) =
      (mesh.positions.col(0).array() - 1.5).square() + mesh.positions.col(1).array().square();
  Polygons polygons, turned;
  for (int face = 0; face < 9; ++face) {
    if (face == 7) continue;
    const auto first = mesh.connectivity.polygons.corners.begin() + 4 * face;
    polygons.corners.insert(polygons.corners.end(), first, first + 4);
    turned.corners.insert(turned.corners.end(), first, first + 4);
    std::reverse(turned.corners.end() - 4, turned.corners.end());
    polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  turned.offsets = polygons.offsets;
  mesh.connectivity = Connectivity::from_polygons(16, polygons);
  TriMesh other = {mesh.positions, Connectivity::from_polygons(16, turned)};
  EXPECT_THAT(renumbering(mesh, other).why_not, HasSubstr("the other way round"));
  other.positions.col(0) *= -1;
  EXPECT_TRUE(renumbering(mesh, other).found()) << "a mirror image";
}

TEST(Renumbering, NeedsAPositionForEachVertex) {
  TriMesh mesh = test::mesh_of(test::grid(3, 3));
  TriMesh wrong = mesh;
  wrong.positions.conservativeResize(8, 3);
  EXPECT_THROW(renumbering(mesh, wrong), std::invalid_argument);
  wrong = mesh;
  wrong.positions(2, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(renumbering(wrong, mesh), std::invalid_argument);
}

/// Two frames of four vertices; vertex v is at x = v, in the second frame at x = 10 + v.
std::shared_ptr<const FrameSource> two_frames() {
  const test::Shape shape = test::grid(4, 1);
  Frames frames(2, 12);
  frames.row(0) = shape.positions.reshaped<Eigen::RowMajor>().transpose();
  frames.row(1) = frames.row(0).array() + 10;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  return std::make_shared<const MeshSequence>(Connectivity::from_triangles(4, triangles), frames);
}

TEST(RenumberedFrames, HaveTheVerticesOfTheReference) {
  Triangles triangles(2, 3);
  triangles << 3, 2, 1, 3, 1, 0;
  const auto reference =
      std::make_shared<const Connectivity>(Connectivity::from_triangles(4, triangles));
  const Renumbering found = renumbering(*reference, two_frames()->connectivity());
  ASSERT_EQ(found.vertices, (std::vector<VertexIndex>{3, 2, 1, 0}));
  const auto frames = renumbered(two_frames(), reference, found.vertices);
  EXPECT_EQ(frames->triangles(), triangles);
  EXPECT_EQ(frames->frames(), 2);
  for (int v = 0; v < 4; ++v) {
    EXPECT_EQ(frames->rest()(v, 0), 3 - v);
    EXPECT_EQ(frames->read(1, 1)(0, 3 * v), 13 - v);
  }
}

TEST(RenumberedFrames, MayHaveAVertexTwice) {
  const auto seamed = std::make_shared<const Connectivity>(
      Connectivity::from_triangles(5, two_frames()->triangles()));
  EXPECT_EQ(renumbered(two_frames(), seamed, {0, 1, 2, 3, 1})->read(0, 1)(0, 12), 1);
}

TEST(RenumberedFrames, CarryFieldsOfVertices) {
  const Field field{"roi", Field::Location::vertices, Eigen::Vector3d(5, 6, 7)};
  EXPECT_EQ(renumbered(field, {2, 0, 0}).values, Eigen::Vector3d(7, 5, 5));
}

TEST(RenumberedFrames, NeedAVertexForEach) {
  const auto connectivity = two_frames()->shared_connectivity();
  EXPECT_THROW(renumbered(two_frames(), connectivity, {0, 1, 2}), std::invalid_argument);
  EXPECT_THROW(renumbered(two_frames(), connectivity, {0, 1, 2, 4}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
