#include <fstream>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/npy.h"
#include "tests/shared_data.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"

/// Equation 10 on the Surrey model against exact solutions of another program.
namespace mimetra::test {
namespace {

Frames rows_of(const std::string& name) {
  const NpyArray array = read_npy(shared_path("oracle/blendshape_transfer/" + name));
  return Eigen::Map<const Frames>(array.values.data(), array.rows(), array.columns());
}

class BlendshapeOracle : public testing::Test {
 protected:
  void SetUp() override { MIMETRA_SKIP_WITHOUT(shared_path("oracle/blendshape_transfer")); }

  static BlendshapeModel target() {
    const Positions neutral = rows_of("target_neutral.npy");
    const Triangles triangles = rows_of("triangles.npy").cast<int>();
    const Frames fields = rows_of("target_displacements.npy");
    ShapeBasis basis{{}, fields.transpose()};
    for (int j = 0; j < fields.rows(); ++j) basis.names.push_back(std::to_string(j));
    return {std::make_shared<Connectivity>(
                Connectivity::from_triangles(static_cast<int>(neutral.rows()), triangles)),
            neutral, basis};
  }

  static MeshSequence source(const BlendshapeModel& target) {
    return {target.shared_connectivity(),
            rows_of("source_poses.npy"),
            {},
            Positions(rows_of("source_rest.npy"))};
  }

  /// Triangles whose byte is not 0 in a mask of one byte a triangle, which ends its file.
  static std::vector<int> region(const BlendshapeModel& target) {
    std::ifstream file(shared_path("oracle/blendshape_transfer/region_triangles.npy"),
                       std::ios::binary);
    const auto count = static_cast<int>(target.triangles().rows());
    std::string mask(count, 0);
    file.seekg(-count, std::ios::end);
    file.read(mask.data(), count);
    std::vector<int> rows;
    for (int t = 0; t < count; ++t) {
      if (mask[t] != 0) rows.push_back(t);
    }
    return rows;
  }
};

// Both solve the same box problem exactly; the condition number is below 1e3, so that rounding
// stays far below 1e-9.
constexpr double kSame = 1e-9;

const BlendshapeTransferOptions kAsThePaper{.edges = EdgeSum::two};

TEST_F(BlendshapeOracle, AgreesOverAllTrianglesWithAndWithoutTheBox) {
  const BlendshapeModel model = target();
  const MeshSequence performance = source(model);
  const BlendshapeTransfer transfer(performance.rest(), model, all_triangles(model.triangles()),
                                    kAsThePaper);
  EXPECT_LT(
      (transfer.weights(performance) - rows_of("beta_all_triangles.npy")).lpNorm<Eigen::Infinity>(),
      kSame);
  const Eigen::LDLT<Eigen::MatrixXd> factor(transfer.gram());
  const Frames expected = rows_of("beta_unconstrained_all.npy");
  for (int f = 0; f < performance.frames(); ++f) {
    const Eigen::VectorXd beta = factor.solve(transfer.right_hand_side(performance.frame(f)));
    EXPECT_LT((beta.transpose() - expected.row(f)).lpNorm<Eigen::Infinity>(), kSame);
  }
}

TEST_F(BlendshapeOracle, AgreesOverARegion) {
  const BlendshapeModel model = target();
  const MeshSequence performance = source(model);
  const BlendshapeTransfer transfer(performance.rest(), model, region(model), kAsThePaper);
  EXPECT_LT((transfer.weights(performance) - rows_of("beta_region.npy")).lpNorm<Eigen::Infinity>(),
            kSame);
}

}  // namespace
}  // namespace mimetra::test
