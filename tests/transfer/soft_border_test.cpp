#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/vertex_transfer.h"

/// Regions whose border fades.
namespace mimetra {
namespace {

using test::bent_patch;
using test::both;
using test::only_frame;
using test::patch;
using test::Shape;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// 1 within 2 of the patch's middle, 0 from 4 on.
Eigen::VectorXd faded_disc(const Positions& rest) {
  Eigen::VectorXd weights(rest.rows());
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const double t = ((rest.row(v).head<2>() - rest.row(40).head<2>()).norm() - 2) / 2;
    weights[v] = std::clamp(1 - t, 0.0, 1.0);
  }
  return weights;
}

std::vector<int> with_weight(const Triangles& triangles, const Eigen::VectorXd& weights) {
  std::vector<int> rows;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (weights(triangles.row(t)).maxCoeff() > 0) rows.push_back(t);
  }
  return rows;
}

/// The displacement gradient of a triangle in its plane as a map of displacements: 3 x N, zero but
/// for its corners.
Eigen::MatrixXd gradient_rows(const Positions& rest, const Triangles& triangles, int t) {
  const Edges edges = edges_of(rest, triangles, t);
  const Eigen::Matrix<double, 3, 2> dual = edges * (edges.transpose() * edges).inverse();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, rest.rows());
  rows.col(triangles(t, 0)) -= dual.rowwise().sum();
  rows.col(triangles(t, 1)) += dual.col(0);
  rows.col(triangles(t, 2)) += dual.col(1);
  return rows;
}

/// What the headers of SoftBorder and VertexTransfer say, by dense least squares. Vertices of
/// weight 0 stay.
Positions literal_fade(const MeshSequence& pose, const Positions& target,
                       const Eigen::VectorXd& weights) {
  const Triangles& triangles = pose.triangles();
  const auto m = static_cast<int>(triangles.rows());
  std::vector<Eigen::MatrixXd> gradients, shares(m, Eigen::MatrixXd::Zero(3, 3));
  Eigen::VectorXd phi(m), slope(m), area(m), b(m);
  for (int t = 0; t < m; ++t) {
    gradients.push_back(gradient_rows(target, triangles, t));
    phi[t] = weights(triangles.row(t)).mean();
    slope[t] = (gradients[t] * weights).norm();
    const Edges edges = edges_of(target, triangles, t);
    area[t] = edges.col(0).cross(edges.col(1)).norm() / 2;
    b[t] = std::min(1.0, slope[t] * diameter(target) / 2);
  }
  const double width =
      std::min(slope.dot(area) / slope.cwiseAbs2().dot(area), diameter(target) / 2);
  std::vector<Eigen::MatrixXd> left, right;
  for (int t = 0; t < m; ++t) {
    if (phi[t] == 0) continue;
    const Eigen::Matrix3d q = triangle_frame(pose.frame(0), triangles, t) *
                              triangle_frame(pose.rest(), triangles, t).inverse();
    const Eigen::Vector3d normal = triangle_frame(target, triangles, t).col(2).normalized();
    const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const double root = std::sqrt(std::pow(SoftBorder::kSlack, b[t]));
    left.push_back(root * gradients[t]);
    shares[t] = phi[t] * ((q - Eigen::Matrix3d::Identity()) * plane).transpose();
    right.push_back(root * shares[t]);
  }
  const auto neighbors = triangle_neighbors(static_cast<int>(target.rows()), triangles);
  for (int t = 0; t < m; ++t) {
    for (const int other : neighbors[t]) {
      if (other < t) continue;
      const double length = SoftBorder::kBend * width;
      const double squared = std::max(b[t], b[other]) * SoftBorder::kSlack * length * length /
                             std::sqrt(4 * area[t] * area[other]);
      left.push_back(std::sqrt(squared) * (gradients[t] - gradients[other]));
      right.push_back(std::sqrt(squared) * (shares[t] - shares[other]));
    }
  }
  std::vector<Eigen::Index> free;
  for (Eigen::Index v = 0; v < weights.size(); ++v) {
    if (weights[v] > 0) free.push_back(v);
  }
  const auto rows = static_cast<Eigen::Index>(3 * left.size());
  Eigen::MatrixXd a(rows, static_cast<Eigen::Index>(free.size())), wanted(rows, 3);
  for (std::size_t i = 0; i < left.size(); ++i) {
    a.middleRows<3>(static_cast<Eigen::Index>(3 * i)) = left[i](Eigen::all, free);
    wanted.middleRows<3>(static_cast<Eigen::Index>(3 * i)) = right[i];
  }
  Eigen::MatrixXd moved = a.colPivHouseholderQr().solve(wanted);
  const Eigen::MatrixXd source = (pose.frame(0) - pose.rest())(free, Eigen::all);
  const Eigen::VectorXd shares_of_motion = weights(free);
  const Eigen::RowVector3d shift =
      (shares_of_motion.transpose() * source - moved.colwise().sum()) / shares_of_motion.sum();
  moved += shares_of_motion * shift / std::hypot(1, shift.norm() / (0.1 * width));
  Positions result = target;
  for (std::size_t i = 0; i < free.size(); ++i) {
    result.row(free[i]) += moved.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

class SoftBorderTest : public testing::Test {
 protected:
  Frames transferred(const MeshSequence& take, const Eigen::VectorXd& weights,
                     VertexTransferOptions options = {}, const Context& context = {}) const {
    options.weights = weights;
    return VertexTransfer(take.rest(), target_, take.triangles(),
                          with_weight(take.triangles(), weights), options, context)
        .frames(take, context);
  }

  const Shape source_ = patch();
  const Positions target_ = bent_patch().positions;
  const Triangles& triangles_ = source_.triangles;
  const MeshSequence take_ = test::shaken(source_, 20, 0.2);  // more than one block of frames
  const Eigen::VectorXd disc_ = faded_disc(target_);
  const Eigen::VectorXd ones_ = Eigen::VectorXd::Ones(81);
  const Frames full_ =
      VertexTransfer(source_.positions, target_, triangles_, all_triangles(triangles_))
          .frames(take_);
};

TEST_F(SoftBorderTest, AgreesWithDenseLeastSquares) {
  const MeshSequence pose = test::shaken(source_, 1, 0.2);
  // Householder on about 700 x 40, condition number below 1e3.
  EXPECT_LT((only_frame(transferred(pose, disc_)) - literal_fade(pose, target_, disc_))
                .lpNorm<Eigen::Infinity>(),
            1e-11);
}

TEST_F(SoftBorderTest, OfAllOrNothingIsAHardOne) {
  const Eigen::VectorXd hard = (disc_.array() > 0.5).cast<double>();
  VertexTransferOptions options;
  for (const double weight : hard) options.inside.push_back(weight > 0);
  const VertexTransfer fixed(take_.rest(), target_, triangles_, with_weight(triangles_, hard),
                             options);
  EXPECT_EQ(transferred(take_, hard), fixed.frames(take_));
}

TEST_F(SoftBorderTest, OfWeightsOneIsTheFullTransferBitByBit) {
  EXPECT_EQ(transferred(take_, ones_), full_);
}

TEST_F(SoftBorderTest, OfConstantWeightsIsThatShareOfTheFullTransfer) {
  const Frames half = transferred(take_, 0.5 * ones_);
  const Eigen::RowVectorXd rest = target_.reshaped<Eigen::RowMajor>().transpose();
  const Frames expected = (full_.rowwise() - rest) * 0.5;
  EXPECT_LT(((half.rowwise() - rest) - expected).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST_F(SoftBorderTest, KeepsVerticesOfWeightZeroBitByBit) {
  const Frames frames = transferred(take_, disc_);
  int kept = 0;
  for (VertexIndex v = 0; v < 81; ++v) {
    if (disc_[v] > 0) continue;
    ++kept;
    for (Eigen::Index f = 0; f < frames.rows(); ++f) {
      EXPECT_EQ(frames.row(f).segment<3>(3 * v), target_.row(v)) << v;
    }
  }
  EXPECT_GT(kept, 10);
  EXPECT_LT(kept, 60);
}

TEST_F(SoftBorderTest, OfTheRestPoseIsTheTargetsRestPose) {
  EXPECT_EQ(only_frame(transferred(test::shaken(source_, 1, 0), disc_)), target_);
}

TEST_F(SoftBorderTest, TurnsWithTheTarget) {
  // A rigid motion of source and target carries the result along.
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto moved = [&turn](const Positions& p) {
    return Positions((p * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -2, 5));
  };
  const MeshSequence pose = test::shaken(source_, 1, 0.2);
  const Positions there = moved(pose.frame(0));
  const MeshSequence turned(pose.shared_connectivity(),
                            Eigen::Map<const Eigen::RowVectorXd>(there.data(), there.size()), {},
                            moved(pose.rest()));
  VertexTransferOptions options;
  options.weights = disc_;
  const VertexTransfer transfer(turned.rest(), moved(target_), triangles_,
                                with_weight(triangles_, disc_), options);
  EXPECT_LT((only_frame(transfer.frames(turned)) - moved(only_frame(transferred(pose, disc_))))
                .lpNorm<Eigen::Infinity>(),
            1e-11);
}

TEST_F(SoftBorderTest, ScalesWithSourceAndTarget) {
  const MeshSequence pose = test::shaken(source_, 1, 0.2);
  VertexTransferOptions options;
  options.weights = disc_;
  const VertexTransfer large(100 * source_.positions, 100 * target_, triangles_,
                             with_weight(triangles_, disc_), options);
  const MeshSequence large_pose = pose.with_frames(100 * pose.positions());
  EXPECT_LT((only_frame(large.frames(large_pose)) - 100 * only_frame(transferred(pose, disc_)))
                .lpNorm<Eigen::Infinity>(),
            1e-10);
}

TEST_F(SoftBorderTest, ReproducesALinearMotionOfAPartThatItHoldsAllOf) {
  // One connected part has weight 1, the other 0: that moves as it should, this stays.
  Shape far = patch();
  far.positions.rowwise() += Eigen::RowVector3d(20, 0, 0);
  const Shape two = both(patch(), far);
  const Eigen::Matrix3d stretch =
      (Eigen::Matrix3d() << 1.2, 0.1, 0, 0, 0.9, 0.2, 0.1, 0, 1).finished();
  const Positions pose = two.positions * stretch.transpose();
  const MeshSequence take(test::connectivity_of(two),
                          Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size()), {},
                          two.positions);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(162);
  weights.head(81).setOnes();
  VertexTransferOptions options;
  options.weights = weights;
  const Positions found = only_frame(VertexTransfer(two.positions, two.positions, two.triangles,
                                                    with_weight(two.triangles, weights), options)
                                         .frames(take));
  EXPECT_LT((found.topRows(81) - pose.topRows(81)).lpNorm<Eigen::Infinity>(), 1e-11);
  EXPECT_EQ(found.bottomRows(81), two.positions.bottomRows(81));
}

TEST_F(SoftBorderTest, LetsTheRegionMoveMoreThanAHardBorderOfTheSameVertices) {
  // A source that tilts: the middle wants that tilt, and what stays holds it back.
  Positions pose = source_.positions;
  pose.col(2).array() += 0.4 * pose.col(0).array();
  const MeshSequence take(take_.shared_connectivity(),
                          Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size()), {},
                          source_.positions);
  const Eigen::VectorXd weights = faded_disc(source_.positions);
  VertexTransferOptions soft, hard;
  soft.weights = weights;
  for (const double weight : weights) hard.inside.push_back(weight > 0);
  const auto tilt = [&](const VertexTransferOptions& options) {
    const Positions found =
        only_frame(VertexTransfer(source_.positions, source_.positions, triangles_,
                                  with_weight(triangles_, weights), options)
                       .frames(take));
    const Positions moved = found - source_.positions;
    return (moved(41, 2) - moved(39, 2)) / (source_.positions(41, 0) - source_.positions(39, 0));
  };
  EXPECT_GT(tilt(soft), tilt(hard) + 0.05);
  EXPECT_LT(tilt(soft), 0.4);
}

TEST_F(SoftBorderTest, WithoutVerticesOfWeightZeroHasTheSourcesPlace) {
  // A source that only shifts: every vertex takes its share of that, on average.
  Positions pose = source_.positions;
  pose.rowwise() += Eigen::RowVector3d(1, 2, 3);
  const MeshSequence take(take_.shared_connectivity(),
                          Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size()), {},
                          source_.positions);
  const Eigen::VectorXd weights = 0.2 + 0.8 * disc_.array();
  const Positions moved = only_frame(transferred(take, weights)) - target_;
  EXPECT_LT((moved.colwise().mean() - weights.mean() * Eigen::RowVector3d(1, 2, 3)).norm(), 1e-12);
}

TEST_F(SoftBorderTest, IsTheSameForEveryNumberOfThreads) {
  EXPECT_EQ(transferred(take_, disc_, {}, Context().with_threads(1)),
            transferred(take_, disc_, {}, Context().with_threads(3)));
}

TEST_F(SoftBorderTest, IsTheSameForAPairingOfTheSameFaces) {
  const TriMesh source{source_.positions, take_.connectivity()},
      target{target_, take_.connectivity()};
  const auto same = std::make_shared<const Pairing>(source, target, Correspondence::identity(128));
  EXPECT_EQ(transferred(take_, disc_, {.pairing = same}), transferred(take_, disc_));
}

TEST_F(SoftBorderTest, IsFiniteWithDegenerateTrianglesInTheBorder) {
  Positions target = target_;
  for (const int t : {20, 60, 100}) target.row(triangles_(t, 2)) = target.row(triangles_(t, 0));
  VertexTransferOptions options;
  options.weights = disc_;
  const VertexTransfer transfer(source_.positions, target, triangles_,
                                with_weight(triangles_, disc_), options);
  const Frames frames = transfer.frames(take_);
  EXPECT_TRUE(frames.allFinite());
  EXPECT_LT(frames.cwiseAbs().maxCoeff(), 50);  // the patch is 8 wide and moves by 0.2
}

TEST_F(SoftBorderTest, IsHardlyChangedByWeightsRoundedToBytes) {
  Eigen::VectorXd rounded = ones_;
  for (Eigen::Index v = 0; v < 81; v += 2) rounded[v] = 254.0 / 255;
  // What is asked for changes by 1 / 255; the motion is 0.2 a vertex, a few edges add up.
  EXPECT_LT((transferred(take_, rounded) - full_).lpNorm<Eigen::Infinity>(), 0.1);
}

TEST_F(SoftBorderTest, RefusesWhatContradictsTheWeights) {
  const auto with = [this](const VertexTransferOptions& options, const Eigen::VectorXd& weights) {
    return [this, options, weights] { transferred(take_, weights, options); };
  };
  EXPECT_THAT(with({.outside = Outside::identity}, disc_),
              ThrowsMessage<std::invalid_argument>(HasSubstr("outside: ")));
  EXPECT_THAT(with({.anchor = Anchor::centroid}, disc_),
              ThrowsMessage<std::invalid_argument>(HasSubstr("fixed vertices hold the mesh")));
  Eigen::VectorXd wrong = ones_;
  wrong[7] = 1.5;
  EXPECT_THAT(with({}, wrong), ThrowsMessage<std::invalid_argument>(
                                   HasSubstr("weights: that of vertex 7 is 1.5, expected 0 to 1")));
  wrong[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(with({}, wrong), ThrowsMessage<std::invalid_argument>(HasSubstr("vertex 7")));
  VertexTransferOptions few;
  few.weights = Eigen::VectorXd::Ones(80);
  EXPECT_THAT(
      [&] { VertexTransfer(source_.positions, target_, triangles_, {0}, few); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one for each of 81 vertices, found 80")));
}

TEST_F(SoftBorderTest, AllowsAnAnchorWhereNothingStays) {
  const Frames frames = transferred(take_, ones_, {.anchor = Anchor::centroid});
  const Positions first = PositionsView(frames.row(0).data(), 81, 3);
  EXPECT_LT((first - target_).colwise().mean().norm(), 1e-12);
}

/// Eq. 10 with weights of triangles, by dense least squares without bounds in the way.
TEST(WeightedFit, AgreesWithDenseLeastSquares) {
  const BlendshapeModel model = test::model_on(bent_patch(), 4);
  const MeshSequence take =
      test::model_on(patch(), 4).animate(0.3 + 0.4 * test::random_weights(3, 4).array());
  const Eigen::VectorXd weights = triangle_weights(model.triangles(), faded_disc(model.neutral()));
  std::vector<int> selected;
  for (int t = 0; t < weights.size(); ++t) {
    if (weights[t] > 0) selected.push_back(t);
  }
  const BlendshapeTransfer transfer(take.rest(), model, selected, {.triangle_weights = weights});
  const Eigen::MatrixXd beta = transfer.weights(take);
  for (int f = 0; f < 3; ++f) {
    Eigen::MatrixXd a(9 * selected.size(), 4);
    Eigen::VectorXd b(a.rows());
    for (std::size_t s = 0; s < selected.size(); ++s) {
      const auto corners = model.triangles().row(selected[s]);
      const Eigen::Matrix3d q =
          triangle_frame(take.frame(f), take.triangles(), selected[s]) *
          triangle_frame(take.rest(), take.triangles(), selected[s]).inverse();
      for (int side = 0; side < 3; ++side) {
        const int from = corners[side], to = corners[(side + 1) % 3];
        const auto row = static_cast<Eigen::Index>(9 * s + 3 * side);
        const double root = std::sqrt(weights[selected[s]]);
        const Eigen::Vector3d edge =
            (model.neutral().row(to) - model.neutral().row(from)).transpose();
        b.segment<3>(row) = root * (q * edge - edge);
        const Eigen::MatrixXd& fields = model.expressions().displacements;
        a.middleRows<3>(row) =
            root * (fields.middleRows<3>(3 * to) - fields.middleRows<3>(3 * from));
      }
    }
    const Eigen::VectorXd expected = a.colPivHouseholderQr().solve(b);
    // Only where no bound holds a weight is the unbounded minimum that of the box.
    if (expected.minCoeff() < 0 || expected.maxCoeff() > 1) continue;
    EXPECT_LT((beta.row(f).transpose() - expected).lpNorm<Eigen::Infinity>(), 1e-11) << f;
  }
  EXPECT_GT(beta.minCoeff(), 0);
  EXPECT_LT(beta.maxCoeff(), 1);
}

TEST(WeightedFit, ByWeightsOfOneIsTheUnweightedBitByBit) {
  const BlendshapeModel model = test::model_on(bent_patch(), 5);
  const MeshSequence take = test::model_on(patch(), 5).animate(test::random_weights(20, 5));
  for (const std::vector<int>& selected :
       {all_triangles(model.triangles()), test::half_of(model.triangles())}) {
    const BlendshapeTransfer plain(take.rest(), model, selected);
    const BlendshapeTransfer weighted(take.rest(), model, selected,
                                      {.triangle_weights = Eigen::VectorXd::Ones(128)});
    EXPECT_EQ(weighted.gram(), plain.gram());
    EXPECT_EQ(weighted.weights(take), plain.weights(take));
  }
}

TEST(WeightedFit, SeesAsMuchByOneSmallWeightAsByNone) {
  const BlendshapeModel model = test::model_on(patch(), 3);
  const std::vector<int> half = test::half_of(model.triangles());
  const BlendshapeTransfer plain(model.neutral(), model, half);
  for (const double weight : {0.04, 1e-6}) {
    const BlendshapeTransfer light(model.neutral(), model, half,
                                   {.triangle_weights = Eigen::VectorXd::Constant(128, weight)});
    EXPECT_EQ(light.conditions().weakly_seen, plain.conditions().weakly_seen) << weight;
    EXPECT_EQ(light.conditions().unseen, plain.conditions().unseen) << weight;
  }
}

TEST(WeightedFit, HardlySeesWhatMovesWhereWeightsAreSmall) {
  const BlendshapeModel model = test::model_on(patch(), 3);
  const std::vector<int> all = all_triangles(model.triangles());
  EXPECT_THAT(BlendshapeTransfer(model.neutral(), model, all).conditions().weakly_seen,
              testing::IsEmpty());
  // Of the three, shape0 alone moves triangle 0.
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(128, 0.01);
  weights[0] = 1;
  const BlendshapeTransfer light(model.neutral(), model, all, {.triangle_weights = weights});
  EXPECT_THAT(light.conditions().weakly_seen, testing::ElementsAre("shape1", "shape2"));
}

TEST(WeightedFit, RefusesWeightsThatAreNone) {
  const BlendshapeModel model = test::model_on(patch(), 3);
  const auto with = [&model](const Eigen::VectorXd& weights) {
    return [&model, weights] {
      BlendshapeTransfer(model.neutral(), model, {0, 1}, {.triangle_weights = weights});
    };
  };
  EXPECT_THAT(with(Eigen::VectorXd::Ones(5)),
              ThrowsMessage<std::invalid_argument>(HasSubstr("128 triangles, found 5")));
  EXPECT_THAT(with(-Eigen::VectorXd::Ones(128)),
              ThrowsMessage<std::invalid_argument>(HasSubstr("triangle_weights")));
}

}  // namespace
}  // namespace mimetra
