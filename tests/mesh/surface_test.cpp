#include "toolkit/mesh/surface.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "tests/geodesic/surfaces.h"
#include "tests/shapes.h"

namespace mimetra {
namespace {

using test::triangles_of;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

Surface surface_of(const test::Shape& shape) {
  return {static_cast<int>(shape.positions.rows()), shape.triangles};
}

/// A soup in which every way to meet occurs: doubled faces, edges of many faces, faces that repeat
/// a vertex, sheets that touch, one-sided surfaces.
Triangles random_soup(int vertices, int faces, unsigned seed) {
  std::mt19937 generator(seed);
  return Triangles::NullaryExpr(faces, 3, [&] { return int(generator() % unsigned(vertices)); });
}

bool contains(const std::vector<int>& list, int number) {
  return std::ranges::binary_search(list, number);
}

/// The given vertices around a face of the half-edges, from its first corner on.
std::vector<VertexIndex> around(const Surface& surface, int face) {
  std::vector<VertexIndex> vertices;
  for (const auto h : surface.half_edges().fh_range(OpenMesh::FaceHandle(face))) {
    vertices.push_back(surface.vertex_of(h.from()));
  }
  return vertices;
}

std::pair<int, int> edge(int a, int b) {
  return std::minmax({a, b});
}

/// Faces at each edge, face after face.
std::map<std::pair<int, int>, std::vector<int>> faces_at_edges(const Triangles& triangles) {
  std::map<std::pair<int, int>, std::vector<int>> faces;
  for (int t = 0; t < triangles.rows(); ++t) {
    const auto c = triangles.row(t);
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    for (int i = 0; i < 3; ++i) faces[edge(c[i], c[(i + 1) % 3])].push_back(t);
  }
  return faces;
}

/// Checks the promises for any mesh at each face, edge and vertex.
void expect_sound(const Surface& surface, const Triangles& triangles) {
  const Surface::HalfEdges& mesh = surface.half_edges();
  ASSERT_EQ(mesh.n_faces(), std::size_t(triangles.rows()));
  ASSERT_EQ(mesh.n_vertices(), std::size_t(surface.vertices() + surface.copies()));
  for (int t = 0; t < triangles.rows(); ++t) {
    const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
    const bool repeats = a == b || b == c || c == a;
    ASSERT_EQ(contains(surface.left_out(), t), repeats);
    if (repeats) continue;
    const bool is_turned = contains(surface.turned(), t);
    EXPECT_THAT(around(surface, t), ElementsAre(a, is_turned ? c : b, is_turned ? b : c));
  }
  const auto faces_at = faces_at_edges(triangles);
  for (const auto e : mesh.edges()) {
    const int one = e.h0().face().idx(), other = e.h1().face().idx();
    const auto& faces = faces_at.at(edge(surface.vertex_of(e.v0()), surface.vertex_of(e.v1())));
    if (one >= 0 && other >= 0) {
      EXPECT_THAT(faces, testing::UnorderedElementsAre(one, other));
    } else {
      EXPECT_TRUE(contains(faces, std::max(one, other)));
    }
  }
  std::size_t in_fans = 0;
  for (const auto v : mesh.vertices()) {
    std::set<int> fan;
    for (const auto face : mesh.vf_range(v)) EXPECT_TRUE(fan.insert(face.idx()).second);
    in_fans += fan.size();
    EXPECT_THAT(surface.copies_of(surface.vertex_of(v)), testing::Contains(v));
    for (const auto h : mesh.voh_range(v)) EXPECT_EQ(h.prev().next(), h);
    // A border vertex is known by the half-edge along its border.
    if (!mesh.is_isolated(v) && mesh.is_boundary(v)) {
      EXPECT_TRUE(mesh.is_boundary(mesh.halfedge_handle(v)));
    }
  }
  // Each corner of each face is in the one fan of its vertex.
  EXPECT_EQ(in_fans, 3 * (std::size_t(triangles.rows()) - surface.left_out().size()));
}

TEST(Surface, OfAnySoupIsAManifoldOfItsFaces) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const int vertices = 4 + int(seed % 12), faces = 1 + int(seed % 30);
    const Triangles soup = random_soup(vertices, faces, seed);
    SCOPED_TRACE(seed);
    expect_sound({vertices, soup}, soup);
  }
}

TEST(Surface, OfAManifoldIsTheMeshItself) {
  const test::Shape shape = test::both(test::octahedron(), test::grid(4, 3));
  const Surface surface = surface_of(shape);
  expect_sound(surface, shape.triangles);
  EXPECT_EQ(surface.copies(), 0);
  EXPECT_THAT(surface.turned(), IsEmpty());
  EXPECT_EQ(std::ranges::count_if(surface.half_edges().edges(),
                                  [](const auto& e) { return e.is_boundary(); }),
            2 * 3 + 2 * 2);
}

TEST(Surface, TurnsFacesThatRunAgainstTheirNeighbors) {
  test::Shape shape = test::octahedron();
  for (const int t : {2, 3, 7}) std::swap(shape.triangles(t, 1), shape.triangles(t, 2));
  const Surface surface = surface_of(shape);
  expect_sound(surface, shape.triangles);
  EXPECT_THAT(surface.turned(), ElementsAre(2, 3, 7));
  for (const auto e : surface.half_edges().edges()) EXPECT_FALSE(e.is_boundary());
}

TEST(Surface, GivesEachPageOfABookItsSpine) {
  const test::Book book = test::book(3);
  const Surface surface = surface_of(book.shape);
  expect_sound(surface, book.shape.triangles);
  EXPECT_EQ(surface.copies(), 2 * 3);
  EXPECT_THAT(surface.copies_of(0), SizeIs(3));
  EXPECT_THAT(surface.copies_of(book.vertex(1, 0, 2)), SizeIs(1));
}

TEST(Surface, CopiesTheVertexOfABowTie) {
  const test::Shape shape = test::touching_squares(3);
  const Surface surface = surface_of(shape);
  expect_sound(surface, shape.triangles);
  EXPECT_THAT(surface.copies_of(8),
              ElementsAre(OpenMesh::VertexHandle(8), OpenMesh::VertexHandle(17)));
  EXPECT_EQ(surface.vertex_of(OpenMesh::VertexHandle(17)), 8);
  EXPECT_THAT(surface.neighbors(8), SizeIs(6));
}

TEST(Surface, JoinsTwoFacesOfTheSameCornersAlongAllEdges) {
  const Surface surface(3, triangles_of({{{0, 1, 2}}, {{0, 1, 2}}}));
  expect_sound(surface, triangles_of({{{0, 1, 2}}, {{0, 1, 2}}}));
  EXPECT_EQ(surface.copies(), 0);
  EXPECT_THAT(surface.turned(), ElementsAre(1));
  EXPECT_EQ(surface.half_edges().n_edges(), 3u);
}

TEST(Surface, OpensTheSeamOfAMoebiusStrip) {
  const int columns = 12, rows = 4;
  const test::Shape shape = test::moebius_strip(columns, rows);
  const Surface surface = surface_of(shape);
  expect_sound(surface, shape.triangles);
  EXPECT_GT(surface.copies(), 0);
  // The strip's one border, twice as long as the strip, and both sides of the seam.
  EXPECT_GT(std::ranges::count_if(surface.half_edges().edges(),
                                  [](const auto& e) { return e.is_boundary(); }),
            2 * columns);
}

TEST(Surface, ListsFacesThatRepeatAVertexAndKeepsNumbers) {
  const Triangles triangles = triangles_of({{{0, 0, 1}}, {{0, 1, 2}}, {{3, 1, 3}}, {{2, 1, 3}}});
  const Surface surface(5, triangles);
  expect_sound(surface, triangles);
  EXPECT_THAT(surface.left_out(), ElementsAre(0, 2));
  std::vector<int> faces;
  for (const auto face : surface.half_edges().faces()) faces.push_back(face.idx());
  EXPECT_THAT(faces, ElementsAre(1, 3));
  EXPECT_THAT(surface.neighbors(4), IsEmpty());
}

TEST(Surface, HoldsPolygons) {
  // A square beside a triangle, which is wound against it.
  const Surface surface(5, Polygons{{0, 1, 2, 3, 1, 2, 4}, {0, 4, 7}});
  EXPECT_THAT(around(surface, 0), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(around(surface, 1), ElementsAre(1, 4, 2));
  EXPECT_EQ(surface.half_edges().n_edges(), 6u);
}

TEST(Surface, ShowsAllSidesOfEachEdge) {
  const Triangles triangles = triangles_of({{{2, 1, 0}}, {{0, 1, 3}}, {{1, 0, 4}}});
  std::vector<std::vector<int>> edges;
  EdgeSides(5, triangles).for_each_edge([&](std::span<const int> sides) {
    edges.emplace_back(sides.begin(), sides.end());
  });
  // 01, 02, 03, 04, 12, 13, 14
  EXPECT_THAT(edges, ElementsAre(ElementsAre(1, 3, 6), ElementsAre(2), ElementsAre(5),
                                 ElementsAre(7), ElementsAre(0), ElementsAre(4), ElementsAre(8)));
}

TEST(Surface, ShowsSidesOfCollapsedFacesWhereTheyAreKept) {
  const Polygons polygons{{0, 0, 1, 2, 1, 0, 3}, {0, 4, 7}};
  std::vector<std::vector<int>> edges;
  const auto keep = [&edges](std::span<const int> sides) {
    edges.emplace_back(sides.begin(), sides.end());
  };
  EdgeSides(4, polygons).for_each_edge(keep);
  EXPECT_THAT(edges, ElementsAre(ElementsAre(4), ElementsAre(5), ElementsAre(6)));
  edges.clear();
  EdgeSides(4, polygons, Collapsed::kept).for_each_edge(keep);
  // 01, 02, 03, 12, 13
  EXPECT_THAT(edges, ElementsAre(ElementsAre(1, 4), ElementsAre(3), ElementsAre(5), ElementsAre(2),
                                 ElementsAre(6)));
}

TEST(Surface, CrossesSeamsThatAreWelded) {
  test::Shape right = test::grid(3, 4);
  right.positions.col(0).array() += 2;
  const test::Shape shape = test::both(test::grid(3, 4), right);
  const Weld weld = Weld::exact(shape.positions);
  const Surface surface(shape.triangles, weld);
  expect_sound(surface, weld.welded(shape.triangles));
  EXPECT_EQ(std::ranges::count_if(surface.half_edges().edges(),
                                  [](const auto& e) { return e.is_boundary(); }),
            2 * (4 + 3));
  EXPECT_THAT(surface.neighbors(12), IsEmpty());  // vertex 2 is its representative
  EXPECT_THAT(surface.neighbors(2), testing::Contains(13));
}

TEST(Surface, NamesAFaceWithABadVertex) {
  EXPECT_THAT(
      [] {
        Surface(3, triangles_of({{{0, 1, 2}}, {{0, 1, 3}}}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 1 uses vertex 3, expected 0 to 2")));
  EXPECT_THAT(
      [] {
        Surface(3, triangles_of({{{0, -1, 2}}}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 0 uses vertex -1")));
}

TEST(WithinReach, FindsWhatIsNearAndHowFar) {
  const test::Shape shape = test::grid(5, 5);
  const auto near = within_reach(surface_of(shape), shape.positions, 1, {12});
  EXPECT_THAT(near, ElementsAre(std::pair(7, 1.0), std::pair(11, 1.0), std::pair(12, 0.0),
                                std::pair(13, 1.0), std::pair(17, 1.0)));
}

TEST(WithinReach, CountsFromTheNearestOfSeveralOnTheirPart) {
  test::Shape shape = test::both(test::grid(9, 2), test::grid(3, 3));
  const auto near = within_reach(surface_of(shape), shape.positions, 100, {0, 8});
  EXPECT_THAT(near, SizeIs(18));
  for (int x = 0; x < 9; ++x) EXPECT_EQ(near.at(x), std::min(x, 8 - x));
}

TEST(LongestEdge, IsThatOfTheVertex) {
  const test::Shape shape = test::grid(3, 3);
  EXPECT_EQ(longest_edge(surface_of(shape), shape.positions, 4), std::sqrt(2.0));
  EXPECT_EQ(longest_edge({1, Triangles(0, 3)}, Positions::Zero(1, 3), 0), 0);
}

/// Parts by spreading labels over faces until nothing changes.
std::vector<int> spread_labels(int vertices, const Triangles& triangles) {
  std::vector<int> lowest(vertices);
  std::iota(lowest.begin(), lowest.end(), 0);
  for (bool changes = true; changes;) {
    changes = false;
    for (const auto& t : triangles.rowwise()) {
      const int low = std::min({lowest[t[0]], lowest[t[1]], lowest[t[2]]});
      for (const int v : t) changes |= std::exchange(lowest[v], low) != low;
    }
  }
  std::map<int, int> label;
  for (const int low : lowest) label.emplace(low, 0);
  int next = 0;
  for (auto& [low, number] : label) number = next++;
  for (int& low : lowest) low = label.at(low);
  return lowest;
}

TEST(ConnectedComponents, OfAnySoupAreThoseThatSpread) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const int vertices = 40;
    const Triangles soup = random_soup(vertices, 1 + int(seed % 25), seed);
    const auto components = connected_components(vertices, soup);
    const std::vector<int> expected = spread_labels(vertices, soup);
    EXPECT_THAT(components.of_vertex, ElementsAreArray(expected));
    EXPECT_EQ(components.count, *std::ranges::max_element(expected) + 1);
  }
}

TEST(ConnectedComponents, OfALongStripAreOne) {
  const test::Shape shape = test::grid(2000, 2);
  EXPECT_EQ(connected_components(int(shape.positions.rows()), shape.triangles).count, 1);
}

TEST(ConnectedComponents, HangTogetherAcrossSeamsThatAreWelded) {
  test::Shape shape = test::both(test::grid(2, 2), test::grid(2, 2));
  shape.positions.bottomRows(4).col(0).array() += 1;
  const int vertices = int(shape.positions.rows());
  EXPECT_EQ(connected_components(vertices, shape.triangles).count, 2);
  const auto welded = connected_components(shape.triangles, Weld::exact(shape.positions));
  EXPECT_EQ(welded.count, 1);
  EXPECT_THAT(welded.of_vertex, testing::Each(0));
}

TEST(ConnectedComponents, NameATriangleWithABadIndex) {
  EXPECT_THAT(
      [] {
        connected_components(3, triangles_of({{{0, 1, 2}}, {{0, 1, 3}}}));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("face 1 uses vertex 3, expected 0 to 2")));
}

}  // namespace
}  // namespace mimetra
