#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

MorphableModel small_model() {
  const test::Shape shape = test::grid(4, 3);
  const auto n = shape.positions.size();
  return MorphableModel(
      std::make_shared<Connectivity>(Connectivity::from_triangles(12, shape.triangles)),
      shape.positions, {{"wide", "long"}, Eigen::MatrixXd::Random(n, 2)},
      {{"smile", "frown", "blink"}, Eigen::MatrixXd::Random(n, 3)});
}

/// Bytes of the eos pair for `vertices` on a strip of triangles.
struct EosBytes {
  std::string shape, expressions;
};

template <typename Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void put_matrix(std::string& bytes, const Eigen::MatrixXf& matrix) {
  put(bytes, std::int32_t(matrix.rows()));
  put(bytes, std::int32_t(matrix.cols()));
  for (const float value : matrix.reshaped()) put(bytes, value);
}

EosBytes eos_bytes(std::uint32_t version = 1, int textured = 1) {
  EosBytes bytes;
  put(bytes.shape, version);
  put_matrix(bytes.shape, Eigen::VectorXf::LinSpaced(9, 0, 8));
  put_matrix(bytes.shape, Eigen::MatrixXf::Constant(9, 2, 0.5f));
  put_matrix(bytes.shape, Eigen::Vector2f(4, 9));
  put(bytes.shape, std::uint64_t{1});
  for (const int index : {0, 1, 2}) put(bytes.shape, std::int32_t{index});
  put_matrix(bytes.shape, Eigen::MatrixXf(0, 1));
  put_matrix(bytes.shape, Eigen::MatrixXf(0, 0));
  put_matrix(bytes.shape, Eigen::MatrixXf::Zero(1, 1));
  put(bytes.shape, std::uint64_t{0});
  put(bytes.shape, std::uint64_t(textured));
  for (int i = 0; i < textured; ++i) {
    put(bytes.shape, 0.5 + 0.125 * i);
    put(bytes.shape, 0.25);
  }
  put(bytes.expressions, std::uint64_t{1});
  put(bytes.expressions, std::uint64_t{5});
  bytes.expressions += "anger";
  put_matrix(bytes.expressions, Eigen::VectorXf::Ones(9));
  return bytes;
}

class Model : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  std::string message_of(const std::function<void()>& action) {
    return test::message_of<std::exception>(action);
  }
  test::TemporaryFolder folder_;
};

TEST_F(Model, ComesBackAfterWriting) {
  const MorphableModel model = small_model();
  write_model(folder_ / "m", model);
  ASSERT_TRUE(is_model(folder_ / "m"));
  const MorphableModel found = read_model(folder_ / "m");
  EXPECT_EQ(found.mean(), model.mean());
  EXPECT_EQ(found.identities().names, (std::vector<std::string>{"long", "wide"}));
  EXPECT_EQ(found.expressions().names, (std::vector<std::string>{"blink", "frown", "smile"}));
  const Eigen::MatrixXd wide = found.identities().displacements.col(1);
  // Absolute shapes are stored: the neutral's last digits are lost on the way.
  EXPECT_LT((wide - model.identities().displacements.col(0)).cwiseAbs().maxCoeff(), 1e-15 * 8);
}

TEST_F(Model, AppearsWithItsPerformanceAndFurtherFiles) {
  const WeightTrack track{{"smile"}, Eigen::Vector2d(0, 1), Eigen::Vector2d(0, 0.04)};
  write_model(folder_ / "m", small_model(), track, {.extra = {{"landmarks68.txt", "1 = 2"}}});
  EXPECT_EQ(read_weights(folder_ / "m/performance.csv").weights, track.weights);
  EXPECT_EQ(read_file(folder_ / "m/landmarks68.txt"), "1 = 2");
}

TEST_F(Model, IsNotWrittenWhereAShapeNameCannotBeAFile) {
  for (const char* name : {"", "../up", ".hidden", "a/b"}) {
    const MorphableModel model(small_model().shared_connectivity(), small_model().mean(), {},
                               {{name}, Eigen::MatrixXd::Ones(36, 1)});
    EXPECT_THROW(write_model(folder_ / "m", model), OutputError) << name;
    EXPECT_TRUE(folder_.names().empty()) << name;
  }
}

TEST_F(Model, ConsistsOfTheFilesThatAreReadAndNotOfStrangers) {
  write_model(folder_ / "m", small_model(), {}, {.extra = {{"landmarks68.txt", "1 = 2"}}});
  std::filesystem::create_directory(folder_ / "m/renders");
  write("m/renders/strange.png", "large");
  write("m/expressions/notes.doc", "strange");
  std::filesystem::create_symlink("loop", folder_ / "m/loop");
  const auto folder = folder_ / "m";
  EXPECT_EQ(model_files(folder),
            (std::vector{folder / "neutral.ply", folder / "expressions/blink.ply",
                         folder / "expressions/frown.ply", folder / "expressions/smile.ply",
                         folder / "identities/long.ply", folder / "identities/wide.ply",
                         folder / "landmarks68.txt"}));
}

TEST_F(Model, HasItsShapesInNaturalOrder) {
  write("neutral.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::filesystem::create_directory(folder_ / "expressions");
  for (const char* name : {"pose10", "pose2", "pose1"}) {
    write("expressions/" + std::string(name) + ".obj", "v 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  const MorphableModel model = read_model(folder_.path());
  EXPECT_EQ(model.expressions().names, (std::vector<std::string>{"pose1", "pose2", "pose10"}));
}

TEST_F(Model, WithTwoShapesOfOneNameIsAnError) {
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  write("neutral.obj", mesh);
  std::filesystem::create_directory(folder_ / "targets");
  write("targets/smile.obj", mesh);
  write("targets/smile.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const auto refusal = [this] {
    return test::message_of<IoError>([this] { read_model(folder_.path()); });
  };
  EXPECT_THAT(refusal(),
              testing::HasSubstr("smile.off: is a second shape named 'smile', beside smile.obj"));
  std::filesystem::remove(folder_ / "targets/smile.off");
  write("neutral.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("a second shape named 'neutral'"));
}

TEST_F(Model, IsAFolderWithANeutralAndNeverAFile) {
  EXPECT_FALSE(is_model(folder_.path()));
  EXPECT_THROW(read_model(folder_.path()), IoError);
  EXPECT_THROW(read_model(folder_ / "missing"), IoError);
  write("neutral.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(is_model(folder_.path()));
  EXPECT_FALSE(is_model(folder_ / "neutral.obj"));
}

TEST_F(Model, OfAnotherTopologyIsAMismatch) {
  write("neutral.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  std::filesystem::create_directory(folder_ / "targets");
  write("targets/smile.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4\nf 1 4 3\n");
  EXPECT_THROW(read_model(folder_.path()), MismatchError);
}

TEST_F(Model, JsonNamesItsParts) {
  write_model(folder_ / "m", small_model());
  std::filesystem::rename(folder_ / "m/expressions", folder_ / "m/poses");
  write("m/model.json", R"({"neutral": "neutral.ply", "expressions": "poses"})");
  const MorphableModel found = read_model(folder_ / "m");
  EXPECT_EQ(found.expressions().size(), 3);
  EXPECT_EQ(found.identities().size(), 0);
  write("m/model.json", "{}");
  EXPECT_THROW(read_model(folder_ / "m"), IoError);
}

TEST_F(Model, PersonMovesTheNeutralAlongItsIdentities) {
  const MorphableModel model = small_model();
  write_model(folder_ / "m", model);
  const ModelSpec spec = ModelSpec::parse((folder_ / "m").string() + "@wide=1.5,long=-1");
  const BlendshapeModel person = read_person(spec);
  const Eigen::VectorXd moved =
      1.5 * model.identities().displacements.col(0) - model.identities().displacements.col(1);
  const Positions expected = model.mean() + Eigen::Map<const Positions>(moved.data(), 12, 3);
  EXPECT_LT((person.neutral() - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(spec.name(), "m@wide=1.5,long=-1");
}

TEST_F(Model, BlendshapesAreThePersonThatTheTextSpeaksOf) {
  write_model(folder_ / "m", small_model());
  const std::string text = (folder_ / "m").string() + "@long=0.5";
  EXPECT_EQ(read_blendshapes(text).neutral(), read_person(ModelSpec::parse(text)).neutral());
  EXPECT_EQ(read_blendshapes((folder_ / "m").string()).neutral(), read_model(folder_ / "m").mean());
}

TEST_F(Model, UnknownIdentityIsAMismatchThatSaysWhatThereIs) {
  write_model(folder_ / "m", small_model());
  const ModelSpec spec = ModelSpec::parse((folder_ / "m").string() + "@tall=1");
  EXPECT_THAT(message_of([&] { read_person(spec); }), HasSubstr("no identity 'tall'; there are 2"));
}

TEST(ModelSpec, RefusesWhatIsNoModelWithACoefficientOfEachName) {
  for (const char* text : {"m@wide", "m@wide=", "m@=1", "m@wide=1,", "m@wide=x", "m@wide=inf",
                           "m@wide=1,wide=2", "", "@wide=1", "@a.fit.json"}) {
    EXPECT_THROW(ModelSpec::parse(text), std::invalid_argument) << text;
  }
}

TEST_F(Model, FolderWithAnAtSignInItsNameWins) {
  std::filesystem::create_directory(folder_ / "m@wide=1");
  const ModelSpec spec = ModelSpec::parse((folder_ / "m@wide=1").string());
  EXPECT_EQ(spec.path, folder_ / "m@wide=1");
  EXPECT_TRUE(spec.identity.empty());
}

TEST_F(Model, IsNamedAfterItsFolderHoweverItIsWritten) {
  std::filesystem::create_directories(folder_ / "face.v2/expressions");
  const std::string path = (folder_ / "face.v2").string();
  for (const char* ending : {"", "/", "//", "/.", "/expressions/.."}) {
    EXPECT_EQ(ModelSpec::parse(path + ending).name(), "face.v2") << ending;
  }
  EXPECT_EQ(ModelSpec::parse(path + "/@wide=2").name(), "face.v2@wide=2");
}

TEST(ModelSpec, LeavesAnAtSignInAFolderAlone) {
  EXPECT_EQ(ModelSpec::parse("a@b/model").path, "a@b/model");
}

TEST_F(Model, EosPairIsScaledByStandardDeviations) {
  const EosBytes bytes = eos_bytes();
  write("sfm_shape.bin", bytes.shape);
  write("expression_blendshapes.bin", bytes.expressions);
  const MorphableModel model = read_model(folder_.path());
  EXPECT_EQ(model.vertices(), 3);
  EXPECT_EQ(model.identities().names, (std::vector<std::string>{"0", "1"}));
  EXPECT_EQ(model.identities().displacements.col(0), Eigen::VectorXd::Constant(9, 0.5 * 2));
  EXPECT_EQ(model.identities().displacements.col(1), Eigen::VectorXd::Constant(9, 0.5 * 3));
  EXPECT_EQ(model.expressions().names, (std::vector<std::string>{"anger"}));
}

TEST_F(Model, EosPairHasTheTextureOfItsVerticesWithVUp) {
  const EosBytes bytes = eos_bytes(1, 3);
  write("sfm_shape.bin", bytes.shape);
  write("expression_blendshapes.bin", bytes.expressions);
  const Connectivity faces = read_model(folder_.path()).connectivity();
  EXPECT_EQ(faces.texture.corners, faces.polygons.corners);
  ASSERT_EQ(faces.texture.coordinates.size(), 3u);
  EXPECT_EQ(faces.texture.coordinates[2], Eigen::Vector2d(0.75, 0.75));
  // Of one for three vertices it is not known whose it is.
  write("sfm_shape.bin", eos_bytes().shape);
  EXPECT_TRUE(read_model(folder_.path()).connectivity().texture.coordinates.empty());
}

TEST_F(Model, EosTextureThatIsNotFiniteIsRefused) {
  EosBytes bytes = eos_bytes();
  const double infinite = std::numeric_limits<double>::infinity();
  std::memcpy(bytes.shape.data() + bytes.shape.size() - sizeof infinite, &infinite,
              sizeof infinite);
  write("sfm_shape.bin", bytes.shape);
  write("expression_blendshapes.bin", bytes.expressions);
  EXPECT_THAT(message_of([&] { read_model(folder_.path()); }),
              HasSubstr("a number of the texture coordinates is not finite"));
}

TEST_F(Model, EosPairIsFoundByItsContentToo) {
  const EosBytes bytes = eos_bytes();
  write("expression_blendshapes.bin", bytes.expressions);
  write("another.bin", "not a model at all");
  EXPECT_FALSE(is_model(folder_.path()));
  write("my_model.bin", bytes.shape);
  EXPECT_TRUE(is_model(folder_.path()));
  EXPECT_EQ(read_model(folder_.path()).identities().size(), 2);
}

TEST_F(Model, EosPairIsNamedByItsShapeModelToo) {
  const EosBytes bytes = eos_bytes();
  write("expression_blendshapes.bin", bytes.expressions);
  write("shape.bin", bytes.shape);
  EXPECT_TRUE(is_model(folder_ / "shape.bin"));
  EXPECT_FALSE(is_model(folder_ / "expression_blendshapes.bin"));
  EXPECT_EQ(read_model(folder_ / "shape.bin").identities().size(), 2);
}

TEST_F(Model, LaterEosVersionIsRefusedByItsNumber) {
  const EosBytes bytes = eos_bytes(3);
  write("sfm_shape.bin", bytes.shape);
  write("expression_blendshapes.bin", bytes.expressions);
  EXPECT_THAT(message_of([&] { read_model(folder_.path()); }), HasSubstr("version 3"));
}

TEST_F(Model, EveryTruncatedEosFileIsAnError) {
  const EosBytes bytes = eos_bytes();
  for (std::size_t length = 0; length < bytes.shape.size(); ++length) {
    write("sfm_shape.bin", bytes.shape.substr(0, length));
    write("expression_blendshapes.bin", bytes.expressions);
    EXPECT_THROW(read_model(folder_.path()), IoError) << length;
  }
  write("sfm_shape.bin", bytes.shape);
  for (std::size_t length = 0; length < bytes.expressions.size(); ++length) {
    write("expression_blendshapes.bin", bytes.expressions.substr(0, length));
    EXPECT_THROW(read_model(folder_.path()), IoError) << length;
  }
}

TEST_F(Model, EosCountBeyondTheFileIsAnErrorBeforeAnyMemoryIsTaken) {
  EosBytes bytes = eos_bytes();
  const std::int32_t huge = std::numeric_limits<std::int32_t>::max();
  std::memcpy(bytes.shape.data() + 4, &huge, sizeof huge);
  write("sfm_shape.bin", bytes.shape);
  write("expression_blendshapes.bin", bytes.expressions);
  EXPECT_THAT(message_of([&] { read_model(folder_.path()); }), HasSubstr("ends within the mean"));
}

TEST(RealModels, HaveTheSizesTheirAuthorsState) {
  const auto folder = test::shared_path("data");
  MIMETRA_SKIP_WITHOUT(folder);
  const MorphableModel surrey = read_model(folder / "sfm");
  EXPECT_EQ(surrey.vertices(), 3448);
  EXPECT_EQ(surrey.connectivity().triangles.rows(), 6736);
  EXPECT_EQ(surrey.identities().size(), 63);
  EXPECT_EQ(surrey.expressions().size(), 6);
  const MorphableModel facecap = read_model(folder / "facecap");
  EXPECT_EQ(facecap.vertices(), 2694);
  EXPECT_EQ(facecap.connectivity().triangles.rows(), 5032);
  EXPECT_EQ(facecap.expressions().size(), 52);
  const MorphableModel ict = read_model(folder / "ict-face");
  EXPECT_EQ(ict.vertices(), 6706);
  EXPECT_EQ(ict.connectivity().polygons.size(), 6560);
  EXPECT_EQ(ict.connectivity().polygons.corners.size(), 4 * 6560);
  EXPECT_EQ(ict.expressions().size(), 53);
  EXPECT_EQ(ict.identities().size(), 10);
}

TEST_F(Model, HasItsFoldersAndItsNeutralInAnyCase) {
  const MorphableModel model = small_model();
  write_model(folder_ / "m", model);
  const auto rename = [this](const char* from, const char* to) {
    std::filesystem::rename(folder_ / "m" / from, folder_ / "m" / to);
  };
  rename("expressions", "Expressions");
  rename("identities", "IDENTITIES");
  rename("neutral.ply", "Neutral.ply");
  ASSERT_TRUE(is_model(folder_ / "m"));
  const MorphableModel found = read_model(folder_ / "m");
  EXPECT_EQ(found.expressions().size(), 3);
  EXPECT_EQ(found.identities().size(), 2);
  EXPECT_THAT(notes_on_unread(folder_ / "m"), testing::IsEmpty());
}

TEST_F(Model, SaysWhichMeshesItLeavesUnread) {
  write_model(folder_ / "m", small_model());
  std::filesystem::rename(folder_ / "m/expressions", folder_ / "m/shapes");
  EXPECT_THAT(notes_on_unread(folder_ / "m"),
              testing::ElementsAre(testing::AllOf(HasSubstr("has no expressions; shapes/ in it"),
                                                  HasSubstr("expressions/ or targets/"))));
  std::filesystem::copy_file(folder_ / "m/shapes/smile.ply", folder_ / "m/smile.ply");
  EXPECT_THAT(notes_on_unread(folder_ / "m"),
              testing::ElementsAre(HasSubstr("1 other mesh files and shapes/")));
}

TEST_F(Model, IsNotBesideItsExpressionsRestPose) {
  write_model(folder_ / "m", small_model());
  std::filesystem::copy_file(folder_ / "m/neutral.ply", folder_ / "m/expressions.rest.ply");
  EXPECT_THAT(meshes_beside_model(folder_ / "m"), testing::IsEmpty());
  std::filesystem::copy_file(folder_ / "m/neutral.ply", folder_ / "m/scan.ply");
  EXPECT_THAT(
      meshes_beside_model(folder_ / "m"),
      testing::ElementsAre(testing::Property(&std::filesystem::path::filename, "scan.ply")));
}

TEST_F(Model, WithExpressionsSaysWhichMeshesItLeavesUnread) {
  namespace fs = std::filesystem;
  write_model(folder_ / "m", small_model());
  for (const char* other : {"expressions/upper", "Targets", "frames"}) {
    fs::create_directory(folder_ / "m" / other);
    fs::copy_file(folder_ / "m/expressions/smile.ply", folder_ / "m" / other / "grin.ply");
  }
  EXPECT_THAT(notes_on_unread(folder_ / "m"),
              testing::ElementsAre(HasSubstr("meshes of expressions/upper/ and Targets/ are not "
                                             "read; expressions are the files in expressions/")));
}

TEST_F(Model, WithoutExpressionsIsDrivenByNoWeightsAndNamesTheFolderThatIsNotRead) {
  write_model(folder_ / "m", small_model());
  std::filesystem::rename(folder_ / "m/expressions", folder_ / "m/blendshapes");
  write_bytes(folder_ / "w.csv", "smile\n0.5\n");
  EXPECT_THAT(test::message_of<MismatchError>([this] {
                open_sequence((folder_ / "m").string(), {.weights = folder_ / "w.csv"});
              }),
              testing::AllOf(HasSubstr("w.csv: drives nothing"), HasSubstr("blendshapes/ in it")));
}

}  // namespace
}  // namespace mimetra
