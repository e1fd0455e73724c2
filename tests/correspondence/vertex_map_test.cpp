#include "toolkit/correspondence/vertex_map.h"

#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

/// Colours by their definition: each round, half-edges are one where they, their next ones and
/// those across were; until a round tells no more apart.
std::vector<int> literal_colours(const FaceGraph& a, const FaceGraph& b) {
  std::vector<int> colours;
  for (const FaceGraph* graph : {&a, &b}) {
    for (const EdgeKind kind : graph->kind) colours.push_back(static_cast<int>(kind));
  }
  for (std::size_t known = 0;;) {
    std::map<std::tuple<int, int, int>, int> numbers;
    std::vector<int> next;
    for (const FaceGraph* graph : {&a, &b}) {
      const int first = graph == &a ? 0 : a.size();
      for (int h = 0; h < graph->size(); ++h) {
        const int across = graph->opposite[h] < 0 ? -1 : colours[first + graph->opposite[h]];
        const std::tuple key(colours[first + h], colours[first + graph->next[h]], across);
        next.push_back(numbers.try_emplace(key, static_cast<int>(numbers.size())).first->second);
      }
    }
    if (numbers.size() == known) return colours;
    known = numbers.size();
    colours = next;
  }
}

/// Whether two numberings have the same classes.
void expect_same_classes(const std::vector<int>& some, const std::vector<int>& others) {
  std::map<int, int> there, back;
  ASSERT_EQ(some.size(), others.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(there.try_emplace(some[i], others[i]).first->second, others[i]);
    EXPECT_EQ(back.try_emplace(others[i], some[i]).first->second, some[i]);
  }
}

FaceGraph graph_of(const test::Shape& shape) {
  const TriMesh mesh = test::mesh_of(shape);
  return FaceGraph(mesh.connectivity.vertices, mesh.connectivity.polygons);
}

/// Triangles around a pole that are written as quads, as on a sphere of Blender's.
TEST(FaceGraph, JoinsFacesThatRepeatAVertexToTheirNeighbors) {
  constexpr int kFaces = 5;
  Polygons polygons{{}, {0}};
  for (int f = 0; f < kFaces; ++f) {
    for (const VertexIndex v : {0, 0, 1 + f, 1 + (f + 1) % kFaces}) polygons.corners.push_back(v);
    polygons.offsets.push_back(4 * (f + 1));
  }
  const FaceGraph graph(1 + kFaces, polygons);
  for (int f = 0; f < kFaces; ++f) {
    EXPECT_EQ(graph.kind[4 * f], EdgeKind::border);
    EXPECT_EQ(graph.opposite[4 * f + 1], 4 * ((f + kFaces - 1) % kFaces) + 3);
    EXPECT_EQ(graph.kind[4 * f + 2], EdgeKind::border);
    EXPECT_EQ(graph.kind[4 * f + 3], EdgeKind::inner);
  }
}

TEST(Colours, AreThoseOfRoundsThatTellNoMoreApart) {
  test::Shape notched = test::grid(7, 6), tangled = test::grid(4, 4), twice = test::sphere(1);
  notched.triangles = Triangles(notched.triangles.bottomRows(notched.triangles.rows() - 1));
  tangled.triangles.row(3).reverseInPlace();
  twice = test::both(twice, twice);
  const std::vector<test::Shape> shapes = {notched, tangled, twice, test::sphere(2),
                                           test::both(notched, tangled)};
  for (const test::Shape& a : shapes) {
    for (const test::Shape& b : shapes) {
      const FaceGraph of_a = graph_of(a), of_b = graph_of(b);
      const Colours found(of_a, of_b);
      std::vector<int> colours = found.of_a;
      colours.insert(colours.end(), found.of_b.begin(), found.of_b.end());
      expect_same_classes(colours, literal_colours(of_a, of_b));
      for (const int colour : colours) EXPECT_TRUE(colour >= 0 && colour < found.count);
    }
  }
}

TEST(Colours, OfAMeshWithoutFacesAreNone) {
  const FaceGraph none(0, Polygons());
  EXPECT_EQ(Colours(none, none).count, 0);
}

}  // namespace
}  // namespace mimetra
