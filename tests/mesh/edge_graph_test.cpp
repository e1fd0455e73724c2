#include "toolkit/mesh/edge_graph.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

EdgeGraph graph_of(const test::Shape& shape) {
  return EdgeGraph(shape.positions, shape.triangles);
}

TEST(EdgeGraph, FindsWhatIsWithinReachAndHowFar) {
  const EdgeGraph graph = graph_of(test::grid(5, 1 + 4));
  const auto near = graph.within(1, {12});
  for (const VertexIndex v : {7, 11, 13, 17}) EXPECT_EQ(near.at(v), 1) << v;
  EXPECT_EQ(near.at(12), 0);
  EXPECT_EQ(near.size(), 5u);
}

TEST(EdgeGraph, CountsFromTheNearestOfSeveral) {
  const auto near = graph_of(test::grid(9, 2)).within(100, {0, 8});
  EXPECT_EQ(near.size(), 18u);
  for (int x = 0; x < 9; ++x) EXPECT_EQ(near.at(x), std::min(x, 8 - x));
}

TEST(EdgeGraph, DoesNotReachAnotherPart) {
  test::Shape two = test::grid(3, 3);
  const auto vertices = static_cast<int>(two.positions.rows());
  two.positions = two.positions.replicate<2, 1>().eval();
  Triangles triangles(2 * two.triangles.rows(), 3);
  triangles << two.triangles, two.triangles.array() + vertices;
  EXPECT_EQ(EdgeGraph(two.positions, triangles).within(100, {0}).size(), 9u);
}

TEST(EdgeGraph, KnowsTheLongestEdge) {
  EXPECT_EQ(graph_of(test::grid(3, 3)).longest_edge(4), std::sqrt(2.0));
  EXPECT_EQ(EdgeGraph(Positions::Zero(1, 3), Triangles(0, 3)).longest_edge(0), 0);
}

}  // namespace
}  // namespace mimetra
