#include "toolkit/pipeline/target.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {
namespace {

using test::Noted;
using testing::HasSubstr;
using testing::ThrowsMessage;

class PairedTargetTest : public testing::Test {
 protected:
  const MeshSequence take_ = test::take(24);
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const Correspondence same_ = Correspondence::identity(128);

  TransferredTarget transferred(const Target& target, const TransferOptions& options,
                                const Context& context = {}) const {
    return std::move(transfer(take_, {target}, options, context).targets.front());
  }
};

TEST_F(PairedTargetTest, IdentityGivesEqualBytes) {
  for (const Space space : {Space::blendshape, Space::vertex}) {
    for (const bool full : {true, false}) {
      TransferOptions options{.full = full};
      options.analysis.count = 3;
      options.solve.space = space;
      const TransferredTarget plain = transferred({"actor", actor_}, options);
      const TransferredTarget by_pairs = transferred({"actor", actor_, same_}, options);
      EXPECT_TRUE(test::frames_of(by_pairs.solution.sequence) ==
                  test::frames_of(plain.solution.sequence));
      EXPECT_EQ(by_pairs.error.de_all, plain.error.de_all);
      EXPECT_EQ(by_pairs.error.de_region, plain.error.de_region);
      EXPECT_EQ(by_pairs.error.leak, plain.error.leak);
      EXPECT_FALSE(plain.match);
      EXPECT_TRUE(by_pairs.match);
    }
  }
}

TEST_F(PairedTargetTest, IdentityFindsTheSameHeadMotionAndGivesItBack) {
  const MeshSequence nodding = test::bare(with_motion(take_, test::nodding(24)));
  TransferOptions options{.full = true};
  options.source.head_motion = HeadMotion::joint;
  const auto plain = transfer(nodding, {{"actor", actor_}}, options);
  const auto by_pairs = transfer(nodding, {{"actor", actor_, same_}}, options);
  // Patches are held out on the source's own vertices there, and at the target's here.
  EXPECT_TRUE(test::frames_of(by_pairs.targets[0].solution.sequence) ==
              test::frames_of(plain.targets[0].solution.sequence));
  ASSERT_TRUE(by_pairs.head_motion.held_out);
  EXPECT_NEAR(by_pairs.head_motion.held_out->joint, plain.head_motion.held_out->joint, 1e-12);
}

TEST_F(PairedTargetTest, IdentityEvaluatesAlike) {
  EvaluationOptions options{.counts = {3}};
  const auto plain = evaluate(take_, {"actor", actor_}, options);
  const auto by_pairs = evaluate(take_, {"actor", actor_, same_}, options);
  ASSERT_EQ(by_pairs.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_EQ(by_pairs[i].de_all, plain[i].de_all);
    EXPECT_EQ(by_pairs[i].mpe_region, plain[i].mpe_region);
    EXPECT_EQ(by_pairs[i].triangles, plain[i].triangles);
  }
}

/// The same surface with four times the faces.
class FinerTargetTest : public PairedTargetTest {
 protected:
  FinerTargetTest() {
    const test::Shape fine = test::subdivided(test::patch());
    mesh_.emplace(test::connectivity_of(fine), fine.positions,
                  ShapeBasis{{}, Eigen::MatrixXd(fine.positions.size(), 0)});
    // Old vertices come first.
    for (const VertexIndex v : {1, 7, 9, 40, 44, 63, 71, 78}) markers_.push_back({v, v});
  }

  std::optional<BlendshapeModel> mesh_;
  std::vector<Marker> markers_;
};

TEST_F(FinerTargetTest, IsPairedByMarkersThatAreGivenOrLookedForAndFollows) {
  const MarkersBetween search = [this](const TriMesh& source, const Context&) {
    EXPECT_TRUE(source.positions == take_.rest());
    AutomaticMarkers found;
    found.markers = markers_;
    return found;
  };
  Noted noted;
  const auto looked_for = transferred({"fine", *mesh_, search}, {.full = true}, noted.context());
  const auto given = transferred({"fine", *mesh_, markers_}, {.full = true});
  ASSERT_TRUE(given.match);
  EXPECT_EQ(given.match->quality.verdict(), "good");
  EXPECT_EQ(given.match->markers, 8);
  // Of a face 8 wide whose bumps are up to 1 high.
  double farthest = 0;
  for (int f = 0; f < take_.frames(); ++f) {
    const Frames pose = given.solution.sequence->read(f, 1);
    const PositionsView result(pose.data(), mesh_->vertices(), 3);
    farthest =
        std::max(farthest, (result.topRows(81) - take_.frame(f)).rowwise().norm().maxCoeff());
  }
  EXPECT_LT(farthest, 0.15);
  EXPECT_TRUE(test::frames_of(looked_for.solution.sequence) ==
              test::frames_of(given.solution.sequence));
  ASSERT_TRUE(looked_for.match && looked_for.match->found);
  EXPECT_EQ(looked_for.match->markers, 8);
  EXPECT_FALSE(given.match->found);
  EXPECT_TRUE(noted.has(Topic::poor_match));  // eight are few
}

TEST_F(PairedTargetTest, NeedsNoMarkersWhereFacesAreTheSame) {
  const MarkersBetween search = [](const TriMesh&, const Context&) -> AutomaticMarkers {
    throw std::logic_error("nothing is to be looked for");
  };
  const auto plain = transferred({"actor", actor_}, {.full = true});
  const auto same = transferred({"actor", actor_, search}, {.full = true});
  EXPECT_TRUE(test::frames_of(same.solution.sequence) == test::frames_of(plain.solution.sequence));
  EXPECT_FALSE(same.match);
}

TEST_F(FinerTargetTest, MovesOnlyOverTheRegions) {
  TransferOptions options;
  options.given =
      GivenRegions{"regions", regions_from_vertices(81, take_.triangles(), {{30, 31, 39, 40}})};
  const auto found = transferred({"fine", *mesh_, markers_}, options);
  EXPECT_GT(found.error.de_still, 0);
  EXPECT_EQ(found.error.leak, 0);
  const Frames pose = found.solution.sequence->read(5, 1);
  const PositionsView result(pose.data(), mesh_->vertices(), 3);
  EXPECT_TRUE(result.row(0) == mesh_->neutral().row(0));
  EXPECT_GT((result.row(40) - mesh_->neutral().row(40)).norm(), 1e-3);
}

TEST_F(FinerTargetTest, HasNoAnchorOnAPartThatFollows) {
  test::Shape shape = test::subdivided(test::patch());
  const auto first = static_cast<int>(shape.positions.rows());
  shape.positions.conservativeResize(first + 3, 3);
  shape.positions.bottomRows(3) << 4, 4, -3, 5, 4, -3, 4, 5, -3;
  shape.triangles.conservativeResize(shape.triangles.rows() + 1, 3);
  shape.triangles.bottomRows(1) << first, first + 1, first + 2;
  const BlendshapeModel with_tooth(test::connectivity_of(shape), shape.positions,
                                   ShapeBasis{{}, Eigen::MatrixXd(shape.positions.size(), 0)});
  TransferOptions options{.full = true};
  options.solve.anchor = Anchor::vertex;
  options.solve.anchor_vertex = first;
  const auto work = [&] { transferred({"fine", with_tooth, markers_}, options); };
  EXPECT_EQ(test::topic_of(work), Topic::anchor_vertex);
  options.solve.anchor_vertex = 40;
  const auto held = transferred({"fine", with_tooth, markers_}, options);
  const Frames pose = held.solution.sequence->read(5, 1);
  EXPECT_LT(
      (PositionsView(pose.data(), with_tooth.vertices(), 3).row(40) - with_tooth.neutral().row(40))
          .norm(),
      1e-9);
}

TEST_F(FinerTargetTest, IsRefusedWithoutMatchAndWhereNoMarkersAreFound) {
  EXPECT_EQ(test::topic_of([this] {
              transferred({"fine", *mesh_}, {.full = true});
            }),
            Topic::other_faces);
  const MarkersBetween search = [](const TriMesh&, const Context&) -> AutomaticMarkers {
    throw MismatchError("fine.obj: no face was found");
  };
  const auto work = [&] { transferred({"fine", *mesh_, search}, {.full = true}); };
  EXPECT_EQ(test::topic_of(work), Topic::other_faces);
  EXPECT_THAT(work,
              ThrowsMessage<MismatchError>("fine: 289 vertices, expected 81 as in the source; "
                                           "fine.obj: no face was found"));
}

TEST_F(FinerTargetTest, IsToldWhenMarkersWouldFitAsOtherVertices) {
  for (Marker& marker : markers_) marker = {marker.source + 1, marker.target + 1};
  markers_.back() = {81, 79};  // beyond the source
  const auto work = [this] { transferred({"fine", *mesh_, markers_}, {.full = true}); };
  EXPECT_EQ(test::topic_of(work), Topic::shifted_markers);
  EXPECT_THAT(work, ThrowsMessage<MismatchError>(HasSubstr("fine: marker 8: vertex 81 of the "
                                                           "source")));
}

TEST_F(FinerTargetTest, IsRefusedWhereMarkersFitMuchBetterAsOtherVertices) {
  // The same surface, its 17 x 17 vertices counted in another order.
  std::vector<VertexIndex> order(289);
  for (VertexIndex v = 0; v < 289; ++v) order[v] = 17 * (v % 17) + v / 17;
  Positions positions(289, 3);
  for (VertexIndex v = 0; v < 289; ++v) positions.row(order[v]) = mesh_->neutral().row(v);
  Triangles triangles = mesh_->triangles();
  for (VertexIndex& corner : triangles.reshaped()) corner = order[corner];
  const BlendshapeModel other(
      std::make_shared<Connectivity>(Connectivity::from_triangles(289, triangles)), positions,
      ShapeBasis{{}, Eigen::MatrixXd(positions.size(), 0)});
  std::vector<Marker> markers;
  for (const Marker& marker : markers_) markers.push_back({marker.source, order[marker.target]});
  EXPECT_NO_THROW(MatchedTarget(take_, {"fine", other, markers}));
  for (Marker& marker : markers) marker = {marker.source + 1, marker.target + 1};
  const auto work = [&] { MatchedTarget(take_, {"fine", other, markers}); };
  EXPECT_EQ(test::topic_of(work), Topic::shifted_markers);
}

TEST_F(FinerTargetTest, FollowsAlikeWhereItIsInsideOut) {
  Triangles triangles = mesh_->triangles();
  triangles.col(1).swap(triangles.col(2));
  const BlendshapeModel turned(
      std::make_shared<Connectivity>(Connectivity::from_triangles(289, triangles)),
      mesh_->neutral(), ShapeBasis{{}, Eigen::MatrixXd(3 * 289, 0)});
  Noted noted;
  const auto upright = transferred({"fine", *mesh_, markers_}, {.full = true});
  const auto inside_out = transferred({"fine", turned, markers_}, {.full = true}, noted.context());
  ASSERT_EQ(noted.notes.size(), 1u);
  EXPECT_THAT(noted.notes.front().text, HasSubstr("inside out"));
  // Sums over a triangle's corners in another order: rounding.
  EXPECT_LT(
      (test::frames_of(inside_out.solution.sequence) - test::frames_of(upright.solution.sequence))
          .cwiseAbs()
          .maxCoeff(),
      1e-9);
}

TEST_F(FinerTargetTest, IsToldOfExchangedMarkersWithTheirPlaces) {
  std::swap(markers_[2].target, markers_[4].target);
  Target target{"fine", *mesh_, markers_};
  for (std::size_t i = 1; i <= markers_.size(); ++i) {
    target.marker_places.push_back("m.txt, line " + std::to_string(i));
  }
  Noted noted;
  const MatchedTarget matched(take_, target, {}, noted.context());
  EXPECT_THAT(noted.notes.front().text, HasSubstr("fine: m.txt, line 3 (vertices 9 and 44) and "
                                                  "m.txt, line 5 (vertices 44 and 9) are likely "
                                                  "exchanged"));
}

TEST_F(PairedTargetTest, NotesAPoorCorrespondence) {
  Correspondence far = same_;
  far.residuals.setConstant(5);
  Noted noted;
  const MatchedTarget matched(take_, {"actor", actor_, far}, {}, noted.context());
  EXPECT_TRUE(noted.has(Topic::poor_match));
}

TEST_F(PairedTargetTest, RefusesACorrespondenceWithoutPairs) {
  Correspondence none;
  none.source_triangles = 128;
  none.offsets.assign(129, 0);
  none.residuals = Eigen::VectorXd::Zero(128);
  EXPECT_THAT(
      [&] {
        MatchedTarget(take_, {"actor", actor_, none});
      },
      ThrowsMessage<MismatchError>("actor: no triangle has a partner in the source"));
}

TEST_F(PairedTargetTest, FacesInAnotherOrderOrWoundTheOtherWayAreTheSame) {
  Triangles turned = actor_.triangles().colwise().reverse();
  turned.col(1).swap(turned.col(2));
  const BlendshapeModel other(
      std::make_shared<const Connectivity>(Connectivity::from_triangles(actor_.vertices(), turned)),
      actor_.neutral(), actor_.expressions());
  for (const Space space : {Space::blendshape, Space::vertex}) {
    TransferOptions options;
    options.analysis.count = 3;
    options.solve.space = space;
    const TransferredTarget plain = transferred({"actor", actor_}, options);
    Noted noted;
    const TransferredTarget same = transferred({"actor", other}, options, noted.context());
    EXPECT_LT((test::frames_of(same.solution.sequence) - test::frames_of(plain.solution.sequence))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    EXPECT_NEAR(same.error.de_all, plain.error.de_all, 1e-12);
    EXPECT_EQ(same.error.flipped, plain.error.flipped);
    EXPECT_FALSE(same.match);
    // It is written as it was.
    EXPECT_EQ(same.solution.sequence->connectivity().polygons, other.connectivity().polygons);
    const auto says_so = [](const Note& note) {
      return note.text.find("in another order, wound the other way") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(noted.notes, says_so));
  }
}

/// Four quads around a vertex and two triangles above, of which left and right are alike, on a bowl
/// that falls to one side.
struct SymmetricQuads {
  TriMesh mesh{Positions(10, 3), Connectivity::from_polygons(10, {{0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7,
                                                                   6, 4, 5, 8, 7, 6, 7, 9, 7, 8, 9},
                                                                  {0, 4, 8, 12, 16, 19, 22}})};

  SymmetricQuads() {
    for (int v = 0; v < 10; ++v) {
      const int x = v < 9 ? v % 3 - 1 : 0, y = v / 3 - 1;
      mesh.positions.row(v) << x, y, 0.5 * (x * x + y * y) + 0.2 * y;
    }
  }

  /// With its faces wound the other way.
  BlendshapeModel turned(const Positions& positions) const {
    Polygons polygons = mesh.connectivity.polygons;
    for (int f = 0; f < polygons.size(); ++f) {
      std::reverse(polygons.corners.begin() + polygons.offsets[f],
                   polygons.corners.begin() + polygons.offsets[f + 1]);
    }
    return {std::make_shared<const Connectivity>(Connectivity::from_polygons(10, polygons)),
            positions,
            {}};
  }
};

TEST(HasFacesOf, TakesTurnedQuadsOfASymmetricMeshWhereTheyAre) {
  const SymmetricQuads quads;
  EXPECT_TRUE(has_faces_of(quads.mesh, quads.turned(2 * quads.mesh.positions)));
  // Seen from the other side they are turned the same way as the source's.
  const Positions mirrored = quads.mesh.positions * Eigen::Vector3d(-1, 1, 1).asDiagonal();
  EXPECT_FALSE(has_faces_of(quads.mesh, quads.turned(mirrored)));
}

TEST(HasFacesOf, TakesTheTrianglesOfQuads) {
  const SymmetricQuads quads;
  const BlendshapeModel cut(std::make_shared<const Connectivity>(Connectivity::from_triangles(
                                10, quads.mesh.connectivity.triangles)),
                            quads.mesh.positions, {});
  EXPECT_TRUE(has_faces_of(quads.mesh, cut));
  Triangles other = quads.mesh.connectivity.triangles;
  other.row(0) << 0, 1, 8;
  EXPECT_FALSE(has_faces_of(
      quads.mesh, {std::make_shared<const Connectivity>(Connectivity::from_triangles(10, other)),
                   quads.mesh.positions,
                   {}}));
}

}  // namespace
}  // namespace mimetra
