#include <map>
#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/correspondence/cut_sheet.h"
#include "tests/transfer/seamed_face.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/joint_fit.h"
#include "toolkit/transfer/region_completion.h"
#include "toolkit/transfer/seams.h"
#include "toolkit/transfer/transfer_error.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kPairedFrames = 20, kPairedExpressions = 5;

TriMesh trimesh_of(const FrameSource& source) {
  return {source.rest(), source.connectivity()};
}

TriMesh trimesh_of(const BlendshapeModel& model) {
  return {model.neutral(), model.connectivity()};
}

std::shared_ptr<const Pairing> paired(const TriMesh& source, const TriMesh& target,
                                      Correspondence pairs) {
  return std::make_shared<const Pairing>(source, target, std::move(pairs));
}

/// A performance and a target of the same faces, and their identity as a pairing.
class SamePairedTest : public testing::Test {
 protected:
  const MeshSequence take_ = test::model_on(test::patch(), kPairedExpressions)
                                 .animate(test::random_weights(kPairedFrames, kPairedExpressions));
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), kPairedExpressions);
  const std::vector<int> all_ = all_triangles(actor_.triangles());
  const std::vector<int> half_ = test::half_of(actor_.triangles());
  const std::shared_ptr<const Pairing> same_ =
      paired(trimesh_of(take_), trimesh_of(actor_), Correspondence::identity(128));
};

TEST_F(SamePairedTest, WeightsAreEqualBytes) {
  for (const std::vector<int>& selected : {all_, half_}) {
    const BlendshapeTransfer plain(take_.rest(), actor_, selected);
    const BlendshapeTransfer by_pairs(take_.rest(), actor_, selected, {.pairing = same_});
    EXPECT_TRUE(by_pairs.weights(take_) == plain.weights(take_));
  }
}

TEST_F(SamePairedTest, VerticesAreEqualBytes) {
  for (const Outside outside : {Outside::fixed, Outside::identity}) {
    for (const std::vector<int>& selected : {all_, half_}) {
      VertexTransferOptions options{.outside = outside};
      const VertexTransfer plain(take_.rest(), actor_.neutral(), actor_.triangles(), selected,
                                 options);
      options.pairing = same_;
      const VertexTransfer by_pairs(take_.rest(), actor_.neutral(), actor_.triangles(), selected,
                                    options);
      EXPECT_TRUE(by_pairs.frames(take_) == plain.frames(take_));
    }
  }
}

TEST_F(SamePairedTest, ErrorsAreEqualBytes) {
  const MeshSequence result =
      actor_.animate(test::random_weights(kPairedFrames, kPairedExpressions, 7));
  const TransferError plain = transfer_error(take_, result, half_);
  const TransferError by_pairs = transfer_error(take_, result, half_, {.pairing = same_});
  EXPECT_EQ(by_pairs.de_all, plain.de_all);
  EXPECT_EQ(by_pairs.de_region, plain.de_region);
  EXPECT_EQ(by_pairs.leak, plain.leak);
  EXPECT_EQ(by_pairs.flipped, plain.flipped);
  EXPECT_TRUE(by_pairs.per_triangle == plain.per_triangle);
}

TEST_F(SamePairedTest, HeadMotionIsEqualBytes) {
  const std::vector<RigidTransform> start(kPairedFrames);
  const HeadAndExpressions plain = JointFit(take_.rest(), actor_, all_)(take_, start);
  const HeadAndExpressions by_pairs =
      JointFit(take_.rest(), actor_, all_, {.pairing = same_})(take_, start);
  EXPECT_TRUE(by_pairs.weights == plain.weights);
  EXPECT_TRUE(by_pairs.motion.back().translation == plain.motion.back().translation);
}

TEST_F(SamePairedTest, RegionsAreCompletedAlike) {
  const Regions corner = regions_from_vertices(81, actor_.triangles(), {{0, 1, 9}});
  const auto completed_with = [&](std::shared_ptr<const Pairing> pairing) {
    DiscSearch search(take_.rest(), take_.triangles(),
                      SurfaceDistances(take_.rest(), take_.triangles(), Weld::none(81)), 1.5);
    return completed(corner, actor_, search, {.limit = 1, .pairing = std::move(pairing)});
  };
  const CompletedRegions plain = completed_with({}), by_pairs = completed_with(same_);
  EXPECT_GT(plain.added, 0);
  EXPECT_EQ(by_pairs.added, plain.added);
  EXPECT_EQ(by_pairs.regions.triangles, plain.regions.triangles);
}

TEST_F(SamePairedTest, RefusesAPairingOfAnotherSource) {
  const MeshSequence other = test::shaken(test::grid(4, 4), 2, 0.1);
  EXPECT_THAT(
      [&] { BlendshapeTransfer(other.rest(), actor_, all_, {.pairing = same_}); },
      ThrowsMessage<MismatchError>(HasSubstr("the source has 16 vertices, the target 81; in their "
                                             "pairing the source has 81 vertices, the target 81")));
}

TEST(PairedSeams, OfTheSameFacesAreTheSame) {
  const test::SeamedFace face;
  const MeshSequence take = face.with_copies(test::SeamedFace::talking(face.whole, 20, 17));
  const Pairing same(trimesh_of(take), trimesh_of(take),
                     Correspondence::identity(static_cast<int>(face.triangles.rows())));
  const Weld plain = closed_seams(take, take.rest());
  EXPECT_GT(plain.count, 0);
  EXPECT_EQ(closed_seams(take, take.rest(), face.triangles, same).representative,
            plain.representative);
}

/// A sheet whose mouth is closed at rest and opens, and the same with vertices of its own for each
/// triangle, as flat shading makes them; each triangle follows itself and its successor.
class FlatShadedTest : public testing::Test {
 protected:
  FlatShadedTest() {
    const Triangles& triangles = rest_.connectivity.triangles;
    const Eigen::Index count = triangles.rows();
    flat_.resize(count, 3);
    places_.resize(3 * count, 3);
    pairs_.source_triangles = static_cast<int>(count);
    pairs_.residuals = Eigen::VectorXd::Zero(count);
    for (int t = 0; t < count; ++t) {
      for (int c = 0; c < 3; ++c) {
        flat_(t, c) = 3 * t + c;
        places_.row(3 * t + c) = rest_.positions.row(triangles(t, c));
        original_.push_back(triangles(t, c));
      }
      const int other = t + 1 < count ? t + 1 : t - 1;
      pairs_.parts.push_back({std::min(t, other), 0.5});
      pairs_.parts.push_back({std::max(t, other), 0.5});
      pairs_.offsets.push_back(2 * (t + 1));
    }
  }

  Weld seams(const MeshSequence& source) const {
    const TriMesh target{places_,
                         Connectivity::from_triangles(static_cast<int>(places_.rows()), flat_)};
    return closed_seams(source, places_, flat_, Pairing(rest_, target, pairs_));
  }

  MeshSequence opening(double gap) const {
    Frames frames(2, rest_.positions.size());
    frames.row(0) = rest_.positions.reshaped<Eigen::RowMajor>().transpose();
    frames.row(1) = test::sheet(true, gap).positions.reshaped<Eigen::RowMajor>().transpose();
    return MeshSequence(rest_.connectivity, frames).with_rest(rest_.positions);
  }

  const TriMesh rest_ = test::sheet(true, 0);
  Triangles flat_;
  Positions places_;
  std::vector<VertexIndex> original_;  // in the source
  Correspondence pairs_;
};

TEST_F(FlatShadedTest, StaysWholeButForLips) {
  const Weld weld = seams(opening(0.01));
  std::map<VertexIndex, std::set<VertexIndex>> of_place;
  for (std::size_t v = 0; v < original_.size(); ++v) {
    of_place[original_[v]].insert(weld.representative[v]);
  }
  for (const auto& [vertex, lowest] : of_place) EXPECT_EQ(lowest.size(), 1u) << vertex;
  // The lips' middle, half of the mouth's width from its corners.
  const int lower = test::kMiddle * test::kColumns + 20, upper = test::kColumns * test::kRows + 11;
  ASSERT_TRUE(rest_.positions.row(lower) == rest_.positions.row(upper));
  EXPECT_NE(of_place[lower], of_place[upper]);
}

TEST_F(FlatShadedTest, StaysClosedWhereTheSourceNeverOpens) {
  const Weld weld = seams(opening(0));
  EXPECT_EQ(weld.representative, Weld::exact(places_).representative);
}

/// The source's vertices, faces and corners in another order.
class RenumberedSourceTest : public SamePairedTest {
 protected:
  RenumberedSourceTest() {
    std::mt19937 random(4);
    std::vector<VertexIndex> vertices(81);  // of the old source, for each new one
    std::iota(vertices.begin(), vertices.end(), 0);
    std::shuffle(vertices.begin(), vertices.end(), random);
    std::vector<VertexIndex> number(81);
    for (int v = 0; v < 81; ++v) number[vertices[v]] = v;
    std::vector<int> faces = all_;
    std::shuffle(faces.begin(), faces.end(), random);
    Triangles triangles(128, 3);
    Correspondence pairs = Correspondence::identity(128);
    for (int t = 0; t < 128; ++t) {
      for (int c = 0; c < 3; ++c) {
        triangles(t, c) = number[take_.triangles()(faces[t], (c + t) % 3)];
      }
      pairs.parts[faces[t]].triangle = t;
    }
    Frames frames(kPairedFrames, 3 * 81);
    for (int f = 0; f < kPairedFrames; ++f) {
      Eigen::Map<Positions>(frames.row(f).data(), 81, 3) = take_.frame(f)(vertices, Eigen::all);
    }
    source_.emplace(Connectivity::from_triangles(81, triangles), frames, take_.known_times(),
                    take_.rest()(vertices, Eigen::all));
    pairing_ = paired(trimesh_of(*source_), trimesh_of(actor_), std::move(pairs));
  }

  std::optional<MeshSequence> source_;
  std::shared_ptr<const Pairing> pairing_;
};

TEST_F(RenumberedSourceTest, GivesTheSameWeights) {
  const Eigen::MatrixXd plain = BlendshapeTransfer(take_.rest(), actor_, all_).weights(take_);
  const Eigen::MatrixXd found =
      BlendshapeTransfer(source_->rest(), actor_, all_, {.pairing = pairing_}).weights(*source_);
  EXPECT_LT((found - plain).lpNorm<Eigen::Infinity>(), 1e-9);  // rounding times the condition
}

TEST_F(RenumberedSourceTest, GivesTheSameVertices) {
  for (const std::vector<int>& selected : {all_, half_}) {
    const Frames plain =
        VertexTransfer(take_.rest(), actor_.neutral(), actor_.triangles(), selected).frames(take_);
    const Frames found = VertexTransfer(source_->rest(), actor_.neutral(), actor_.triangles(),
                                        selected, {.pairing = pairing_})
                             .frames(*source_);
    EXPECT_LT((found - plain).lpNorm<Eigen::Infinity>(), 1e-11);  // of a patch eight units wide
  }
}

TEST_F(RenumberedSourceTest, HasTheSameError) {
  const MeshSequence result =
      actor_.animate(test::random_weights(kPairedFrames, kPairedExpressions, 7));
  const TransferError plain = transfer_error(take_, result, half_);
  const TransferError found = transfer_error(*source_, result, half_, {.pairing = pairing_});
  EXPECT_NEAR(found.de_all, plain.de_all, 1e-12);
  EXPECT_NEAR(found.de_region, plain.de_region, 1e-12);
}

TEST(PairedGradients, AreTheMeanOfThePartnersAndTheIdentityWithoutOne) {
  const test::Shape shape = test::patch();
  Correspondence pairs;
  pairs.source_triangles = 128;
  pairs.parts = {{3, 0.25}, {90, 0.75}};
  pairs.offsets = {0, 2, 2};
  const MeshSequence take = test::shaken(shape, 1, 0.2);
  const auto found =
      DeformationGradients(shape.positions, shape.triangles, pairs, {0, 1})(take.frame(0));
  const auto each = DeformationGradients(shape.positions, shape.triangles, {3, 90})(take.frame(0));
  EXPECT_TRUE(
      found.topRows<3>().isApprox(0.25 * each.topRows<3>() + 0.75 * each.bottomRows<3>(), 1e-14));
  EXPECT_TRUE(found.bottomRows<3>().isIdentity(0));
}

TEST(PairedGradients, RefuseATriangleThatTheTargetHasNot) {
  const test::Shape shape = test::patch();
  EXPECT_THAT(
      [&] {
        DeformationGradients(shape.positions, shape.triangles, Correspondence::identity(2), {2});
      },
      ThrowsMessage<std::invalid_argument>("triangle 2 is selected, expected 0 to 1"));
}

/// A dome of n x n vertices over the unit square, and the same where a known map has bent it.
struct Dome {
  explicit Dome(int n) : shape(test::grid(n, n)) {
    shape.positions /= n - 1;
    for (int v = 0; v < shape.positions.rows(); ++v) {
      shape.positions(v, 2) = 0.3 * std::sin(3 * shape.positions(v, 0)) * shape.positions(v, 1);
    }
    bent = shape.positions;
    for (int v = 0; v < bent.rows(); ++v) {
      const double x = bent(v, 0), y = bent(v, 1);
      bent.row(v) += Eigen::RowVector3d(0.05 * std::sin(4 * y), 0.04 * x * x,
                                        0.1 * std::exp(-8 * (x - 0.5) * (x - 0.5) - y));
    }
  }

  test::Shape shape;
  Positions bent;
};

/// Largest distance from the known answer, as a share of the diagonal, on a dome of 31 x 31
/// vertices, of a motion that one of n x n vertices shows.
double distance_from_known_answer(int n) {
  const Dome source(n), target(31);
  Frames frames(1, source.bent.size());
  frames.row(0) = Eigen::Map<const Eigen::RowVectorXd>(source.bent.data(), source.bent.size());
  const MeshSequence take(test::connectivity_of(source.shape), frames, {}, source.shape.positions);
  const SurfaceFit lying{source.shape.positions,
                         std::vector<bool>(source.shape.positions.rows(), true),
                         std::vector<bool>(target.shape.positions.rows(), true)};
  const TriMesh to = test::mesh_of(target.shape);
  const auto pairing =
      paired(test::mesh_of(source.shape), to, pair_triangles(lying, source.shape.triangles, to));
  const VertexTransfer transfer(take.rest(), to.positions, to.connectivity.triangles,
                                all_triangles(to.connectivity.triangles), {.pairing = pairing});
  const Positions result = test::only_frame(transfer.frames(take));
  return (result - target.bent).rowwise().norm().maxCoeff() / box_diagonal(target.bent);
}

TEST(PairedTransfer, ApproachesTheKnownAnswerAsTheSourceIsRefined) {
  const double coarse = distance_from_known_answer(12), fine = distance_from_known_answer(42);
  // Gradients are constant on a triangle: of second order in what they are integrated to.
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, 0.5 * coarse);
}

}  // namespace
}  // namespace mimetra
