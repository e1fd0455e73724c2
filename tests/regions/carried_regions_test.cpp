#include "toolkit/regions/regions.h"

#include <gmock/gmock.h>

#include "tests/regions/moving_grid.h"
#include "tests/shapes.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/simplification.h"

namespace mimetra::test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A flat sheet, on which distances along the surface are known, and fewer of its vertices.
struct Sheet {
  Shape fine = grid(31, 21);
  Simplification coarse =
      simplify(MeshSequence(Connectivity::from_triangles(651, fine.triangles),
                            fine.positions.reshaped<Eigen::RowMajor>().transpose()),
               {.share = 0.25});

  DistanceFunction distances() const {
    return one_by_one([this](VertexIndex center) -> Eigen::VectorXd {
      return (fine.positions.rowwise() - fine.positions.row(center)).rowwise().norm();
    });
  }

  /// A region of each of some coarse vertices, with no other vertex in it.
  Regions around(const std::vector<int>& centers, double radius) const {
    std::vector<std::vector<VertexIndex>> lists;
    lists.reserve(centers.size());
    for (const int center : centers) lists.push_back({center});
    Regions regions =
        regions_from_vertices(coarse.connectivity->vertices, coarse.connectivity->triangles, lists);
    for (std::size_t i = 0; i < centers.size(); ++i) {
      regions.regions[i].center = centers[i];
      regions.regions[i].radius = radius;
    }
    return regions;
  }

  /// More to one side.
  Eigen::VectorXd energy() const {
    return Eigen::VectorXd::LinSpaced(651, 0, 1) / Eigen::VectorXd::LinSpaced(651, 0, 1).sum();
  }

  Regions carried(const Regions& regions, const std::vector<bool>& inside = {}) const {
    return carried_regions(regions, coarse, energy(), fine.triangles, distances(), inside);
  }
};

TEST(CarriedRegions, AreDiscsOfTheWholeMeshAroundTheSameVertices) {
  const Sheet sheet;
  const Regions carried = sheet.carried(sheet.around({20, 60}, 4.5));
  ASSERT_EQ(carried.regions.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Region& region = carried.regions[i];
    EXPECT_EQ(region.center, sheet.coarse.vertices[i == 0 ? 20 : 60]);
    std::vector<VertexIndex> expected;
    for (int v = 0; v < 651; ++v) {
      const auto way = sheet.fine.positions.row(v) - sheet.fine.positions.row(region.center);
      if (way.norm() <= 4.5) expected.push_back(v);
    }
    EXPECT_EQ(region.vertices, expected);
    EXPECT_EQ(region.energy_share, sheet.energy()(expected).sum());
    EXPECT_GT(region.energy_share, 0);
  }
  EXPECT_EQ(carried.vertices, 651);
  EXPECT_EQ(carried.all_triangles, sheet.fine.triangles.rows());
  double share = 0;
  for (int v = 0; v < 651; ++v) share += carried.inside[std::size_t(v)] ? sheet.energy()[v] : 0;
  EXPECT_EQ(carried.energy_share, share);
  EXPECT_TRUE(carried.energy_is_known());
}

TEST(CarriedRegions, HoldOnlyVerticesThatMayBeIn) {
  const Sheet sheet;
  std::vector<bool> right(651);
  for (int v = 0; v < 651; ++v) right[std::size_t(v)] = sheet.fine.positions(v, 0) > 15;
  const Regions carried = sheet.carried(sheet.around({20, 60}, 20), right);
  EXPECT_EQ(carried.inside, right);
}

TEST(CarriedRegions, NameWhatDoesNotFit) {
  const Sheet sheet;
  Regions regions = sheet.around({3}, 1);
  regions.regions[0].center = -1;
  EXPECT_THAT([&] { sheet.carried(regions); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no centre")));
  regions.vertices = 7;
  EXPECT_THAT([&] { sheet.carried(regions); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("regions of 7 vertices")));
}

}  // namespace
}  // namespace mimetra::test
