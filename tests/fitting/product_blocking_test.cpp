#include "tests/cache_sizes.h"
#include "tests/fitting/synthetic_clip.h"

namespace mimetra {
namespace {

TEST(ProductBlocking, IsFixedForFits) {
  const test::SyntheticClip clip =
      test::synthetic_clip(3, {.landmarks = 500, .identities = 63, .expressions = 20, .frames = 4});
  for (const auto solver : {FitOptions::Solver::alternating, FitOptions::Solver::joint}) {
    for (const auto shape : {FitOptions::Shape::clip, FitOptions::Shape::frame}) {
      test::expect_equal_bytes_on_each_processor([&] {
        const auto fits = test::fit(clip, {.solver = solver, .shape = shape});
        Eigen::MatrixXd all(8 + 63 + 20, fits.size());
        for (std::size_t f = 0; f < fits.size(); ++f) {
          all.col(static_cast<Eigen::Index>(f)) << fits[f].camera.reshaped(), fits[f].alpha,
              fits[f].beta;
        }
        return all;
      });
    }
  }
}

TEST(ProductBlocking, IsFixedForCameras) {
  const ModelPoints points = ModelPoints::Random(3000, 3);
  const ImagePoints image = ImagePoints::Random(3000, 2);
  test::expect_equal_bytes_on_each_processor(
      [&] { return Eigen::MatrixXd(estimate_affine_camera(points, image)); });
}

}  // namespace
}  // namespace mimetra
