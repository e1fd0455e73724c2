// What stands in files besides positions and faces: texture coordinates, groups, materials.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/material_library.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n";
/// Texture with a seam at vertex 2, and materials.
constexpr const char* kFaces =
    "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.75 0.25\nvt 1 1\n"
    "mtllib face.mtl\no head\ng lips\nusemtl skin\nf 1/1 2/2 3/3 4/4\nusemtl teeth\nf 2/5 5/6 "
    "3/3\n";

class Attributes : public testing::Test {
 protected:
  /// A take of two OBJ files with a library and a texture in a folder of its own.
  void write_take() {
    fs::create_directories(folder_ / "take");
    fs::create_directories(folder_ / "skins");
    write_bytes(folder_ / "skins/my skin.png", "png");
    write_bytes(folder_ / "take/face.mtl",
                "newmtl skin\r\nmap_Kd -o 1 0 -bm 2 ../skins/my skin.png\r\nmap_Bump gone.png\n"
                "newmtl teeth\nKd 1 1 1\n");
    write_bytes(folder_ / "take/f_0.obj", std::string(kVertices) + kFaces);
    std::string moved = std::string(kVertices) + kFaces;
    moved.replace(moved.find("2 0 0"), 5, "3 0 0");
    write_bytes(folder_ / "take/f_1.obj", moved);
  }

  void convert(const std::string& from, const std::string& to, const WriteOptions& options = {}) {
    const auto open = open_sequence(folder_ / from);
    write_sequence(*open.frames, folder_ / to, options);
  }

  std::string text(const std::string& name) const { return read_file(folder_ / name); }

  TemporaryFolder folder_;
};

/// u and v of each corner.
std::vector<double> texture_at_corners(const fs::path& path) {
  const TextureCoordinates texture = read_mesh(path).connectivity.texture;
  std::vector<double> values;
  for (const int at : texture.corners) {
    values.push_back(at < 0 ? -1 : texture.coordinates[static_cast<std::size_t>(at)].x());
    values.push_back(at < 0 ? -1 : texture.coordinates[static_cast<std::size_t>(at)].y());
  }
  return values;
}

TEST_F(Attributes, GoFromObjToObjWithTheirLibrary) {
  write_take();
  convert("take", "out", {.frame_format = "obj"});
  EXPECT_THAT(text("out/frame_0001.obj"),
              testing::EndsWith("mtllib face.mtl\no head\ng lips\nusemtl skin\nf 1/1 2/2 3/3 4/4\n"
                                "usemtl teeth\nf 2/5 5/6 3/3\n"));
  EXPECT_EQ(text("out/face.mtl"), text("take/face.mtl"));
  // Deeper down the same texture has another way.
  convert("take", "a/b", {.frame_format = "obj"});
  EXPECT_THAT(text("a/b/face.mtl"),
              HasSubstr("-bm 2 ../../skins/my skin.png\r\nmap_Bump gone.png"));
  const auto open = open_sequence(folder_ / "take");
  EXPECT_THAT(materials_in_folder(open.frames->connectivity(), folder_ / "a/b").notes,
              ElementsAre(HasSubstr("paths lead to ../../skins/my skin.png")));
}

TEST_F(Attributes, OfASingleMeshHaveALibraryOfItsName) {
  write_take();
  convert("take/f_1.obj", "one.obj");
  EXPECT_THAT(text("one.obj"), HasSubstr("mtllib one.mtl\n"));
  EXPECT_THAT(text("one.mtl"), HasSubstr("-bm 2 skins/my skin.png\r\n"));
  // Where its library lies already, it stays.
  convert("take/f_1.obj", "take/two.obj");
  EXPECT_THAT(text("take/two.obj"), HasSubstr("mtllib face.mtl\n"));
  EXPECT_FALSE(fs::exists(folder_ / "take/two.mtl"));
}

TEST_F(Attributes, OfSeveralLibrariesGoTogether) {
  write_take();
  write_bytes(folder_ / "take/more.mtl", "newmtl teeth\nmap_Kd ../skins/my skin.png");
  write_bytes(folder_ / "take/f_2.obj",
              std::string("mtllib more.mtl face.mtl\n") + kVertices + "usemtl teeth\nf 1 2 3\n");
  const auto place = fs::current_path();
  fs::current_path(folder_ / "take");  // names without a folder
  write_sequence(*open_sequence("f_2.obj").frames, "deep/one.obj");
  fs::current_path(place);
  EXPECT_THAT(text("take/deep/one.mtl"),
              testing::StartsWith("newmtl teeth\nmap_Kd ../../skins/my skin.png\nnewmtl skin\r\n"));
  EXPECT_THAT(text("take/deep/one.obj"), HasSubstr("mtllib one.mtl\nusemtl teeth\n"));
}

TEST_F(Attributes, OfALibraryThatIsMissingAreLeftOutAndNamed) {
  write_take();
  fs::remove(folder_ / "take/face.mtl");
  convert("take", "out", {.frame_format = "obj"});
  EXPECT_THAT(text("out/frame_0000.obj"), Not(HasSubstr("mtllib")));
  const auto open = open_sequence(folder_ / "take");
  EXPECT_THAT(materials_in_folder(open.frames->connectivity(), folder_ / "out").notes,
              ElementsAre(HasSubstr("/out: without the materials of face.mtl")));
  EXPECT_THAT(materials_beside(open.frames->connectivity(), folder_ / "one.obj").notes,
              ElementsAre(HasSubstr("/one.obj: without the materials of face.mtl")));
}

TEST_F(Attributes, OfWhatIsNoLibraryAreNotRead) {
  write_take();
  for (const char* name : {"/dev/zero", "/etc/hostname", "f_1.obj", "."}) {
    EXPECT_TRUE(read_materials(folder_ / "take/f_0.obj", {name})->libraries.empty()) << name;
  }
}

TEST_F(Attributes, TextureOfCornersStandsInPlyAsMeshLabHasIt) {
  write_take();
  convert("take", "plys", {});
  EXPECT_THAT(text("plys/frame_0000.ply"), HasSubstr("property list uchar float texcoord\n"));
  EXPECT_EQ(texture_at_corners(folder_ / "plys/frame_0001.ply"),
            texture_at_corners(folder_ / "take/f_0.obj"));
  convert("plys", "back", {.frame_format = "obj"});
  EXPECT_EQ(texture_at_corners(folder_ / "back/frame_0000.obj"),
            texture_at_corners(folder_ / "take/f_0.obj"));
  EXPECT_EQ(read_mesh(folder_ / "plys/frame_0000.ply").connectivity.texture.coordinates.size(), 6u);
}

TEST_F(Attributes, TextureGoesWithAnArrayInItsTopology) {
  write_take();
  convert("take", "take.npy");
  convert("take.npy", "back", {.frame_format = "obj"});
  EXPECT_EQ(texture_at_corners(folder_ / "back/frame_0001.obj"),
            texture_at_corners(folder_ / "take/f_0.obj"));
}

TEST_F(Attributes, TextureOfVerticesIsReadUnderEachOfItsNames) {
  for (const std::string names : {"s t", "u v", "texture_u texture_v"}) {
    const std::string u = names.substr(0, names.find(' ')), v = names.substr(names.find(' ') + 1);
    const auto place = folder_ / "mesh.ply";
    write_bytes(place,
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float " + v +
                    "\nproperty float y\nproperty float z\nproperty float " + u +
                    "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                    "0 0.5 0 0 0.25\n1 0.5 0 0 0.75\n0 1 1 0 0.25\n3 2 0 1\n");
    EXPECT_THAT(texture_at_corners(place), ElementsAre(0.25, 1, 0.25, 0.5, 0.75, 0.5)) << names;
    write_mesh(folder_ / "again.ply", read_mesh(place), {.double_precision = true});
    EXPECT_THAT(text("again.ply"), HasSubstr("property double s\nproperty double t\n"));
    EXPECT_EQ(texture_at_corners(folder_ / "again.ply"), texture_at_corners(place));
    // The fast layout reads what the whole reader does.
    EXPECT_EQ(MeshFileReader(folder_ / "again.ply").read(folder_ / "again.ply"),
              read_mesh(place).positions);
  }
}

TEST_F(Attributes, FacesOfPlyWithoutTextureHaveNone) {
  write_bytes(folder_ / "mesh.obj", std::string(kVertices) + "vt 0 1\nf 1/1 2/1 3/1\nf 1 3 4\n");
  write_mesh(folder_ / "mesh.ply", read_mesh(folder_ / "mesh.obj"));
  EXPECT_THAT(texture_at_corners(folder_ / "mesh.ply"),
              ElementsAre(0, 1, 0, 1, 0, 1, -1, -1, -1, -1, -1, -1));
}

TEST_F(Attributes, TextureBeyondSinglePrecisionComesBack) {
  write_bytes(folder_ / "mesh.obj", std::string(kVertices) + "vt 1e39 -1e39\nf 1/1 2/1 3/1\n");
  for (const char* name : {"a.obj", "a.ply"}) {
    write_mesh(folder_ / name, read_mesh(folder_ / "mesh.obj"));
    EXPECT_EQ(texture_at_corners(folder_ / name), texture_at_corners(folder_ / "mesh.obj"));
  }
}

TEST_F(Attributes, TextureOfPolygonsOfManyCornersComesBack) {
  std::string obj = "vt 0 0\nvt 1 1\n", face = "f";
  for (int corner = 1; corner <= 200; ++corner) {
    obj += "v " + std::to_string(corner) + " 0 0\n";
    face += ' ' + std::to_string(corner) + '/' + std::to_string(1 + corner % 2);
  }
  write_bytes(folder_ / "mesh.obj", obj + face + '\n');
  write_mesh(folder_ / "mesh.ply", read_mesh(folder_ / "mesh.obj"));
  EXPECT_EQ(texture_at_corners(folder_ / "mesh.ply"), texture_at_corners(folder_ / "mesh.obj"));
}

}  // namespace
}  // namespace mimetra
