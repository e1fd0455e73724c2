#include "toolkit/pipeline/rig.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::Noted;
using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RigTest : public testing::Test {
 protected:
  const BlendshapeModel source_ = test::model_on(test::patch(), 4);
  const BlendshapeModel bare_ =
      BlendshapeModel(test::connectivity_of(test::bent_patch()), test::bent_patch().positions, {});

  /// One region of these vertices.
  Regions regions_of(const std::vector<bool>& inside) const {
    std::vector<VertexIndex> list;
    for (std::size_t v = 0; v < inside.size(); ++v) {
      if (inside[v]) list.push_back(static_cast<VertexIndex>(v));
    }
    return regions_from_vertices(source_.vertices(), source_.triangles(), {list});
  }

  const RiggedExpression& named(const Rig& rig, const std::string& name) const {
    return *std::ranges::find(rig.expressions, name, &RiggedExpression::name);
  }
};

TEST_F(RigTest, OfASourceOnItselfIsTheSource) {
  const BlendshapeModel twin(source_.shared_connectivity(), source_.neutral(), {});
  const Rig made = rig(source_, {"twin", twin});
  EXPECT_EQ(made.model.expressions().names, source_.expressions().names);
  // Gradients of a displacement integrate to it, but for rounding in a system of 81 vertices.
  EXPECT_LT((made.model.expressions().displacements - source_.expressions().displacements)
                .cwiseAbs()
                .maxCoeff(),
            1e-10);
  EXPECT_LT(made.missed, 1e-12);
  EXPECT_EQ(named(made, "shape0").origin, RigOrigin::transferred);
  EXPECT_EQ(named(made, "shape0").flipped, 0);
}

TEST_F(RigTest, IsTheVertexTransferOfEachExpressionWithTheRestFixed) {
  const Rig made = rig(source_, {"double", bare_});
  const auto each =
      std::make_shared<const MeshSequence>(source_.animate(Eigen::MatrixXd::Identity(4, 4)));
  const auto placed = carried(each, made.similarity);
  for (int j = 0; j < 4; ++j) {
    const auto bump = source_.expressions().displacements.col(j);
    VertexTransferOptions options;
    for (int v = 0; v < source_.vertices(); ++v) {
      options.inside.push_back(bump.segment<3>(3 * v).norm() >
                               1e-4 * bump.lpNorm<Eigen::Infinity>());
    }
    const Regions moving = regions_of(options.inside);
    const VertexTransfer transfer(placed->rest(), bare_.neutral(), bare_.triangles(),
                                  moving.triangles, options);
    const Positions pose = test::only_frame(transfer.frames(*selected(placed, {j})));
    const Eigen::VectorXd found = made.model.expressions().displacements.col(j);
    const Positions there =
        bare_.neutral() + Eigen::Map<const Positions>(found.data(), bare_.vertices(), 3);
    // Where the border lies may differ by a vertex that moves by a ten-thousandth.
    EXPECT_LT((there - pose).cwiseAbs().maxCoeff(), 1e-3);
    for (int v = 0; v < source_.vertices(); ++v) {
      if (bump.segment<3>(3 * v).norm() > 0) continue;
      EXPECT_EQ(found.segment<3>(3 * v).norm(), 0);
    }
  }
}

TEST_F(RigTest, KeepsWhatTheTargetHas) {
  ShapeBasis own = test::bumps(bare_.neutral(), 2, 17);
  own.names = {"shape2", "wink"};
  const BlendshapeModel target(bare_.shared_connectivity(), bare_.neutral(), own);
  const Rig made = rig(source_, {"double", target});
  EXPECT_THAT(made.model.expressions().names,
              testing::ElementsAre("shape0", "shape1", "shape2", "shape3", "wink"));
  EXPECT_EQ(named(made, "shape2").origin, RigOrigin::example);
  EXPECT_EQ(named(made, "wink").origin, RigOrigin::own);
  EXPECT_EQ(made.model.expressions().displacements.col(4), own.displacements.col(1));
  // The pose of the expression rounds.
  EXPECT_LT((made.model.expressions().displacements.col(2) - own.displacements.col(0))
                .cwiseAbs()
                .maxCoeff(),
            1e-13);
}

TEST_F(RigTest, KnowsWhatTheTargetHasByANameThatIsWrittenOtherwise) {
  ShapeBasis own = test::bumps(bare_.neutral(), 1, 17);
  own.names = {"Shape_2"};
  const BlendshapeModel target(bare_.shared_connectivity(), bare_.neutral(), own);
  Noted noted;
  const Rig made = rig(source_, {"double", target}, {}, {}, noted.context());
  EXPECT_THAT(made.model.expressions().names,
              testing::ElementsAre("shape0", "shape1", "shape2", "shape3"));
  EXPECT_EQ(named(made, "shape2").origin, RigOrigin::example);
  EXPECT_THAT(noted.notes,
              Contains(testing::Field(&Note::text, HasSubstr("'Shape_2' is 'shape2'"))));
}

TEST_F(RigTest, GivesEqualBytesForAnyNumberOfThreadsAndByAnIdentityOfPairs) {
  const std::vector<RigExample> examples = {
      {"shape1", Positions(bare_.neutral().array() * 1.01), 1}};
  const auto made = [&](const Target& target, int threads) {
    const Context context = Context().with_threads(threads);
    return rig(source_, target, examples, {}, context).model.expressions().displacements;
  };
  const Eigen::MatrixXd plain = made({"double", bare_}, 1);
  EXPECT_EQ(made({"double", bare_}, 3), plain);
  EXPECT_EQ(made({"double", bare_, Correspondence::identity(128)}, 2), plain);
}

TEST_F(RigTest, NotesAnExampleThatIsTheNeutral) {
  Noted noted;
  const Rig made =
      rig(source_, {"double", bare_}, {{"shape3", bare_.neutral(), 3}}, {}, noted.context());
  EXPECT_EQ(named(made, "shape3").largest, 0);
  EXPECT_THAT(noted.notes,
              Contains(testing::Field(&Note::text, HasSubstr("target's neutral: shape3"))));
}

TEST_F(RigTest, NotesFlippedTriangles) {
  Noted noted;
  Positions folded = bare_.neutral();
  folded.col(0) *= -1;
  const Rig made = rig(source_, {"double", bare_}, {{"shape3", folded, 3}}, {}, noted.context());
  EXPECT_GT(named(made, "shape3").flipped, 0);
  EXPECT_THAT(noted.notes, Contains(testing::Field(
                               &Note::text, HasSubstr("may not be usable: flipped triangles in "
                                                      "shape3"))));
}

TEST_F(RigTest, NeedsExpressionsOfTheSource) {
  EXPECT_THAT(
      [&] {
        rig(bare_, {"double", source_});
      },
      ThrowsMessage<MismatchError>(HasSubstr("the source has no expressions")));
}

}  // namespace
}  // namespace mimetra
