#include <limits>

#include <gmock/gmock.h>

#include "tests/io/gltf_fixture.h"

namespace mimetra {
namespace {

using test::GltfBuilder;
using test::GltfFiles;
using test::GltfJson;
using test::moved;
using test::quarters;
using test::two_nodes;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Adds the only channel of the last animation to the one before it.
void join_last(GltfBuilder& gltf) {
  GltfJson& animations = gltf.root["animations"];
  const GltfJson last = animations.back();
  animations.erase(animations.size() - 1);
  GltfJson channel = last["channels"][0];
  channel["sampler"] = animations.back()["samplers"].size();
  animations.back()["samplers"].push_back(last["samplers"][0]);
  animations.back()["channels"].push_back(channel);
}

TEST_F(GltfFiles, ALaterClipIsLeftOutAsAWhole) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.animate(0, {0, 3}, {0, 0.5});
  gltf.animate(2, {0, 3}, {0, 0.5});
  join_last(gltf);
  gltf.root["animations"][1]["name"] = "sing";
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0, 1));
  EXPECT_EQ(sequence.frame(1).topRows(6), quarters() + moved());
  EXPECT_EQ(sequence.frame(1).bottomRows(6), sequence.rest().bottomRows(6));
  EXPECT_THAT(notes_,
              testing::Contains(AllOf(HasSubstr("left out as a whole"), HasSubstr("'sing'"))));
}

TEST_F(GltfFiles, APoseOfOneKeyDoesNotDisplaceALaterClip) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0}, {0.25});
  gltf.root["animations"][0]["name"] = "T-pose";
  gltf.animate(0, {0, 1}, {0, 1});
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 2);
  EXPECT_EQ(sequence.frame(1), quarters() + moved());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("'T-pose'")));
  gltf.root["animations"][0].erase("name");
  read(gltf.glb());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("'animations[0]'")));
  gltf.root["animations"].erase(1);
  EXPECT_EQ(read(gltf.glb()).frame(0), quarters() + 0.25 * moved());
}

TEST_F(GltfFiles, AClipThatHoldsAPoseDoesNotDisplaceOneThatMoves) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1}, {0.5, 0.5});
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.root["animations"][0]["name"] = "hold";
  gltf.root["animations"][1]["name"] = "talk";
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0, 2));
  EXPECT_EQ(sequence.frame(1), quarters() + moved());
  EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("'talk' is read"), HasSubstr(": 'hold'"))));
}

TEST_F(GltfFiles, AnObjectThatATakeHoldsStillStaysInItsTake) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.animate(2, {0, 1}, {0.5, 0.5});
  gltf.animate(0, {0, 1}, {1, 0});
  gltf.animate(2, {0, 1}, {0, 1});
  const std::vector<std::string> names = {"head A", "teeth A", "head B", "teeth B"};
  for (std::size_t a = 0; a < names.size(); ++a) gltf.root["animations"][a]["name"] = names[a];
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.frame(1).bottomRows(6), sequence.rest().bottomRows(6) + moved());
  EXPECT_THAT(notes_, testing::Contains(HasSubstr("'head A', 'teeth A' are read together")));
}

TEST_F(GltfFiles, ASplineThatLeavesEqualKeysMoves) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1}, {5, 0, 5, 5, 0, 5}, "CUBICSPLINE");
  gltf.animate(0, {0, 1}, {0, 1});
  EXPECT_GT(read(gltf.glb()).frames(), 2);
}

TEST_F(GltfFiles, AClipThatIsLeftOutNeedNotBeSound) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.animate(0, {0, 1}, {0, 1, 0});
  EXPECT_EQ(read(gltf.glb()).frame(1), quarters() + moved());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr(": 'animations[1]'")));
  // Nor where it is looked at, as the first holds still.
  GltfBuilder still = plain();
  still.animate(0, {0, 1}, {0.25, 0.25});
  still.animate(0, {0, 1}, {0, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_EQ(read(still.glb()).frame(1), quarters() + 0.25 * moved());
}

TEST_F(GltfFiles, AClipOfWhatNoSceneShowsDoesNotDisplaceOneOfWhatItShows) {
  GltfBuilder gltf = plain();
  gltf.root["nodes"].push_back({{"name", "LOD1"}, {"mesh", 0}});
  gltf.animate(1, {0, 3}, {0, 0.5});
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.animate(1, {0, 1}, {0, 1});
  join_last(gltf);
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 2);
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0, 1));
  EXPECT_EQ(sequence.frame(1), quarters() + moved());
  EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfFiles, ClipsThatAreReadTogetherAreNamed) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.animate(2, {0, 1}, {0, 1});
  gltf.animate(0, {0, 1}, {1, 0});
  const std::vector<std::string> names = {"head", "teeth", "smile"};
  for (std::size_t a = 0; a < names.size(); ++a) gltf.root["animations"][a]["name"] = names[a];
  read(gltf.glb());
  EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("'head', 'teeth' are read together"),
                                        HasSubstr(": 'smile'"))));
}

/// A channel as KHR_animation_pointer has it.
GltfJson pointing_to(const char* pointer) {
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

TEST_F(GltfFiles, APointerToANodesWeightsDrivesThem) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1}, {0, 1});
  gltf.root["extensionsRequired"] = {"KHR_animation_pointer"};
  GltfJson& target = gltf.root["animations"][0]["channels"][0]["target"];
  target = pointing_to("/nodes/0/weights");
  EXPECT_EQ(read(gltf.glb()).frame(1), quarters() + moved());
  EXPECT_TRUE(notes_.empty());
  target = pointing_to("/nodes/0/rotation");
  EXPECT_EQ(read(gltf.glb()).frames(), 1);
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("the movement of nodes is left out")));
  target = pointing_to("/materials/0/emissiveFactor");
  read(gltf.glb());
  EXPECT_TRUE(notes_.empty());
  for (const char* other : {"/meshes/0/weights", "/nodes/0/weights/0", "/nodes/7/weights"}) {
    target = pointing_to(other);
    EXPECT_EQ(read(gltf.glb()).frames(), 1);
    EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("which is left out"), HasSubstr(other))));
  }
}

TEST_F(GltfFiles, WeightsOfSeveralNodesMeetByName) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 1, 2}, {0, 0.5, 1});
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.times(), Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(sequence.frame(1).topRows(6), quarters() + 0.5 * moved());
  EXPECT_EQ(sequence.frame(2).bottomRows(6), sequence.rest().bottomRows(6) + 2 * moved());
  EXPECT_TRUE(notes_.empty());
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile"));
}

TEST_F(GltfFiles, WeightsOfOneNameThatDifferAreTwoExpressions) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 2}, {0, 0});
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.frame(1).topRows(6), quarters() + moved());
  EXPECT_EQ(sequence.frame(1).bottomRows(6), sequence.rest().bottomRows(6));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0], HasSubstr("'smile' of 'big' is 'smile_2'"));
}

TEST_F(GltfFiles, TargetsOfOneNameAreOneExpressionOfTheModelHoweverItsFileMovesThem) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 2}, {0, 0.25F});
  const BlendshapeModel face = model(gltf.glb());
  EXPECT_THAT(face.expressions().names, ElementsAre("smile"));
  write_bytes(folder_ / "w.csv", "smile\n1\n");
  const MeshSequence driven = read(gltf.glb(), {.weights = folder_ / "w.csv"});
  EXPECT_EQ(driven.frame(0).topRows(6), driven.rest().topRows(6) + moved());
  EXPECT_NE(driven.frame(0).bottomRows(6), driven.rest().bottomRows(6));
  EXPECT_TRUE(notes_.empty());
}

/// The second node shows a mesh of its own, with these targets, all alike.
GltfBuilder with_second_mesh(GltfBuilder gltf, const std::vector<std::string>& names) {
  gltf = two_nodes(std::move(gltf));
  GltfJson mesh = gltf.root["meshes"][0];
  const GltfJson target = mesh["primitives"][0]["targets"][0];
  mesh["primitives"][0]["targets"] = std::vector<GltfJson>(names.size(), target);
  mesh["extras"]["targetNames"] = names;
  gltf.root["meshes"].push_back(mesh);
  gltf.root["nodes"][2]["mesh"] = 1;
  return gltf;
}

TEST_F(GltfFiles, AMeshWithoutAMaterialDoesNotHaveThatOfTheOneBefore) {
  GltfBuilder gltf = with_second_mesh(plain(), {"smile"});
  const auto statements = [&] {
    const BlendshapeModel face = model(gltf.glb());
    std::vector<std::string> found;
    for (const FaceGroup& group : face.connectivity().groups) found.push_back(group.statement);
    return found;
  };
  gltf.root["materials"] = {{{"name", "skin"}}};
  EXPECT_THAT(statements(), ElementsAre("g face", "g big"));  // nothing has it
  gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_THAT(statements(), ElementsAre("g face", "usemtl skin", "g big", "usemtl none"));
}

TEST_F(GltfFiles, TwoTargetsOfOneNameInOneMeshAreTwoExpressionsOfTheModel) {
  GltfBuilder gltf = with_second_mesh(plain(), {"smile", "smile"});
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 2}, {0, 0, 0.25F, 1});
  const BlendshapeModel face = model(gltf.glb());
  EXPECT_THAT(face.expressions().names, ElementsAre("smile", "smile_3"));
  const Positions first = face.pose(Eigen::Vector2d(1, 0)),
                  second = face.pose(Eigen::Vector2d(0, 1));
  const Positions own = (face.pose(Eigen::Vector2d(1, 1)) - face.neutral()).bottomRows(6);
  EXPECT_LT(((first - face.neutral()).bottomRows(6) - own / 2).norm(), 1e-12);
  EXPECT_LT(((second - face.neutral()).bottomRows(6) - own / 2).norm(), 1e-12);
}

TEST_F(GltfFiles, ATargetKeepsItsNameWhateverAnotherOneIsCalledInATake) {
  GltfBuilder gltf = with_second_mesh(plain(), {"smile", "smile_2"});
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 2}, {0, 0, 0.25F, 1});
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile", "smile_2"));
}

TEST_F(GltfFiles, StepsBesideCurvesWithFramesOfTheirOwnAddNone) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1.F / 24, 2.F / 24, 3.F / 24, 4.F / 24}, {0, 0.1F, 0.3F, 0.4F, 1});
  gltf.animate(2, {0, 2.F / 24, 4.F / 24}, {0, 1, 0}, "STEP");
  EXPECT_EQ(read(gltf.glb()).frames(), 5);
}

TEST_F(GltfFiles, WeightsThatStayAreSaidToBeMissingFromTheNeutral) {
  GltfBuilder gltf = plain();
  gltf.root["meshes"][0]["weights"] = {0.5};
  EXPECT_EQ(read(gltf.glb()).frame(0), quarters() + 0.5 * moved());
  EXPECT_TRUE(notes_.empty());  // the frame has them
  write_bytes(folder_ / "w.csv", "smile\n0\n");
  EXPECT_EQ(read(gltf.glb(), {.weights = folder_ / "w.csv"}).frame(0), quarters());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("its neutral is without weights that the file shows: "
                                            "'smile' at 0.5")));
}

TEST_F(GltfFiles, StepsStayUntilTheirNextKey) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1, 1 + 1.f / 30, 2}, {0, 1, 0.5F, 0.5F}, "STEP");
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 5);
  EXPECT_NEAR(sequence.times()[1], 29. / 30, 1e-6);
  EXPECT_EQ(sequence.frame(1), quarters());
  EXPECT_EQ(sequence.times()[2], 1);
  EXPECT_EQ(sequence.frame(2), quarters() + moved());
  EXPECT_EQ(sequence.frame(3), sequence.frame(4));
}

TEST_F(GltfFiles, ATargetThatATakeLeavesStillIsPartOfTheModelsExpression) {
  for (const int animated : {0, 2}) {
    GltfBuilder gltf = two_nodes(plain());
    gltf.animate(animated, {0, 2}, {0, 1});
    const MeshSequence take = read(gltf.glb());
    const auto moves = [](const MeshSequence& sequence, int frame) -> std::vector<bool> {
      const Positions motion = sequence.frame(frame) - sequence.rest();
      return {!motion.topRows(6).isZero(0), !motion.bottomRows(6).isZero(0)};
    };
    EXPECT_THAT(moves(take, 1), ElementsAre(animated == 0, animated == 2));
    EXPECT_THAT(notes_, ElementsAre(AllOf(
                            HasSubstr("one expression of the model"),
                            HasSubstr(animated == 0 ? "'smile' of 'big'" : "'smile' of 'face'"))));
    const BlendshapeModel face = model(gltf.glb());
    EXPECT_THAT(face.expressions().names, ElementsAre("smile"));
    write_bytes(folder_ / "w.csv", "smile\n1\n");
    const MeshSequence driven = read(gltf.glb(), {.weights = folder_ / "w.csv"});
    EXPECT_THAT(moves(driven, 0), ElementsAre(true, true));
    EXPECT_EQ(driven.frame(0), face.pose(Eigen::VectorXd::Ones(1)));
    EXPECT_TRUE(notes_.empty());
  }
}

TEST_F(GltfFiles, CurvesThatRoundingPartsAreOneExpression) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 0.1F, 0.2F, 0.3F}, {0, 0.1F, 0.2F, 0.3F});
  gltf.animate(2, {0, 0.3F}, {0, 0.3F});  // without the keys that lie on its line
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.frames(), 4);
  EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfFiles, KeysThatRoundingPartsAreOneFrame) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {1, 2, 3}, {0, 0.5F, 1}, "STEP");
  gltf.animate(2, {1 + 1e-6F, 2 + 1e-6F, 3 + 1e-6F}, {0, 0.5F, 1}, "STEP");
  const MeshSequence sequence = read(gltf.glb());
  // Each step stays for one more frame.
  ASSERT_EQ(sequence.frames(), 5);
  EXPECT_EQ(sequence.times()({0, 2, 4}), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(sequence.frame(1).bottomRows(6), sequence.rest().bottomRows(6));
  EXPECT_EQ(sequence.frame(2).bottomRows(6), sequence.rest().bottomRows(6) + moved());
  EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfFiles, KeysOfOneCurveStayHoweverCloseTheyAre) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {1, 1 + 1e-6F, 2}, {0, 1, 1});
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 3);
  EXPECT_EQ(sequence.frame(0), quarters());
  EXPECT_EQ(sequence.frame(1), quarters() + moved());
}

TEST_F(GltfFiles, TargetsWithoutNamesThatMeetByNumberAreSaid) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.root["meshes"][0].erase("extras");
  read(gltf.glb());
  EXPECT_TRUE(notes_.empty());  // one mesh, twice
  gltf.root["meshes"].push_back(gltf.root["meshes"][0]);
  gltf.root["nodes"][2]["mesh"] = 1;
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("target_000"));
  read(gltf.glb());
  EXPECT_THAT(notes_,
              ElementsAre(AllOf(HasSubstr("targets without names"), HasSubstr("'face', 'big'"))));
}

TEST_F(GltfFiles, ATargetWithoutANameAmongNamedOnesMeetsByNumberToo) {
  GltfBuilder gltf = two_nodes(plain());
  GltfJson& mesh = gltf.root["meshes"][0];
  mesh["primitives"][0]["targets"].push_back(mesh["primitives"][0]["targets"][0]);
  mesh["extras"]["targetNames"] = {"smile", ""};
  gltf.root["meshes"].push_back(mesh);
  gltf.root["nodes"][2]["mesh"] = 1;
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile", "target_001"));
  read(gltf.glb());
  EXPECT_THAT(notes_,
              ElementsAre(AllOf(HasSubstr("targets without names"), HasSubstr("'face', 'big'"))));
}

TEST_F(GltfFiles, WeightsThatStayAndDifferAreSaidToDoSo) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.root["nodes"][0]["weights"] = {0.5};
  gltf.root["nodes"][2]["weights"] = {0.0};
  EXPECT_EQ(read(gltf.glb()).frame(0).topRows(6), quarters() + 0.5 * moved());
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0],
              AllOf(HasSubstr("in several meshes, whose weights differ"),
                    HasSubstr("'smile' of 'big' is 'smile_2'"), testing::Not(HasSubstr("take"))));
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile"));
}

TEST_F(GltfFiles, KeysOfATimeOfDayAreFramesOfTheirOwn) {
  // Single precision counts 256ths of a second there: about four of them are a frame.
  std::vector<float> times;
  times.reserve(60);
  for (int key = 0; key < 60; ++key) times.push_back(static_cast<float>(36000 + key / 60.));
  GltfBuilder gltf = two_nodes(plain());
  std::vector<float> weights(60, 0), half_times, half_weights(30, 1);
  for (int key = 0; key < 60; key += 2) half_times.push_back(times[static_cast<std::size_t>(key)]);
  for (std::size_t key = 1; key < 60; key += 2) weights[key] = 1;
  gltf.animate(0, half_times, half_weights, "STEP");
  gltf.animate(2, times, weights, "STEP");
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 60);
  for (int f = 0; f < 60; ++f) {
    EXPECT_EQ(sequence.frame(f).topRows(6), quarters() + moved());
    EXPECT_EQ(sequence.frame(f).bottomRows(6),
              sequence.rest().bottomRows(6) + 2.0 * (f % 2) * moved());
  }
}

}  // namespace
}  // namespace mimetra
