#include <limits>
#include <map>
#include <set>
#include <utility>

#include <gmock/gmock.h>

#include "samples/head/anatomy.h"
#include "tests/samples/head_fixture.h"
#include "toolkit/mesh/surface.h"

namespace mimetra::test {
namespace {

/// Boundary edges as directed by their triangles, from vertex to vertex.
std::map<int, int> boundary() {
  std::set<std::pair<int, int>> edges;
  const Triangles& triangles = head().connectivity().triangles;
  for (int t = 0; t < triangles.rows(); ++t) {
    for (int c = 0; c < 3; ++c) edges.insert({triangles(t, c), triangles(t, (c + 1) % 3)});
  }
  std::map<int, int> next;
  for (const auto& [a, b] : edges) {
    if (!edges.contains({b, a})) next[a] = b;
  }
  return next;
}

/// Lowest height of each boundary loop, ascending.
std::vector<double> loop_heights() {
  std::map<int, int> next = boundary();
  std::vector<double> heights;
  while (!next.empty()) {
    double lowest = std::numeric_limits<double>::infinity();
    for (auto edge = next.begin(); edge != next.end();) {
      const int to = edge->second;
      lowest = std::min(lowest, head().mean()(to, 1));
      next.erase(edge);
      edge = next.find(to);
    }
    heights.push_back(lowest);
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

TEST(Head, HasAboutFiveThousandVerticesInQuadrilateralsAndIsAsLargeAsAHeadInMillimetres) {
  EXPECT_GE(head().vertices(), 4500);
  EXPECT_LE(head().vertices(), 5500);
  const Connectivity& connectivity = head().connectivity();
  EXPECT_GT(connectivity.triangles.rows(), 1.9 * connectivity.polygons.size());
  EXPECT_GE(extent(head().mean()), 200);
  EXPECT_LE(extent(head().mean()), 300);
}

TEST(Head, IsAManifoldOfSixPartsWithoutLooseOrDoubledVertices) {
  const MeshReport report = inspect(head().mean(), head().connectivity());
  EXPECT_EQ(report.components, 6) << "skin, eyeballs, teeth of two jaws and tongue";
  EXPECT_EQ(report.nonmanifold_edges, 0);
  EXPECT_EQ(report.inconsistent_edges, 0);
  EXPECT_TRUE(report.vertices_without_face.empty());
  EXPECT_EQ(report.welded_vertices, 0);
}

TEST(Head, FacesOutwards) {
  // The foremost vertex is on the nose: the normals around it point forward.
  Eigen::Index tip;
  head().mean().col(2).maxCoeff(&tip);
  const Triangles& triangles = head().connectivity().triangles;
  for (int t = 0; t < triangles.rows(); ++t) {
    if ((triangles.row(t).array() != tip).all()) continue;
    EXPECT_GT(normal(head().mean(), t).z(), 0);
  }
}

TEST(Head, HasEyeballsTeethAndATongueThatFaceOutwards) {
  const Triangles& triangles = head().connectivity().triangles;
  const ConnectedComponents parts = connected_components(head().vertices(), triangles);
  std::map<int, double> volumes;
  for (int t = 0; t < triangles.rows(); ++t) {
    volumes[parts.of_vertex[static_cast<std::size_t>(triangles(t, 0))]] +=
        corner(head().mean(), t, 0)
            .dot(corner(head().mean(), t, 1).cross(corner(head().mean(), t, 2))) /
        6;
  }
  ASSERT_EQ(volumes.size(), 6u);
  for (const auto& [part, volume] : volumes) EXPECT_GT(volume, 0) << part;
}

TEST(Head, IsOpenAtNeckAndEyesAndClosedBehindTheMouth) {
  const std::vector<double> heights = loop_heights();
  ASSERT_EQ(heights.size(), 3u);
  EXPECT_LT(heights[0], -130);     // neck
  EXPECT_NEAR(heights[1], 0, 10);  // eyes
  EXPECT_EQ(heights[1], heights[2]);
}

TEST(Head, HasLipsThatTouchAndEyesThatAreOpen) {
  for (const double gap : gaps(head().mean(), mouth_edges())) EXPECT_LT(gap, 0.5);
  const std::vector<double> lids = gaps(head().mean(), eye_edges(1));
  EXPECT_GT(*std::max_element(lids.begin(), lids.end()), 8);
}

TEST(Head, LooksOutOfEyesThatFillTheirOpening) {
  // Whatever lies behind the edge of a lid ends inside the eyeball, so no gap shows beside it.
  constexpr double kEyeballRadius = 13;
  const samples::HeadGrid& vertices = grid();
  for (int v = 0; v < head().vertices(); ++v) {
    const samples::HeadVertex& vertex = vertices.vertices[static_cast<std::size_t>(v)];
    if (vertex.part != samples::HeadVertex::Part::eyelid || vertex.ring != 2) continue;
    Eigen::RowVector3d center = samples::kLeftEye.transpose();
    center.x() *= vertex.eye;
    EXPECT_LT((head().mean().row(v) - center).norm(), kEyeballRadius) << v;
  }
}

/// The skin in front of a place: of what lies there, up to 3 mm beside it, the foremost.
double skin_in_front_of(const Positions& pose, const Eigen::Vector3d& place) {
  double foremost = -std::numeric_limits<double>::infinity();
  for (int v = 0; v < pose.rows(); ++v) {
    if (part_of(v) != samples::HeadVertex::Part::skin) continue;
    const bool here = std::hypot(pose(v, 0) - place.x(), pose(v, 1) - place.y()) < 3;
    if (here) foremost = std::max(foremost, pose(v, 2));
  }
  return foremost;
}

TEST(Head, HidesItsTeethAndTongueBehindTheLips) {
  for (int i = -1; i < head().identities().size(); ++i) {
    const Positions person =
        i < 0 ? head().mean() : Positions(head().mean() + field(head().identities(), i));
    for (int v = 0; v < head().vertices(); ++v) {
      if (!is_inside_the_mouth(v)) continue;
      EXPECT_LT(person(v, 2), skin_in_front_of(person, person.row(v)) - 0.5) << i << ", " << v;
    }
  }
}

TEST(Head, HasANoseThatStandsOutAndEyesThatLieBack) {
  Eigen::Index tip;
  const double nose = head().mean().col(2).maxCoeff(&tip);
  EXPECT_NEAR(head().mean()(tip, 0), 0, 3);
  const double pupil = samples::kLeftEye.z() + 13;
  EXPECT_GT(nose - pupil, 20);
}

TEST(Head, IsMirrorSymmetric) {
  EXPECT_THAT(mirror_vertices(), ::testing::Each(::testing::Ge(0)));
}

TEST(Head, IsTheSameEachTime) {
  const MorphableModel again = samples::parametric_head();
  EXPECT_EQ(again.mean(), head().mean());
  EXPECT_EQ(again.expressions().displacements, head().expressions().displacements);
  EXPECT_EQ(again.identities().displacements, head().identities().displacements);
}

TEST(HeadIdentities, HaveNamesByNumber) {
  EXPECT_THAT(head().identities().names,
              ::testing::ElementsAre("identity000", "identity001", "identity002", "identity003"));
}

TEST(HeadIdentities, FlipNoTriangle) {
  for (int i = 0; i < head().identities().size(); ++i) {
    EXPECT_EQ(flipped(head().mean(), head().mean() + field(head().identities(), i)), 0) << i;
  }
}

TEST(HeadIdentities, AreMirrorSymmetric) {
  const std::vector<int> mirror = mirror_vertices();
  for (int i = 0; i < head().identities().size(); ++i) {
    const Positions moved = field(head().identities(), i);
    for (int v = 0; v < head().vertices(); ++v) {
      EXPECT_EQ(moved.row(mirror[static_cast<std::size_t>(v)]),
                moved.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1)))
          << i << ", " << v;
    }
  }
}

TEST(HeadIdentities, MoveEachEyeballAsAWhole) {
  for (int i = 0; i < head().identities().size(); ++i) {
    const Positions moved = field(head().identities(), i);
    std::map<int, int> first;
    for (int v = 0; v < head().vertices(); ++v) {
      const samples::HeadVertex& vertex = grid().vertices[static_cast<std::size_t>(v)];
      if (vertex.part != samples::HeadVertex::Part::eyeball) continue;
      EXPECT_EQ(moved.row(v), moved.row(first.emplace(vertex.eye, v).first->second)) << i;
    }
    EXPECT_EQ(first.size(), 2u);
  }
}

TEST(HeadIdentities, HaveEyesThatABlinkCloses) {
  const Positions blink = field("eyeBlinkLeft");
  for (int i = 0; i < head().identities().size(); ++i) {
    const Positions person = head().mean() + field(head().identities(), i);
    const std::vector<double> open = gaps(person, eye_edges(1));
    const double widest = *std::max_element(open.begin(), open.end());
    const Positions shut = person + blink;
    for (const auto& [above, below] : eye_edges(1)) {
      EXPECT_GT(shut(above, 1), shut(below, 1)) << i;
      EXPECT_LT((shut.row(above) - shut.row(below)).norm(), 0.05 * widest) << i;
    }
  }
}

TEST(HeadIdentities, AreClearlyDifferentFromEachOtherAndTheMean) {
  // Root mean square of the displacement, in mm; a thousandth of the head would not be noticed.
  const auto rms = [](const Positions& d) { return d.norm() / std::sqrt(double(d.rows())); };
  for (int i = 0; i < head().identities().size(); ++i) {
    EXPECT_GT(rms(field(head().identities(), i)), 2) << i;
    for (int j = 0; j < i; ++j) {
      EXPECT_GT(rms(field(head().identities(), i) - field(head().identities(), j)), 3) << i << j;
    }
  }
}

}  // namespace
}  // namespace mimetra::test
