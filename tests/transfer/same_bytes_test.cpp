#include <cmath>

#include <gtest/gtest.h>

#include "tests/cache_sizes.h"
#include "tests/shapes.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

/// Several blocks of vertices and of frames, so that threads have something to share and products
/// are long enough to be cut.
class SameBytes : public testing::Test {
 protected:
  static constexpr int kSide = 36, kFrames = 100;

  SameBytes() {
    const test::Shape shape = test::grid(kSide, kSide);
    const auto n = static_cast<int>(shape.positions.rows());
    auto connectivity =
        std::make_shared<Connectivity>(Connectivity::from_triangles(n, shape.triangles));
    Eigen::MatrixXd bumps = Eigen::MatrixXd::Zero(3 * n, 4);
    for (int v = 0; v < n; ++v) {
      for (int j = 0; j < 4; ++j) {
        const int column = j % 2, row = j / 2;
        const double x = shape.positions(v, 0) - 9 * (1 + 2 * column);
        const double y = shape.positions(v, 1) - 9 * (1 + 2 * row);
        bumps(3 * v + 2, j) = std::exp(-(x * x + y * y) / 20);
        bumps(3 * v, j) = 0.1 * std::sin(0.3 * v + j) * bumps(3 * v + 2, j);
      }
    }
    model_ = BlendshapeModel(connectivity, shape.positions, {{"a", "b", "c", "d"}, bumps});
    Eigen::MatrixXd weights(kFrames, 4);
    for (int f = 0; f < kFrames; ++f) {
      for (int j = 0; j < 4; ++j) weights(f, j) = std::pow(std::sin(0.1 * f * (j + 1)), 2);
    }
    sequence_ = model_.animate(weights, Eigen::VectorXd::LinSpaced(kFrames, 0, 4));
  }

  DistanceFunction straight_distances() const {
    return one_by_one([this](VertexIndex source) {
      return Eigen::VectorXd(
          (sequence_.rest().rowwise() - sequence_.rest().row(source)).rowwise().norm());
    });
  }

  BlendshapeModel model_;
  MeshSequence sequence_;
};

class Threads : public SameBytes {};
class ProductBlocking : public SameBytes {};

TEST_F(Threads, DoNotChangeADecomposition) {
  const auto components = [&](int threads) {
    return decompose(sequence_, {.count = 4, .iterations = 3, .distances = straight_distances()},
                     Context().with_threads(threads));
  };
  const Components one = components(1);
  for (const int threads : {2, 5}) {
    const Components several = components(threads);
    EXPECT_TRUE(several.displacements == one.displacements) << threads;
    EXPECT_TRUE(several.weights == one.weights) << threads;
    EXPECT_EQ(several.energies, one.energies) << threads;
  }
}

TEST_F(Threads, DoNotChangeATransfer) {
  const std::vector<int> all = all_triangles(sequence_.triangles());
  const auto weights = [&](int threads) {
    const Context context = Context().with_threads(threads);
    return BlendshapeTransfer(sequence_.rest(), model_, all, {}, context)
        .weights(sequence_, context);
  };
  const auto frames = [&](int threads) {
    const Context context = Context().with_threads(threads);
    return VertexTransfer(sequence_.rest(), model_.neutral(), sequence_.triangles(), all, {},
                          context)
        .frames(sequence_, context);
  };
  for (const int threads : {2, 3}) {
    EXPECT_TRUE(weights(threads) == weights(1)) << threads;
    EXPECT_TRUE(frames(threads) == frames(1)) << threads;
  }
}

TEST_F(ProductBlocking, IsFixedForDecompositions) {
  for (const IterationPrecision precision : choices<IterationPrecision>()) {
    for (const double tolerance : {0.0, 0.01}) {
      test::expect_equal_bytes_on_each_processor([&] {
        return Eigen::MatrixXd(decompose(sequence_, {.count = 4,
                                                     .iterations = 3,
                                                     .basis_tolerance = tolerance,
                                                     .precision = precision,
                                                     .distances = straight_distances()})
                                   .displacements);
      });
    }
  }
}

TEST_F(ProductBlocking, IsFixedForTransfers) {
  const std::vector<int> all = all_triangles(sequence_.triangles());
  test::expect_equal_bytes_on_each_processor(
      [&] { return BlendshapeTransfer(sequence_.rest(), model_, all).gram(); });
  const BlendshapeTransfer transfer(sequence_.rest(), model_, all);
  test::expect_equal_bytes_on_each_processor([&] { return transfer.weights(sequence_); });
  test::expect_equal_bytes_on_each_processor(
      [&] { return transfer.right_hand_side(sequence_.frame(7)); });
}

}  // namespace
}  // namespace mimetra
