#include "toolkit/transfer/region_selection.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "tests/transfer/faces.h"
#include "toolkit/regions/discs.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A performance of five bumps on a patch, for another identity with three of its own.
class RegionSelectionTest : public testing::Test {
 protected:
  static constexpr int kExpressions = 3, kFrames = 7;
  static constexpr double kNoise = 10;

  std::vector<Disc> discs(double radius = 0.5, int count = 30) const {
    const Positions& rest = take_.rest();
    return farthest_discs(
        rest, take_.triangles(),
        SurfaceDistances(rest, take_.triangles(), Weld::none(static_cast<int>(rest.rows()))),
        {.radius = radius, .count = count});
  }

  RegionSelection selection(const Context& context = {}) const {
    return {take_, actor_, {.noise = kNoise}, context};
  }

  static std::vector<int> joined(const std::vector<int>& some, const std::vector<int>& more) {
    std::set<int> all(some.begin(), some.end());
    all.insert(more.begin(), more.end());
    return {all.begin(), all.end()};
  }

  static std::vector<int> triangles_of(const std::vector<Disc>& discs,
                                       const std::vector<int>& chosen) {
    std::vector<int> triangles;
    for (const int disc : chosen) triangles = joined(triangles, discs[disc].triangles);
    return triangles;
  }

  const MeshSequence take_ =
      test::model_on(test::patch(), 5).animate(test::random_weights(kFrames, 5));
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), kExpressions);
  const std::vector<int> all_ = all_triangles(actor_.triangles());
};

/// The two edges of a triangle by which eq. 10 over all three edges is a sum of squares.
Edges weighed_edges(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                    int t) {
  return edges_of(positions, triangles, t) * edge_factor(EdgeSum::all);
}

/// A and b of eq. 11 for one triangle, written out.
struct LiteralRows {
  LiteralRows(const MeshSequence& take, const BlendshapeModel& actor, int t)
      : a(6, actor.expressions().size()), b(6, take.frames()) {
    const Triangles& triangles = actor.triangles();
    for (int j = 0; j < a.cols(); ++j) {
      const Eigen::VectorXd& column = actor.expressions().displacements.col(j);
      const PositionsView field(column.data(), actor.vertices(), 3);
      a.col(j) = weighed_edges(field, triangles, t).reshaped();
    }
    const Eigen::Matrix3d rest_inverse = triangle_frame(take.rest(), triangles, t).inverse();
    for (int f = 0; f < b.cols(); ++f) {
      const Eigen::Matrix3d q = triangle_frame(take.frame(f), triangles, t) * rest_inverse;
      const Edges edges = weighed_edges(actor.neutral(), triangles, t);
      b.col(f) = (q * edges - edges).reshaped();
    }
  }

  Eigen::MatrixXd a, b;
};

/// J as it is written: dense matrices over all triangles, an inverse, and a symmetric root.
class LiteralCriterion {
 public:
  LiteralCriterion(const MeshSequence& take, const BlendshapeModel& actor, double noise)
      : frames_(take.frames()), noise_(noise) {
    const std::vector<int> all = all_triangles(actor.triangles());
    const Eigen::MatrixXd beta = BlendshapeTransfer(take.rest(), actor, all).weights(take);
    const Eigen::Index d = actor.expressions().size();
    g_ = Eigen::MatrixXd::Zero(d, d);
    double squares = 0;
    for (const int t : all) {
      const LiteralRows rows(take, actor, t);
      const Eigen::MatrixXd r = rows.b - rows.a * beta.transpose();
      squares += r.squaredNorm();
      gram_.emplace_back(rows.a.transpose() * rows.a);
      rest_.emplace_back(rows.a.transpose() * r);
      g_ += gram_.back();
    }
    root_ = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(g_).operatorSqrt();
    variance_ = squares / static_cast<double>(6 * all.size() * frames_);
  }

  double operator()(const std::vector<int>& chosen) const {
    const Eigen::Index d = g_.rows();
    Eigen::MatrixXd g_l =
        1e-6 * g_.trace() / static_cast<double>(d) * Eigen::MatrixXd::Identity(d, d);
    Eigen::MatrixXd h_l = Eigen::MatrixXd::Zero(d, frames_);
    for (const int t : chosen) {
      g_l += gram_[t];
      h_l += rest_[t];
    }
    const Eigen::MatrixXd inverse = g_l.inverse();
    return (root_ * inverse * h_l).squaredNorm() / frames_ +
           noise_ * variance_ * (inverse * g_).trace();
  }

 private:
  int frames_;
  double noise_, variance_ = 0;
  /// A^T A and A^T r of each triangle.
  std::vector<Eigen::MatrixXd> gram_, rest_;
  Eigen::MatrixXd g_, root_;
};

TEST_F(RegionSelectionTest, CriterionIsTheLiteralOne) {
  const RegionSelection selection = this->selection();
  const LiteralCriterion literal_of(take_, actor_, kNoise);
  for (const std::vector<int>& chosen :
       {all_, test::half_of(actor_.triangles()), discs()[4].triangles, std::vector<int>{}}) {
    const double literal = literal_of(chosen);
    // The ridge keeps the condition number below 1e7, so that an inverse keeps nine digits.
    EXPECT_NEAR(selection.criterion(chosen), literal, 1e-8 * literal);
  }
}

TEST_F(RegionSelectionTest, IsTheLiteralGreedySearch) {
  const std::vector<Disc> discs = this->discs();
  const auto all = static_cast<double>(all_.size());
  const LiteralCriterion criterion(take_, actor_, kNoise);
  for (const double share : {0.2, 0.5}) {
    std::vector<int> literal, triangles;
    while (true) {
      const double now = std::log(criterion(triangles));
      int best = -1;
      double most = 0;
      for (std::size_t d = 0; d < discs.size(); ++d) {
        const std::vector<int> with = joined(triangles, discs[d].triangles);
        const auto added = static_cast<double>(with.size() - triangles.size());
        if (added == 0 || static_cast<double>(with.size()) > share * all) continue;
        const double then = std::log(criterion(with));
        const double fall = (now - then) / added;
        if (best >= 0 && fall <= most) continue;
        best = static_cast<int>(d);
        most = fall;
      }
      if (best < 0) break;
      literal.push_back(best);
      triangles = joined(triangles, discs[best].triangles);
    }
    EXPECT_GT(literal.size(), 2U);
    EXPECT_EQ(selection().choose(discs, {.share = share}), literal);
  }
}

TEST_F(RegionSelectionTest, KeepsTheShareAndTheCount) {
  const std::vector<Disc> discs = this->discs();
  const RegionSelection selection = this->selection();
  for (const double share : {0.1, 0.33, 0.7, 1.0}) {
    const auto chosen = selection.choose(discs, {.share = share});
    EXPECT_LE(static_cast<double>(triangles_of(discs, chosen).size()),
              share * static_cast<double>(all_.size()));
    EXPECT_FALSE(chosen.empty());
    EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), chosen.size());
    const auto two = selection.choose(discs, {.share = share, .count = 2});
    EXPECT_LE(two.size(), 2U);
    EXPECT_TRUE(std::equal(two.begin(), two.end(), chosen.begin()));
  }
  EXPECT_TRUE(selection.choose(discs, {.share = 1e-3}).empty());
}

TEST_F(RegionSelectionTest, RefusesABoundOutOfRange) {
  const RegionSelection selection = this->selection();
  for (const double share : {0.0, -0.5, 1.01, std::nan("")}) {
    EXPECT_THAT([&] { selection.choose(discs(), {.share = share}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("above 0 and at most 1")));
  }
  EXPECT_THAT([&] { selection.choose(discs(), {.count = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("at least 1 disc")));
}

TEST_F(RegionSelectionTest, DoesNotDependOnThreads) {
  const std::vector<Disc> discs = this->discs();
  const Context alone = Context().with_threads(1);
  const RegionSelection one = selection(alone);
  for (const int threads : {2, 5}) {
    const Context context = Context().with_threads(threads);
    const RegionSelection several = selection(context);
    EXPECT_EQ(several.choose(discs, {}, context), one.choose(discs, {}, alone));
    EXPECT_EQ(several.criterion(all_), one.criterion(all_));
  }
}

TEST_F(RegionSelectionTest, IsTheSameOverAPairingOfTheSameFaces) {
  const auto pairing = std::make_shared<const Pairing>(
      TriMesh{take_.rest(), take_.connectivity()}, TriMesh{actor_.neutral(), actor_.connectivity()},
      Correspondence::identity(static_cast<int>(all_.size())));
  const RegionSelection paired(take_, actor_, {.noise = kNoise, .pairing = pairing});
  EXPECT_EQ(paired.choose(discs(), {.share = 0.4}), selection().choose(discs(), {.share = 0.4}));
}

TEST_F(RegionSelectionTest, ShowsNothingOfTrianglesWithoutPartner) {
  Correspondence pairs = Correspondence::identity(static_cast<int>(all_.size()));
  // The last triangle loses its partner.
  pairs.parts.pop_back();
  --pairs.offsets.back();
  const auto pairing =
      std::make_shared<const Pairing>(TriMesh{take_.rest(), take_.connectivity()},
                                      TriMesh{actor_.neutral(), actor_.connectivity()}, pairs);
  const RegionSelection paired(take_, actor_, {.noise = kNoise, .pairing = pairing});
  std::vector<int> but_last = all_;
  but_last.pop_back();
  EXPECT_EQ(paired.criterion(all_), paired.criterion(but_last));
}

TEST_F(RegionSelectionTest, ChoosesWhereNothingMoves) {
  const Frames still = take_.rest().reshaped<Eigen::RowMajor>().transpose().replicate(kFrames, 1);
  const RegionSelection selection(take_.with_frames(still), actor_);
  EXPECT_TRUE(std::isfinite(selection.criterion(all_)));
  EXPECT_FALSE(selection.choose(discs(), {.share = 0.3}).empty());
}

}  // namespace
}  // namespace mimetra
