#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {
namespace {

using test::bent_patch;
using test::model_on;
using test::patch;
using test::random_weights;
using test::Shape;
using testing::ElementsAre;
using testing::HasSubstr;

/// Eq. 10 written out: A (6 T x D) and b of eq. 11 from Q_i, V_i and the expressions' edges, of T
/// triangles.
struct LiteralSystem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};

LiteralSystem literal_system(const Positions& source_rest, const Eigen::Ref<const Positions>& pose,
                             const BlendshapeModel& target, const Triangles& triangles) {
  const auto d = target.expressions().displacements.cols();
  LiteralSystem system{Eigen::MatrixXd(6 * triangles.rows(), d),
                       Eigen::VectorXd(6 * triangles.rows())};
  const auto edge = [&](const Eigen::Ref<const Positions>& p, Eigen::Index t, int c) {
    return Eigen::Vector3d(p.row(triangles(t, c)) - p.row(triangles(t, 0)));
  };
  const auto frame = [&](const Eigen::Ref<const Positions>& p, Eigen::Index t) {
    Eigen::Matrix3d u;
    u << edge(p, t, 1), edge(p, t, 2), Eigen::Vector3d::Zero();
    const Eigen::Vector3d n = u.col(0).cross(u.col(1));
    u.col(2) = n / std::sqrt(n.norm());
    return u;
  };
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Matrix3d q = frame(pose, t) * frame(source_rest, t).inverse();
    for (int c : {1, 2}) {
      const Eigen::Index row = 6 * t + 3 * (c - 1);
      const Eigen::Vector3d v = edge(target.neutral(), t, c);
      system.b.segment<3>(row) = q * v - v;
      for (Eigen::Index j = 0; j < d; ++j) {
        const auto field = target.expressions().displacements.col(j);
        const Eigen::Map<const Positions> shape(field.data(), target.vertices(), 3);
        system.a.block<3, 1>(row, j) = edge(shape, t, c);
      }
    }
  }
  return system;
}

/// The selected triangles, written from their corner number `first`.
Triangles written_from(int first, const Triangles& triangles, const std::vector<int>& selected) {
  Triangles result(selected.size(), 3);
  for (int c = 0; c < 3; ++c) result.col(c) = triangles(selected, (first + c) % 3);
  return result;
}

TEST(BlendshapeTransfer, FoldsTheLiteralSystemExactly) {
  const Shape source = patch();
  const BlendshapeModel target = model_on(bent_patch(), 5);
  const MeshSequence poses = test::shaken(source, 4, 0.2);
  for (const EdgeSum edges : {EdgeSum::all, EdgeSum::two}) {
    const int corners = edges == EdgeSum::all ? 3 : 1;
    for (const auto& selected :
         {all_triangles(source.triangles), test::half_of(source.triangles)}) {
      const BlendshapeTransfer transfer(source.positions, target, selected, {.edges = edges});
      for (int f = 0; f < poses.frames(); ++f) {
        Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(5, 5);
        Eigen::VectorXd h = Eigen::VectorXd::Zero(5);
        for (int first = 0; first < corners; ++first) {
          const LiteralSystem literal =
              literal_system(source.positions, poses.frame(f), target,
                             written_from(first, target.triangles(), selected));
          gram += literal.a.transpose() * literal.a / corners;
          h += literal.a.transpose() * literal.b / corners;
        }
        // Sums of some hundred products of numbers of order 1: rounding is below 1e-13.
        EXPECT_LT((transfer.gram() - gram).cwiseAbs().maxCoeff(), 1e-12 * gram.norm());
        EXPECT_LT((transfer.right_hand_side(poses.frame(f)) - h).cwiseAbs().maxCoeff(),
                  1e-12 * h.norm());
      }
    }
  }
}

TEST(BlendshapeTransfer, OntoTheSameModelGivesTheSourceWeightsBack) {
  const BlendshapeModel model = model_on(patch(), 6);
  const Eigen::MatrixXd beta = random_weights(70, 6);
  const BlendshapeTransfer transfer(model.neutral(), model, all_triangles(model.triangles()));
  const Eigen::MatrixXd found = transfer.weights(model.animate(beta));
  // Normals are a nonlinear function of the pose, but they only matter off the triangle's plane.
  EXPECT_LT((found - beta).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(BlendshapeTransfer, SatisfiesTheOptimalityConditionsInEveryFrame) {
  const BlendshapeModel target = model_on(bent_patch(), 5);
  const MeshSequence poses = test::shaken(patch(), 40, 0.3);
  const BlendshapeTransfer transfer(patch().positions, target, test::half_of(target.triangles()));
  const Eigen::MatrixXd beta = transfer.weights(poses);
  for (int f = 0; f < poses.frames(); ++f) {
    EXPECT_LT(box_optimality_violation(transfer.gram(), transfer.right_hand_side(poses.frame(f)),
                                       Eigen::VectorXd::Zero(5), Eigen::VectorXd::Ones(5),
                                       beta.row(f).transpose()),
              1e-10);
  }
}

TEST(BlendshapeTransfer, NamesExpressionsThatDoNotMoveAndKeepsThemAtZero) {
  const Shape shape = patch();
  ShapeBasis basis = test::bumps(shape.positions, 4);
  basis.displacements.col(1).setZero();
  const BlendshapeModel target(test::connectivity_of(shape), shape.positions, basis);
  for (const double smoothness : {0.0, 0.1}) {
    const BlendshapeTransfer transfer(shape.positions, target, all_triangles(shape.triangles),
                                      {.smoothness = smoothness});
    EXPECT_THAT(transfer.conditions().unseen, ElementsAre("shape1"));
    const Eigen::MatrixXd beta = transfer.weights(target.animate(random_weights(12, 4)));
    EXPECT_EQ(beta.col(1), Eigen::VectorXd::Zero(12));
  }
}

TEST(BlendshapeTransfer, NamesExpressionsThatAreWeaklySeen) {
  const BlendshapeModel target = model_on(patch(), 3);
  const auto field = target.expressions().displacements.col(0);
  // The triangle at the rim of shape0's support holds a small share of its motion.
  int weakest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int t = 0; t < target.triangles().rows(); ++t) {
    double motion = 0;
    for (const int vertex : target.triangles().row(t))
      motion += field.segment<3>(3 * vertex).norm();
    if (motion > 0 && motion < least) {
      least = motion;
      weakest = t;
    }
  }
  const BlendshapeTransfer transfer(target.neutral(), target, {weakest});
  EXPECT_THAT(transfer.conditions().weakly_seen, testing::Contains("shape0"));
}

TEST(BlendshapeTransfer, ConditionIsThatOfTheGramMatrix) {
  const BlendshapeModel target = model_on(patch(), 4);
  const BlendshapeTransfer transfer(target.neutral(), target, all_triangles(target.triangles()));
  const auto values = transfer.gram().jacobiSvd().singularValues();
  EXPECT_NEAR(transfer.conditions().condition, values[0] / values[3],
              1e-9 * transfer.conditions().condition);
}

TEST(BlendshapeTransfer, SurvivesADegenerateSourceTriangle) {
  Shape source = patch();
  const BlendshapeModel target = model_on(patch(), 5);
  const auto all = all_triangles(source.triangles);
  const Eigen::MatrixXd beta = random_weights(6, 5);
  const MeshSequence clean = target.animate(beta);
  // One corner moves onto the opposite edge, in the rest pose and in all frames alike.
  const int thin = source.triangles(60, 2), a = source.triangles(60, 0),
            b = source.triangles(60, 1);
  Frames frames = clean.positions();
  Positions rest = clean.rest();
  frames.middleCols<3>(3 * thin) = (frames.middleCols<3>(3 * a) + frames.middleCols<3>(3 * b)) / 2;
  rest.row(thin) = (rest.row(a) + rest.row(b)) / 2;
  const BlendshapeTransfer transfer(rest, target, all);
  EXPECT_GE(transfer.conditions().degenerate_source_triangles, 1);
  const Eigen::MatrixXd found =
      transfer.weights(MeshSequence(clean.shared_connectivity(), frames, {}, rest));
  EXPECT_TRUE(found.allFinite());
  // Six of 128 triangles changed; a gradient without bound would throw the weights anywhere.
  EXPECT_LT((found - beta).cwiseAbs().maxCoeff(), 0.3);
}

TEST(BlendshapeTransfer, RidgePullsWeightsTowardsZero) {
  const BlendshapeModel model = model_on(patch(), 4);
  const MeshSequence take = model.animate(random_weights(10, 4));
  const auto all = all_triangles(model.triangles());
  const double plain = BlendshapeTransfer(model.neutral(), model, all).weights(take).norm();
  const double ridged =
      BlendshapeTransfer(model.neutral(), model, all, {.ridge = 0.5}).weights(take).norm();
  EXPECT_LT(ridged, plain);
}

TEST(BlendshapeTransfer, SparsityLeavesFewerWeightsAboveZero) {
  const BlendshapeModel target = model_on(bent_patch(), 6);
  const MeshSequence take = test::shaken(patch(), 30, 0.2);
  const auto all = all_triangles(target.triangles());
  const auto positive = [](const Eigen::MatrixXd& beta) { return (beta.array() > 0).count(); };
  EXPECT_LT(
      positive(BlendshapeTransfer(take.rest(), target, all, {.sparsity = 0.05}).weights(take)),
      positive(BlendshapeTransfer(take.rest(), target, all).weights(take)));
}

TEST(BlendshapeTransfer, SaysWhereTheRestPoseIsNotNeutral) {
  const BlendshapeModel model = model_on(patch(), 6);
  Eigen::MatrixXd beta = random_weights(50, 6);
  beta.row(0).setConstant(0.8);
  const MeshSequence take = model.animate(beta);
  const auto all = all_triangles(model.triangles());
  const BlendshapeTransfer right(model.neutral(), model, all);
  EXPECT_FALSE(right.rest_looks_unneutral(take, right.weights(take)));
  const MeshSequence bare = take.with_rest(take.frame(0));
  const BlendshapeTransfer wrong(bare.rest(), model, all);
  EXPECT_TRUE(wrong.rest_looks_unneutral(bare, wrong.weights(bare)));
}

TEST(BlendshapeTransfer, NamesBothVertexCounts) {
  const BlendshapeModel target = model_on(patch(), 3);
  EXPECT_THAT(
      [&] { BlendshapeTransfer(test::grid(3, 3).positions, target, {0}); },
      testing::ThrowsMessage<MismatchError>(HasSubstr("the source has 9 vertices, the target 81")));
}

TEST(BlendshapeTransfer, RefusesATriangleOutOfRange) {
  const BlendshapeModel target = model_on(patch(), 3);
  EXPECT_THROW(BlendshapeTransfer(target.neutral(), target, {1000}), std::invalid_argument);
}

TEST(BlendshapeTransfer, NamesAnOptionOutOfRange) {
  const BlendshapeModel target = model_on(patch(), 3);
  const auto with = [&](const BlendshapeTransferOptions& options) {
    return [&target, options] { BlendshapeTransfer(target.neutral(), target, {0}, options); };
  };
  using testing::ThrowsMessage;
  EXPECT_THAT(with({.ridge = -1}), ThrowsMessage<std::invalid_argument>(HasSubstr("ridge")));
  EXPECT_THAT(with({.sparsity = -1}), ThrowsMessage<std::invalid_argument>(HasSubstr("sparsity")));
  EXPECT_THAT(with({.smoothness = -1}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("smoothness")));
}

TEST(BlendshapeTransfer, RefusesPerformancesOfOtherMeshes) {
  const BlendshapeModel target = model_on(patch(), 3);
  const BlendshapeTransfer transfer(target.neutral(), target, all_triangles(target.triangles()));
  EXPECT_THROW(transfer.weights(test::shaken(test::grid(3, 3), 2, 0.1)), MismatchError);
  EXPECT_THROW(transfer.right_hand_side(test::grid(3, 3).positions), MismatchError);
}

TEST(BlendshapeTransfer, RefusesTrianglesInWhichNothingMoves) {
  Shape shape = patch();
  ShapeBasis basis{{"none"}, Eigen::MatrixXd::Zero(shape.positions.size(), 1)};
  const BlendshapeModel target(test::connectivity_of(shape), shape.positions, basis);
  for (const std::vector<int>& triangles : {std::vector{0, 1}, std::vector<int>()}) {
    EXPECT_THAT([&] { BlendshapeTransfer(shape.positions, target, triangles); },
                testing::ThrowsMessage<MismatchError>(
                    HasSubstr("none of the target's 1 expressions moves in the " +
                              std::to_string(triangles.size()) + " chosen triangles")));
  }
}

TEST(BlendshapeTransfer, StopsWhenAsked) {
  const BlendshapeModel model = model_on(patch(), 3);
  const BlendshapeTransfer transfer(model.neutral(), model, all_triangles(model.triangles()));
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(transfer.weights(model.animate(random_weights(40, 3)), cancelled), Cancelled);
}

TEST(BlendshapeTransfer, BendsLessWithSmoothness) {
  const BlendshapeModel model = model_on(patch(), 4);
  const MeshSequence take = model.animate(random_weights(30, 4));
  const auto all = all_triangles(model.triangles());
  const auto bend = [](const Eigen::MatrixXd& w) {
    const auto n = w.rows() - 2;
    return (w.topRows(n) - 2 * w.middleRows(1, n) + w.bottomRows(n)).norm();
  };
  EXPECT_LT(
      bend(BlendshapeTransfer(model.neutral(), model, all, {.smoothness = 0.1}).weights(take)),
      0.5 * bend(BlendshapeTransfer(model.neutral(), model, all).weights(take)));
}

}  // namespace
}  // namespace mimetra
