#include <algorithm>
#include <cstring>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/formats.h"
#include "toolkit/formats/gltf/gltf_write.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/normals.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// A sphere with two expressions; the second moves only a few vertices.
std::shared_ptr<const BlendshapeModel> smiling_sphere() {
  const TriMesh mesh = test::mesh_of(test::sphere(2));
  const Eigen::Index size = mesh.positions.size();
  ShapeBasis basis{{"smile", "blink"}, Eigen::MatrixXd::Zero(size, 2)};
  basis.displacements.col(0) = Eigen::VectorXd::LinSpaced(size, -0.1, 0.2);
  basis.displacements(7, 1) = 0.3;
  return std::make_shared<const BlendshapeModel>(
      std::make_shared<const Connectivity>(mesh.connectivity), mesh.positions, std::move(basis));
}

Animation performance() {
  Eigen::MatrixXd weights(3, 2);
  weights << 0, 0, 0.3, 0, 1, 0.7;
  return {smiling_sphere(), weights, Eigen::Vector3d(0.25, 0.75, 2)};
}

/// Frames of a grid of quads. Each quad turns about a corner.
MeshSequence quads(int frames) {
  const test::Shape grid = test::grid(4, 4);
  Polygons polygons;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      const int corner = 4 * y + x;
      polygons.corners.insert(polygons.corners.end(), {corner, corner + 1, corner + 5, corner + 4});
      polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
    }
  }
  polygons.corners.insert(polygons.corners.end(), {10, 11, 15});
  polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  Connectivity faces = Connectivity::from_polygons(16, polygons);
  Frames poses(frames, 48);
  for (int f = 0; f < frames; ++f) {
    Positions pose = grid.positions;
    for (int v = 0; v < 16; ++v) pose(v, 2) = std::sin(0.1 * f + v);
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {std::move(faces), std::move(poses)};
}

/// Within single precision of positions and displacements about 1.
constexpr double kRounded = 3e-7;

double largest_difference(const FrameSource& a, const FrameSource& b) {
  return (a.read(0, a.frames()) - b.read(0, b.frames())).cwiseAbs().maxCoeff();
}

class GltfOutputs : public testing::TestWithParam<std::string> {
 protected:
  std::filesystem::path file() const { return folder_ / ("a" + GetParam()); }

  TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(All, GltfOutputs, testing::Values(".glb", ".gltf"),
                         [](const auto& suffix) { return suffix.param.substr(1); });

TEST_P(GltfOutputs, AModelAndItsWeightsComeBackAsSuchAndAreWrittenAlike) {
  const Animation given = performance();
  write_sequence(given, file());
  const OpenSequence open = open_sequence(file().string());
  const auto& found = dynamic_cast<const Animation&>(*open.frames);
  EXPECT_EQ(found.model().expressions().names, given.model().expressions().names);
  EXPECT_EQ(found.times(), given.times());
  EXPECT_LT((found.weights() - given.weights()).cwiseAbs().maxCoeff(), kRounded);
  EXPECT_LT(largest_difference(found, given), kRounded);
  EXPECT_TRUE(found.rest_is_known());
  EXPECT_TRUE(same_faces(found.connectivity(), given.connectivity()));
  EXPECT_TRUE(open.notes.empty());
  const std::string first = read_file(file());
  write_sequence(*open_sequence(file().string()).frames, file(), {.overwrite = true});
  EXPECT_EQ(read_file(file()), first);
}

TEST_P(GltfOutputs, PosesWithoutAModelComeBack) {
  const MeshSequence given = quads(7);
  write_sequence(given, file());
  const MeshSequence found = read_sequence(file().string()).sequence;
  EXPECT_LT(largest_difference(found, given), kRounded);
  EXPECT_LT((found.times() - given.times()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_FALSE(found.rest_is_known());
  EXPECT_TRUE(same_faces(found.connectivity(), given.connectivity()));
  EXPECT_EQ(found.triangles().rows(), given.triangles().rows());
  const MeshSequence part = read_sequence(file().string(), {.frames = "2:5"}).sequence;
  EXPECT_LT(largest_difference(part, given.slice(2, 5)), kRounded);

  const Positions rest = test::grid(4, 4).positions;
  write_sequence(given.with_rest(rest), file(), {.overwrite = true});
  const MeshSequence rested = read_sequence(file().string()).sequence;
  EXPECT_TRUE(rested.rest_is_known());
  EXPECT_EQ(rested.rest(), rest);
  EXPECT_LT(largest_difference(rested, given), kRounded);
}

TEST_P(GltfOutputs, OneMeshIsAMeshWithoutTargets) {
  const MeshSequence given = quads(1);
  write_sequence(given, file());
  EXPECT_EQ(read_file(file()).find("targets"), std::string::npos);
  const MeshSequence found = read_sequence(file().string()).sequence;
  EXPECT_EQ(found.frames(), 1);
  EXPECT_FALSE(found.rest_is_known());
  EXPECT_LT(largest_difference(found, given), kRounded);
}

TEST_P(GltfOutputs, TextureComesBackWhereAVertexHasOne) {
  MeshSequence given = quads(1);
  Connectivity faces = given.connectivity();
  for (int v = 0; v < 16; ++v) {
    faces.texture.coordinates.emplace_back(0.0625 * v, 1 - 0.03125 * v);
  }
  faces.texture.corners = faces.polygons.corners;
  write_sequence(MeshSequence(faces, given.positions()), file());
  const Connectivity found = read_sequence(file().string()).sequence.connectivity();
  ASSERT_EQ(found.texture.coordinates.size(), 16U);
  EXPECT_EQ(found.texture.coordinates[5], faces.texture.coordinates[5]);
  EXPECT_EQ(found.texture.corners, found.polygons.corners);

  // A seam.
  faces.texture.coordinates.emplace_back(0.5, 0.5);
  faces.texture.corners[1] = 16;
  write_sequence(MeshSequence(faces, given.positions()), file(), {.overwrite = true});
  EXPECT_TRUE(read_sequence(file().string()).sequence.connectivity().texture.coordinates.empty());
}

TEST_P(GltfOutputs, AModelIsWrittenWithoutFrames) {
  const auto given = smiling_sphere();
  write_gltf_model(MorphableModel(*given), {}, file(), {}, {});
  const BlendshapeModel found = read_blendshapes(file().string());
  EXPECT_EQ(found.expressions().names, given->expressions().names);
  EXPECT_LT((found.expressions().displacements - given->expressions().displacements)
                .cwiseAbs()
                .maxCoeff(),
            kRounded);
  EXPECT_EQ(read_sequence(file().string()).sequence.frames(), 1);
}

TEST_P(GltfOutputs, RefuseWhatTheyCannotHold) {
  const auto refused = [&](const FrameSource& sequence) {
    const std::string message =
        message_of<MismatchError>([&] { write_sequence(sequence, file()); });
    EXPECT_TRUE(folder_.names().empty());
    return message;
  };
  const MeshSequence one = quads(1);
  const Frames many = one.positions().replicate(kMostGltfFrames + 1, 1);
  EXPECT_THAT(refused(MeshSequence(one.connectivity(), many)),
              HasSubstr("1001 frames that no model drives would be as many morph targets, expected "
                        "1000 at most; write .pc2"));
  const Frames far = quads(2).positions().array() + 1e6;
  EXPECT_THAT(refused(MeshSequence(one.connectivity(), far)),
              HasSubstr("holds single precision only"));
  const auto timed = [&](double first, double second) {
    return MeshSequence(one.connectivity(), quads(2).positions(), Eigen::Vector2d(first, second));
  };
  EXPECT_THAT(refused(timed(-1, 0)), HasSubstr("frame 0 is at -1 s, and glTF has no times below"));
  EXPECT_THAT(refused(timed(86400, 86400.001)), HasSubstr("nearer than single precision"));
  const auto person = smiling_sphere();
  ShapeBasis identities{{"wide"}, Eigen::MatrixXd::Zero(person->neutral().size(), 1)};
  const MorphableModel model(person->shared_connectivity(), person->neutral(), identities,
                             person->expressions());
  EXPECT_THAT(message_of<MismatchError>([&] { write_gltf_model(model, {}, file(), {}, {}); }),
              HasSubstr("1 identities, for which glTF has no place"));
}

TEST_P(GltfOutputs, NamesAreTextWhateverTheirBytes) {
  const auto sphere = smiling_sphere();
  ShapeBasis basis = sphere->expressions();
  basis.names = {
      "sm\xff"
      "ile",
      "a\"b\\</script>"};
  const auto model = std::make_shared<const BlendshapeModel>(sphere->shared_connectivity(),
                                                             sphere->neutral(), basis);
  write_sequence(Animation(model, Eigen::MatrixXd::Zero(1, 2)), file());
  EXPECT_EQ(read_blendshapes(file().string()).expressions().names[1], basis.names[1]);
}

TEST(GltfText, HasNormalsOfTheNeutralAndOfEachExpression) {
  const TemporaryFolder folder;
  const TriMesh mesh = test::mesh_of(test::sphere(2));
  // One expression turns all normals a little, another a few by more than 60 degrees.
  ShapeBasis basis{{"wide", "spike"}, Eigen::MatrixXd::Zero(mesh.positions.size(), 2)};
  Positions wide = Positions::Zero(mesh.positions.rows(), 3);
  wide.col(0) = 0.3 * mesh.positions.col(0);
  basis.displacements.col(0) = Eigen::Map<const Eigen::VectorXd>(wide.data(), wide.size());
  basis.displacements(3 * 7, 1) = 3;
  const BlendshapeModel model(std::make_shared<const Connectivity>(mesh.connectivity),
                              mesh.positions, basis);
  write_gltf_model(MorphableModel(model), {}, folder / "actor.gltf", {}, {});
  const auto json = nlohmann::json::parse(read_file(folder / "actor.gltf"));
  const std::string data = read_file(folder / "actor.bin");
  EXPECT_EQ(json["nodes"][0]["name"], "actor");
  EXPECT_EQ(json["meshes"][0]["name"], "actor");
  const auto& primitive = json["meshes"][0]["primitives"][0];
  const auto view = [&](const auto& of) {
    return data.data() + json["bufferViews"][of["bufferView"].template get<int>()]["byteOffset"]
                             .template get<std::size_t>();
  };
  const auto floats = [&](const auto& accessor) -> Positions {
    using Stored = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
    return Eigen::Map<const Stored>(reinterpret_cast<const float*>(view(accessor)),
                                    accessor["count"].template get<int>(), 3)
        .template cast<double>();
  };
  const auto unit = [&](const Positions& pose) -> Positions {
    return vertex_normals(pose, mesh.connectivity.triangles).rowwise().normalized();
  };
  const Positions normals = floats(json["accessors"][primitive["attributes"]["NORMAL"].get<int>()]);
  EXPECT_LT((normals - unit(mesh.positions)).cwiseAbs().maxCoeff(), 1e-6);
  for (int j = 0; j < 2; ++j) {
    const auto& accessor =
        json["accessors"][primitive["targets"][std::size_t(j)]["NORMAL"].get<int>()];
    Positions changed = normals;
    if (accessor["componentType"] == 5120) {
      const auto& sparse = accessor["sparse"];
      const char* indices = view(sparse["indices"]);
      const char* values = view(sparse["values"]);
      for (int i = 0; i < sparse["count"].get<int>(); ++i) {
        std::uint32_t v = 0;
        std::memcpy(&v, indices + 4 * i, 4);
        for (int c = 0; c < 3; ++c) {
          changed(v, c) += static_cast<signed char>(values[3 * i + c]) / 127.0;
        }
      }
    } else {
      changed += floats(accessor);
    }
    EXPECT_EQ(accessor["componentType"], j == 0 ? 5120 : 5126);
    const Positions expected = unit(model.pose(Eigen::VectorXd::Unit(2, j)));
    // Half a step of a byte, and single precision.
    EXPECT_LT((changed - expected).cwiseAbs().maxCoeff(), 0.5 / 127 + 1e-6) << j;
  }
  EXPECT_EQ(json["extensionsRequired"], nlohmann::json({"KHR_mesh_quantization"}));
}

TEST(GltfText, TextureCoordinatesStayWhereSomeFacesHaveNone) {
  TemporaryFolder folder;
  Connectivity faces = Connectivity::from_triangles(6, test::octahedron().triangles);
  Polygons& polygons = faces.polygons;
  faces.texture.corners.assign(polygons.corners.size(), -1);
  // The first face has some, the vertices of the others do where it shares them.
  for (std::size_t k = 0; k < 3; ++k) {
    faces.texture.corners[k] = static_cast<int>(k);
    faces.texture.coordinates.emplace_back(0.25, 0.125 * static_cast<double>(k));
  }
  Frames poses(1, 18);
  const Positions points = test::octahedron().positions;
  poses.row(0) = Eigen::Map<const Eigen::RowVectorXd>(points.data(), 18);
  const std::vector<int> corners = polygons.corners;
  const std::vector<Eigen::Vector2d> given = faces.texture.coordinates;
  const MeshSequence sequence(std::move(faces), poses);
  write_sequence(sequence, folder / "a.glb");
  const Connectivity found = read_sequence((folder / "a.glb").string()).sequence.connectivity();
  ASSERT_EQ(found.texture.corners.size(), corners.size());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(found.texture.coordinates[static_cast<std::size_t>(found.texture.corners[k])],
              given[k]);
  }
  // The corner opposite of the first face's: no face with texture coordinates is at its vertex.
  int farthest = 0;
  while (std::ranges::find(corners.begin(), corners.begin() + 3, farthest) != corners.begin() + 3) {
    ++farthest;
  }
  for (std::size_t k = 3; k < corners.size(); ++k) {
    if (corners[k] != farthest) continue;
    EXPECT_EQ(found.texture.coordinates[static_cast<std::size_t>(found.texture.corners[k])],
              Eigen::Vector2d(0, 0));
  }
  const Format* format = sequence_format("a.glb");
  ASSERT_NE(format, nullptr);
  EXPECT_THAT(parts_left_out(format->holds({}), sequence),
              ElementsAre("faces without texture coordinates"));
}

TEST(GltfText, TextureCoordinatesThatNoCornerHasAreNotWritten) {
  TemporaryFolder folder;
  Connectivity faces = Connectivity::from_triangles(6, test::octahedron().triangles);
  faces.texture.corners.assign(faces.polygons.corners.size(), -1);
  faces.texture.coordinates.emplace_back(0.25, 0.5);
  Frames poses(1, 18);
  const Positions points = test::octahedron().positions;
  poses.row(0) = Eigen::Map<const Eigen::RowVectorXd>(points.data(), 18);
  const MeshSequence sequence(std::move(faces), poses);
  write_sequence(sequence, folder / "a.glb");
  EXPECT_TRUE(read_sequence((folder / "a.glb").string())
                  .sequence.connectivity()
                  .texture.coordinates.empty());
  EXPECT_THAT(parts_left_out(sequence_format("a.glb")->holds({}), sequence), testing::IsEmpty());
}

/// Sparse weights take few bytes, and every target has bounds, as the specification requires.
TEST(GltfText, HoldsWhatTheSpecificationAsksFor) {
  TemporaryFolder folder;
  const int frames = 300;
  write_sequence(quads(frames), folder / "a.gltf");
  const auto json = nlohmann::json::parse(read_file(folder / "a.gltf"));
  EXPECT_EQ(json["extensionsUsed"], nlohmann::json({"FB_ngon_encoding"}));
  EXPECT_EQ(json["buffers"][0]["uri"], "a.bin");
  EXPECT_EQ(json["buffers"][0]["byteLength"], std::filesystem::file_size(folder / "a.bin"));
  // Poses of 16 vertices, and a key, a weight and its place for each.
  EXPECT_LT(std::filesystem::file_size(folder / "a.bin"), frames * (16 * 12 + 12) + 2000U);
  const auto& primitive = json["meshes"][0]["primitives"][0];
  for (const auto& target : primitive["targets"]) {
    const auto& accessor = json["accessors"][target["POSITION"].get<std::size_t>()];
    EXPECT_EQ(accessor["min"].size(), 3U);
    EXPECT_LE(accessor["min"][2], accessor["max"][2]);
    EXPECT_GT(accessor["max"][2], -2);
  }
  EXPECT_EQ(json["meshes"][0]["extras"]["targetNames"][299], "frame_0299");
}

}  // namespace
}  // namespace mimetra
