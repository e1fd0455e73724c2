// Slivers of source and target: a vertex that was slid to the opposite edge of one of its triangles
// changes next to nothing, however far it was slid.

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/transfer_error.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using test::model_on;
using test::random_weights;
using test::Shape;

constexpr int kSide = 49;

/// A patch of a real face's fineness, curved by `bend`.
Shape fine_patch(double bend) {
  Shape shape = test::grid(kSide, kSide);
  shape.positions *= 8.0 / (kSide - 1);
  for (int v = 0; v < shape.positions.rows(); ++v) {
    shape.positions(v, 2) = 0.05 * shape.positions.row(v).head<2>().squaredNorm() +
                            bend * std::cos(shape.positions(v, 0));
  }
  return shape;
}

/// The first triangle of a cell of the grid.
int triangle_of(int column, int row) {
  return 2 * (row * (kSide - 1) + column);
}

/// A triangle, the corner that is slid, and whether its own motion goes with it.
struct Slide {
  int triangle;
  int corner = 0;
  bool own_motion = false;

  VertexIndex vertex(const Triangles& triangles) const { return triangles(triangle, corner); }
  Eigen::RowVector3d opposite(const Positions& pose, const Triangles& triangles) const {
    return (pose.row(triangles(triangle, (corner + 1) % 3)) +
            pose.row(triangles(triangle, (corner + 2) % 3))) /
           2;
  }
};

/// Moves the vertex to the middle of the opposite edge but for the share `left` of its way.
Positions slid(Positions pose, const Triangles& triangles, const Slide& slide, double left) {
  const Eigen::RowVector3d middle = slide.opposite(pose, triangles);
  const VertexIndex v = slide.vertex(triangles);
  pose.row(v) = middle + left * (pose.row(v) - middle);
  return pose;
}

class Slivers : public testing::TestWithParam<bool> {
 protected:
  static constexpr int kExpressions = 5;
  /// Its expressions move vertices by 6 % of the size.
  const MeshSequence source_ =
      model_on(fine_patch(0), kExpressions).animate(0.5 * random_weights(2, kExpressions));
  const BlendshapeModel actor_ = model_on(fine_patch(0.2), kExpressions);
  const Triangles& triangles_ = actor_.triangles();
  const double size_ = diameter(actor_.neutral());

  /// The source with some vertices slid in its rest pose and its frames.
  MeshSequence with_slides(const std::vector<Slide>& slides, double left) const {
    Positions rest = source_.rest();
    for (const Slide& slide : slides) rest = slid(rest, triangles_, slide, left);
    Frames frames = source_.positions();
    for (int f = 0; f < source_.frames(); ++f) {
      Positions pose = source_.frame(f);
      for (const Slide& slide : slides) {
        const VertexIndex v = slide.vertex(triangles_);
        const Eigen::RowVector3d motion = pose.row(v) - source_.rest().row(v);
        pose = slid(pose, triangles_, slide, left);
        if (slide.own_motion) pose.row(v) = rest.row(v) + motion;
      }
      frames.row(f) = pose.reshaped<Eigen::RowMajor>().transpose();
    }
    return {source_.shared_connectivity(), frames, source_.times(), rest};
  }

  /// The source with a vertex drawn to its neighbour, so that both triangles of their edge become
  /// needles.
  MeshSequence with_needles(double left) const {
    const auto drawn = [&](Positions pose) {
      const VertexIndex v = triangles_(triangle_of(24, 24), 0), to = v + 1;
      pose.row(v) = pose.row(to) + left * (pose.row(v) - pose.row(to));
      return pose;
    };
    Frames frames = source_.positions();
    for (int f = 0; f < source_.frames(); ++f) {
      frames.row(f) = drawn(source_.frame(f)).reshaped<Eigen::RowMajor>().transpose();
    }
    return {source_.shared_connectivity(), frames, source_.times(), drawn(source_.rest())};
  }

  /// In one space or the other.
  Frames transferred(const MeshSequence& source, const BlendshapeModel& target) const {
    const std::vector<int> all = all_triangles(triangles_);
    if (GetParam()) {
      return VertexTransfer(source.rest(), target.neutral(), triangles_, all).frames(source);
    }
    return target.animate(BlendshapeTransfer(source.rest(), target, all).weights(source))
        .positions();
  }

  /// The largest distance between two results, whose mean distance in each frame is taken off.
  double difference(const Frames& one, const Frames& other,
                    const std::vector<VertexIndex>& without = {}) const {
    double largest = 0;
    for (Eigen::Index f = 0; f < one.rows(); ++f) {
      const PositionsView a(one.row(f).data(), actor_.vertices(), 3);
      const PositionsView b(other.row(f).data(), actor_.vertices(), 3);
      Positions apart = a - b;
      apart.rowwise() -= Eigen::RowVector3d(apart.colwise().mean());
      for (const VertexIndex v : without) apart.row(v).setZero();
      largest = std::max(largest, apart.rowwise().norm().maxCoeff());
    }
    return largest / size_;
  }

  double worst_quality(const Positions& rest) const {
    double worst = 1;
    for (int t = 0; t < triangles_.rows(); ++t) {
      worst = std::min(worst, quality_of(rest, triangles_, t));
    }
    return worst;
  }
};

/// Qualities from 3e-2 to 1e-12, on both sides of where each rule begins.
const std::vector<double> kLeft = {0.1,  0.05, 0.03, 0.02, 0.01, 3e-3,
                                   1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-12};

/// Some of them, one at least for each rule.
const std::vector<double> kSomeLeft = {0.05, 0.01, 1e-3, 1e-5, 1e-6, 1e-12};

TEST_P(Slivers, OfTheSourceLeaveTheResultAsItWas) {
  const Frames expected = transferred(source_, actor_);
  for (const int triangle : {triangle_of(24, 24), triangle_of(20, 17) + 1, triangle_of(30, 9)}) {
    double before = 0;
    for (const double left : kLeft) {
      const MeshSequence source = with_slides({{triangle}}, left);
      const double apart = difference(transferred(source, actor_), expected);
      EXPECT_LT(apart, 1e-3) << "triangle " << triangle << ", left " << left;
      // No jump anywhere.
      EXPECT_LT(std::abs(apart - before), 1e-3);
      before = apart;
    }
    EXPECT_LT(worst_quality(with_slides({{triangle}}, 1e-12).rest()), 1e-11);
  }
}

TEST_P(Slivers, OfTheSourceThatMoveOnTheirOwnHardlyShow) {
  const Frames expected = transferred(source_, actor_);
  for (const double left : kSomeLeft) {
    const MeshSequence source =
        with_slides({{.triangle = triangle_of(24, 24), .own_motion = true}}, left);
    EXPECT_LT(difference(transferred(source, actor_), expected), 5e-3) << left;
  }
}

TEST_P(Slivers, InPairsAndStripsLeaveTheResultAsItWas) {
  const Frames expected = transferred(source_, actor_);
  // Every second cell of a row, so that slid vertices do not meet.
  std::vector<Slide> strip;
  strip.reserve(10);
  for (int i = 0; i < 10; ++i) strip.push_back({triangle_of(14 + 2 * i, 24)});
  for (const double left : kSomeLeft) {
    EXPECT_LT(difference(transferred(with_needles(left), actor_), expected), 1e-3) << left;
    EXPECT_LT(difference(transferred(with_slides(strip, left), actor_), expected), 1e-3) << left;
  }
}

TEST_P(Slivers, OfTheTargetLeaveTheOtherVerticesWhereTheyWere) {
  const Frames expected = transferred(source_, actor_);
  const Slide slide{triangle_of(24, 24)};
  for (const double left : kSomeLeft) {
    ShapeBasis expressions = actor_.expressions();
    for (Eigen::Index j = 0; j < expressions.displacements.cols(); ++j) {
      Eigen::Map<Positions> field(expressions.displacements.col(j).data(), actor_.vertices(), 3);
      field = slid(Positions(field), triangles_, slide, left);
    }
    const BlendshapeModel target(actor_.shared_connectivity(),
                                 slid(actor_.neutral(), triangles_, slide, left), expressions);
    EXPECT_LT(difference(transferred(source_, target), expected, {slide.vertex(triangles_)}), 3e-3)
        << left;
  }
}

INSTANTIATE_TEST_SUITE_P(Transfer, Slivers, testing::Bool(), [](const auto& in_vertices) {
  return in_vertices.param ? "InVertexSpace" : "InBlendshapeSpace";
});

TEST(OwnShare, FallsFromOneToNothingWithoutAJump) {
  EXPECT_EQ(own_share(kSoundQuality), 1);
  EXPECT_EQ(own_share(0.8), 1);
  EXPECT_EQ(own_share(0), 0);
  EXPECT_EQ(own_share(std::nan("")), 0);
  EXPECT_LT(own_share(1e-2), 0.5);
  EXPECT_GT(own_share(1e-2), 0);
  EXPECT_NEAR(own_share(kDegenerateQuality), 0, 1e-8);
}

}  // namespace
}  // namespace mimetra
