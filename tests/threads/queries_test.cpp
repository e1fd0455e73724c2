#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "geodesic/exact_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "tests/threads/together.h"
#include "toolkit/regions/regions.h"
#include "toolkit/splocs/surface_distances.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using test::kTogether;
using test::together;

/// The same question asked by all threads, of which every one gets the answer of one alone.
template <typename Ask>
void expect_one_answer(const Ask& ask) {
  const auto expected = ask();
  std::array<decltype(ask()), kTogether> answers;
  together([&](int i) { answers[static_cast<std::size_t>(i)] = ask(); });
  for (const auto& answer : answers) EXPECT_TRUE(answer == expected);
}

TEST(Queries, OfHeatGeodesicsMayMeet) {
  const test::Shape shape = test::sphere(2);
  const geodesic::HeatGeodesics heat(shape.positions, shape.triangles);
  const std::vector<VertexIndex> sources = {0, 9, 30};
  expect_one_answer([&] { return heat.distances_from_each(sources); });
}

TEST(Queries, OfExactGeodesicsMayMeet) {
  const test::Shape shape = test::sphere(1);
  const geodesic::ExactGeodesics exact(shape.positions, shape.triangles);
  expect_one_answer([&] { return exact.distances(3); });
}

TEST(Queries, OfSurfaceDistancesShareWhatTheyKnow) {
  const test::Shape shape = test::sphere(2);
  const SurfaceDistances distances(shape.positions, shape.triangles, Weld::exact(shape.positions),
                                   GeodesicMethod::heat, Context().with_threads(2));
  const std::vector<VertexIndex> sources = {5, 6, 7, 8};
  expect_one_answer([&] { return distances(sources); });
  EXPECT_EQ(distances.computed(), 4);
}

TEST(Queries, OfTransfersMayMeet) {
  const MeshSequence take = test::bulging_sphere(12);
  Frames shapes(2, take.positions().cols());
  shapes << take.positions().row(3), take.positions().row(9);
  const Eigen::Map<const Eigen::RowVectorXd> rest(take.rest().data(), take.rest().size());
  const BlendshapeModel actor(take.shared_connectivity(), take.rest(),
                              {{"up", "aside"}, (shapes.rowwise() - rest).transpose()});
  std::vector<int> all(static_cast<std::size_t>(take.triangles().rows()));
  std::iota(all.begin(), all.end(), 0);
  const Context context = Context().with_threads(2);
  const BlendshapeTransfer to_weights(take.rest(), actor, all, {}, context);
  expect_one_answer([&] { return to_weights.weights(take, context); });
}

TEST(ParallelKernels, FindTheSameComponentsAndRegions) {
  const MeshSequence take = test::bulging_sphere(24);
  const auto found = [&take](int threads) {
    const Context context = Context().with_threads(threads);
    const Components components = decompose(take, {.count = 2, .iterations = 2}, context);
    return find_regions(components, {}, context).triangles;
  };
  EXPECT_EQ(found(kTogether), found(1));
}

}  // namespace
}  // namespace mimetra
