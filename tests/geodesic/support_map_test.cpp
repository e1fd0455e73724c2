#include <limits>

#include <gtest/gtest.h>

#include "geodesic/support_map.h"

namespace mimetra::geodesic {
namespace {

TEST(SupportMap, IsZeroUpToTheFirstDistanceOneFromTheSecondAndLinearBetween) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd distances{{0, 0.5, 1, 1.5, 2, 2.5, 3, 4, infinity}};
  const Eigen::VectorXd expected{{0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1}};
  EXPECT_EQ(support_map(distances, 1, 3), expected);
  EXPECT_EQ(support_map(Eigen::VectorXd{{0, 1}}, 0, 2), (Eigen::VectorXd{{0, 0.5}}));
}

TEST(SupportMap, RefusesDistancesThatAreNoInterval) {
  const Eigen::VectorXd distances = Eigen::VectorXd::Zero(2);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [d_min, d_max] : {std::pair(1.0, 1.0), std::pair(2.0, 1.0), std::pair(-1.0, 1.0),
                                     std::pair(0.0, infinity), std::pair(0.0, std::nan(""))}) {
    EXPECT_THROW(support_map(distances, d_min, d_max), std::invalid_argument);
  }
}

}  // namespace
}  // namespace mimetra::geodesic
