#include "toolkit/io/mesh_file.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/io/mesh_text.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::message_of;
using test::read_text;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A pentagon, a quad and a triangle, at places that no float holds.
TriMesh mixed_polygons() {
  const test::Shape shape = test::sphere(0);
  Positions positions(7, 3);
  positions << shape.positions / 3, 0.1, 0.2, 0.3;
  const Polygons polygons{{0, 1, 2, 3, 4, 3, 4, 5, 6, 6, 5, 0}, {0, 5, 9, 12}};
  return {positions, Connectivity::from_polygons(7, polygons)};
}

class EveryPolygonFormat : public testing::TestWithParam<std::string> {};

TEST_P(EveryPolygonFormat, DoublesComeBackBitByBitAndFloatsAsFloats) {
  const TemporaryFolder folder;
  const TriMesh mesh = mixed_polygons();
  write_mesh(folder / ("a" + GetParam()), mesh, {.double_precision = true});
  const TriMesh read = read_mesh(folder / ("a" + GetParam()));
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.connectivity.polygons, mesh.connectivity.polygons);
  write_mesh(folder / ("b" + GetParam()), mesh);
  const Positions rounded = read_mesh(folder / ("b" + GetParam())).positions;
  EXPECT_EQ(rounded.cast<float>(), mesh.positions.cast<float>());
}

TEST_P(EveryPolygonFormat, KeepsUnusedVerticesAndRepeatedOnes) {
  const TemporaryFolder folder;
  const TriMesh mesh{Positions::Zero(9, 3), Connectivity::from_polygons(9, {{7, 3, 3}, {0, 3}})};
  write_mesh(folder / ("a" + GetParam()), mesh);
  const TriMesh read = read_mesh(folder / ("a" + GetParam()));
  EXPECT_EQ(read.positions.rows(), 9);
  EXPECT_EQ(read.connectivity.polygons, mesh.connectivity.polygons);
}

TEST_P(EveryPolygonFormat, NonFinitePositionIsNamed) {
  const TemporaryFolder folder;
  TriMesh mesh = mixed_polygons();
  mesh.positions(2, 1) = std::numeric_limits<double>::infinity();
  write_mesh(folder / ("a" + GetParam()), mesh);
  EXPECT_THAT(message_of<IoError>([&] { read_mesh(folder / ("a" + GetParam())); }),
              testing::ContainsRegex("vertex [23] has no usable position: y is inf"));
}

TEST_P(EveryPolygonFormat, MeshWithoutFacesIsAnError) {
  const TemporaryFolder folder;
  const fs::path path = folder / ("a" + GetParam());
  write_mesh(path, {Positions::Zero(3, 3), Connectivity::from_polygons(3, {})});
  EXPECT_EQ(message_of<IoError>([&] { read_mesh(path); }), path.string() + ": has no faces");
}

TEST_P(EveryPolygonFormat, FurtherFileWithOtherVerticesNamesBoth) {
  const TemporaryFolder folder;
  const fs::path path = folder / ("frame_012" + GetParam());
  write_mesh(path, {Positions::Zero(5, 3), Connectivity::from_polygons(5, {{0, 1, 2}, {0, 3}})});
  const TriMesh first = mixed_polygons();
  EXPECT_EQ(
      message_of<MismatchError>([&] { read_positions(path, first.connectivity, "frame_001.obj"); }),
      path.string() + ": 5 vertices, expected 7 as in frame_001.obj");
}

TEST_P(EveryPolygonFormat, FurtherFileWithAFlippedFaceNamesIt) {
  const TemporaryFolder folder;
  const fs::path path = folder / ("b" + GetParam());
  const TriMesh first = mixed_polygons();
  Polygons flipped = first.connectivity.polygons;
  std::swap(flipped.corners[9], flipped.corners[10]);
  write_mesh(path, {first.positions, Connectivity::from_polygons(7, flipped)});
  EXPECT_THAT(message_of<MismatchError>([&] { read_positions(path, first.connectivity, "a"); }),
              testing::ContainsRegex("face [23] .*has the vertices .* as in a"));
}

TEST_P(EveryPolygonFormat, FurtherFileMayStartItsFacesAtAnotherCorner) {
  const TemporaryFolder folder;
  const TriMesh first = mixed_polygons();
  Polygons rotated = first.connectivity.polygons;
  std::rotate(rotated.corners.begin(), rotated.corners.begin() + 2, rotated.corners.begin() + 5);
  write_mesh(folder / ("b" + GetParam()),
             {first.positions, Connectivity::from_polygons(7, rotated)},
             {.double_precision = true});
  EXPECT_EQ(read_positions(folder / ("b" + GetParam()), first.connectivity, "a"), first.positions);
}

TEST_P(EveryPolygonFormat, WhatFollowsTheLastElementIsAnErrorThatSaysSo) {
  const TemporaryFolder folder;
  const fs::path path = folder / ("a" + GetParam());
  write_mesh(path, mixed_polygons());
  write_bytes(path, read_file(path) + "17 18");
  EXPECT_THAT(message_of<IoError>([&] { read_mesh(path); }),
              testing::ContainsRegex("5 bytes follow the last element|expected .*found '17'"));
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryPolygonFormat, testing::Values(".obj", ".ply", ".off"),
                         [](const auto& format) { return format.param.substr(1); });

TEST(Obj, ReadsEveryKindOfCornerAndExtraColumns) {
  const TriMesh mesh = read_text(".obj",
                                 "# head\nmtllib a.mtl\n"
                                 "v 0 0 0 1 0.5 0.5\nv +1 0 0\r\nv 1 1e0 0\nv 0 1 0 # four\n"
                                 "vt 0 0\nvt 1 0.5 0\nvn 0 0 1\n"
                                 "f 1 2 3\nf 1/1 2/2 3/1\nf 1//1 2//1 3//1\nf 1/2/1 2/1/1 4/1/1\n"
                                 "f -4 -3 \\\n -2\\\n -1\n");
  EXPECT_EQ(mesh.positions.rows(), 4);
  EXPECT_THAT(mesh.connectivity.polygons.corners,
              ElementsAre(0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 3, 0, 1, 2, 3));
  EXPECT_THAT(mesh.connectivity.texture.corners,
              ElementsAre(-1, -1, -1, 0, 1, 0, -1, -1, -1, 1, 0, 0, -1, -1, -1, -1));
  EXPECT_EQ(mesh.connectivity.texture.coordinates[1], Eigen::Vector2d(1, 0.5));
}

TEST(Obj, KeepsTextureCoordinatesAndGroups) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0\nvt 1 0.5\no face\ng lips upper\n"
              "usemtl skin\nf 1/2 2/1 3/2\ns 1\nf 3 2 1\n");
  const TriMesh mesh = read_mesh(folder / "a.obj");
  write_mesh(folder / "b.obj", mesh);
  EXPECT_EQ(read_file(folder / "b.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0\nvt 1 0.5\no face\ng lips upper\n"
            "usemtl skin\nf 1/2 2/1 3/2\ns 1\nf 3 2 1\n");
}

TEST(Obj, LosesNoVertexToAByteOrderMark) {
  const TriMesh mesh =
      read_text(".obj", "\xEF\xBB\xBFv 5 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions.rows(), 4);
  EXPECT_EQ(mesh.positions(0, 0), 5);
}

TEST(Obj, MayEndAsFilesOfDosDid) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(read_text(".obj", text + "\x1a").positions.rows(), 3);
  EXPECT_THAT(error_of(".obj", text + "\x1a\nv 0 0 0\n"),
              HasSubstr("line 5: expected a statement"));
}

TEST(Obj, ZeroBytesAfterItsEndArePadding) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", zeros(4096, '\0');
  for (const std::string end : {"", "\n", "\n\x1a"}) {
    EXPECT_EQ(read_text(".obj", text + end + zeros).connectivity.triangles,
              (Triangles(1, 3) << 0, 1, 2).finished());
  }
  EXPECT_THAT(error_of(".obj", text + '\n' + zeros + "\nv 0 0 0\n"),
              HasSubstr("line 5: expected a statement"));
}

TEST(Obj, LinesMayEndInCarriageReturnsAlone) {
  const TriMesh mesh = read_text(".obj", "# head\rv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r");
  EXPECT_EQ(mesh.positions.rows(), 3);
  EXPECT_EQ(mesh.connectivity.triangles.rows(), 1);
  EXPECT_THAT(error_of(".obj", "v 0 0 0\rv 1 0 0\rv 0 x 0\r"), HasSubstr("line 3: expected a num"));
}

TEST(Obj, FramesMayEndTheirLinesInCarriageReturnsAlone) {
  const TemporaryFolder folder;
  const std::string start = "v 0 0 0\rv 1 0 0\rv 0 1 ", end = "\rf 1 2 3\r";
  write_bytes(folder / "f_1.obj", start + "0" + end);
  write_bytes(folder / "f_2.obj", start + "5" + end);
  const MeshSequence sequence = read_sequence((folder / "f_%d.obj").string()).sequence;
  ASSERT_EQ(sequence.frames(), 2);
  EXPECT_EQ(sequence.frame(1)(2, 2), 5);
}

TEST(Obj, PassesOverStatementsThatSayNothingOfTheMesh) {
  EXPECT_EQ(read_text(".obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvp 1\nl 1 2\nf 1 2 3\n")
                .positions.rows(),
            3);
}

TEST(Obj, FacesMayPointForward) {
  EXPECT_EQ(read_text(".obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").positions.rows(), 3);
}

TEST(Obj, ErrorsNameTheLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(error_of(".obj", vertices + "f 1 2 4\n"),
              HasSubstr("mesh.obj: face 1 (line 4) uses vertex 4, expected 1 to 3"));
  EXPECT_THAT(error_of(".obj", vertices + "f 1 2 0\n"), HasSubstr("line 4: index 0"));
  EXPECT_THAT(error_of(".obj", vertices + "f 1 2 -4\n"), HasSubstr("line 4: index -4"));
  EXPECT_THAT(error_of(".obj", vertices + "f 1 2\n"),
              HasSubstr("face 1 (line 4) has 2 corners, expected at least 3"));
  EXPECT_THAT(error_of(".obj", vertices + "f 1 2 x\n"),
              HasSubstr("line 4: expected an integer for a vertex, found 'x'"));
  EXPECT_THAT(error_of(".obj", "v 0 0 0\nv 0 zero 0\n"),
              HasSubstr("line 2: expected a number for a vertex coordinate, found 'zero'"));
  EXPECT_THAT(error_of(".obj", vertices + "f 1/1 2/1 3/1\n"),
              HasSubstr("the face of line 4 uses texture coordinate 1"));
  EXPECT_THAT(error_of(".obj", "v 0 0 nan\n" + vertices + "f 1 2 3\n"),
              HasSubstr("vertex 1 has no usable position: z is nan"));
}

const std::string kPlyHeader =
    "element vertex 3\nproperty uchar red\nproperty double z\nproperty float y\nproperty short x\n"
    "element edge 1\nproperty int a\nproperty list uchar short b\n"
    "element face 1\nproperty list int uchar vertex_index\nproperty float quality\nend_header\n";

template <typename Number>
void append(std::string& bytes, Number value, bool big_endian) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

/// kPlyHeader's elements with vertex v at (v, 10 v, 100 v).
std::string binary_ply(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment by hand\n" + kPlyHeader;
  for (int v = 0; v < 3; ++v) {
    append<std::uint8_t>(bytes, 255, big_endian);
    append<double>(bytes, 100 * v, big_endian);
    append<float>(bytes, static_cast<float>(10 * v), big_endian);
    append<std::int16_t>(bytes, static_cast<std::int16_t>(v), big_endian);
  }
  append<std::int32_t>(bytes, 7, big_endian);
  append<std::uint8_t>(bytes, 2, big_endian);
  append<std::int16_t>(bytes, -1, big_endian);
  append<std::int16_t>(bytes, -2, big_endian);
  append<std::int32_t>(bytes, 3, big_endian);
  for (const std::uint8_t corner : {2, 0, 1}) append<std::uint8_t>(bytes, corner, big_endian);
  append<float>(bytes, 0.5f, big_endian);
  return bytes;
}

void expect_the_ply_triangle(const TriMesh& mesh) {
  Positions expected(3, 3);
  expected << 0, 0, 0, 1, 10, 100, 2, 20, 200;
  EXPECT_EQ(mesh.positions, expected);
  EXPECT_THAT(mesh.connectivity.polygons.corners, ElementsAre(2, 0, 1));
}

TEST(Obj, IndexBeyondAnIntIsAnError) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string index : {"2147483647", "2147483648", "4294967297", "-2147483649"}) {
    EXPECT_THAT(error_of(".obj", vertices + "f 1 2 " + index + "\n"), HasSubstr("vertex")) << index;
    EXPECT_THAT(error_of(".obj", vertices + "vt 0 0\nf 1/1 2/1 3/" + index + "\n"),
                HasSubstr("texture coordinate"))
        << index;
  }
}

TEST(Ply, ReadsAnyPropertiesInEitherByteOrder) {
  expect_the_ply_triangle(read_text(".ply", binary_ply(false)));
  expect_the_ply_triangle(read_text(".ply", binary_ply(true)));
}

TEST(Ply, ReadsTextWithEitherLineEnd) {
  const std::string body = "1 0 0 0\n1 100 10 1\n1 200 20 2\n7 2 -1 -2\n3 2 0 1 0.5\n";
  std::string text = "ply\nformat ascii 1.0\n" + kPlyHeader + body;
  expect_the_ply_triangle(read_text(".ply", text));
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
    text.insert(at, "\r");
  }
  expect_the_ply_triangle(read_text(".ply", text));
}

TEST(Ply, EveryTruncatedBinaryPrefixIsAnError) {
  // Also where only a property is missing that nobody needs.
  for (const bool big_endian : {false, true}) {
    const std::string bytes = binary_ply(big_endian);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THROW(read_text(".ply", bytes.substr(0, size)), IoError) << size;
    }
  }
}

TEST(Ply, ElementsAfterTheFacesHaveToBeWholeToo) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element edge 2\nproperty int a\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n5\n";
  EXPECT_EQ(read_text(".ply", text + "6\n").positions.rows(), 3);
  EXPECT_THAT(error_of(".ply", text), HasSubstr("expected a number for edge, found nothing"));
}

TEST(Ply, CountsBeyondTheFileAreFoundBeforeMemoryIsAskedFor) {
  for (const std::string element : {"vertex 3", "edge 1", "face 1"}) {
    std::string bytes = binary_ply(false);
    bytes.replace(bytes.find(element), element.size(),
                  element.substr(0, element.find(' ')) + " 4000000000000");
    EXPECT_THAT(error_of(".ply", bytes), HasSubstr("4000000000000 expected, but only")) << element;
  }
}

TEST(Ply, ListBeyondTheFileIsFoundBeforeMemoryIsAskedFor) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list int int vertex_indices\nend_header\n0 0 0\n";
  EXPECT_THAT(error_of(".ply", head + "2000000000 0 0 0\n"), HasSubstr("mesh.ply: face 0: a list"));
  EXPECT_THAT(error_of(".ply", head + "-1 0 0 0\n"), HasSubstr("mesh.ply: face 0: a list"));
}

TEST(Ply, ErrorsNameTheElement) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_THAT(error_of(".ply", head + vertices + "3 0 1 2\n3 0 1 3\n"),
              HasSubstr("face 1 uses vertex 3, expected 0 to 2"));
  EXPECT_THAT(error_of(".ply", head + vertices + "3 0 1 2\n3 0 1 -1\n"), HasSubstr("face 1"));
  EXPECT_THAT(error_of(".ply", head + vertices + "3 0 1 2\n2 0 1\n"),
              HasSubstr("face 1 has 2 corners, expected at least 3"));
  EXPECT_THAT(error_of(".ply", head + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
              HasSubstr("line 11: expected a number for vertex, found 'x'"));
  EXPECT_THAT(error_of(".ply", "solid"), HasSubstr("this is no PLY file"));
}

TEST(Ply, TextAfterTheLastElementIsNamedWithItsLine) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\n";
  EXPECT_EQ(read_text(".ply", text).positions.rows(), 3);
  EXPECT_THAT(error_of(".ply", text + "3 0 1 2\n"),
              HasSubstr("line 15: expected the end of the file, found '3'"));
}

TEST(Ply, ABinaryFileMayEndWithBlanks) {
  for (const std::string tail : {"\n", "\r\n", " \n\n"}) {
    expect_the_ply_triangle(read_text(".ply", binary_ply(false) + tail));
  }
  EXPECT_THAT(error_of(".ply", binary_ply(false) + "\n\x01"),
              HasSubstr("2 bytes follow the last element, expected the end of the file"));
}

TEST(Ply, ZeroBytesAfterItsEndArePadding) {
  const std::string zeros(4096, '\0');
  for (const std::string tail : {"", "\n", "\r\n"}) {
    expect_the_ply_triangle(read_text(".ply", binary_ply(false) + tail + zeros));
  }
  EXPECT_THAT(error_of(".ply", binary_ply(false) + zeros + "\x01"),
              HasSubstr("4097 bytes follow the last element, expected the end of the file"));
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  for (const std::string end : {"", "\n"}) {
    EXPECT_EQ(read_text(".ply", text + end + zeros).connectivity.triangles.rows(), 1);
  }
  EXPECT_THAT(error_of(".ply", text + '\n' + zeros + '5'),
              HasSubstr("line 14: expected the end of the file"));
}

TEST(Ply, StripsOfTrianglesAreNamed) {
  EXPECT_THAT(error_of(".ply",
                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                       "property float y\nproperty float z\nelement tristrips 1\n"
                       "property list int int vertex_indices\nend_header\n"
                       "0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n"),
              HasSubstr("element tristrips: strips of triangles are not read, expected an element "
                        "face"));
}

TEST(Ply, PolygonsOfManyCornersComeBack) {
  const TemporaryFolder folder;
  Polygons polygon{{}, {0, 300}};
  for (int corner = 0; corner < 300; ++corner) polygon.corners.push_back(corner);
  write_mesh(folder / "a.ply",
             {Positions::Zero(300, 3), Connectivity::from_polygons(300, polygon)});
  EXPECT_EQ(read_mesh(folder / "a.ply").connectivity.polygons, polygon);
}

TEST(Off, ReadsCommentsAndColours) {
  const TriMesh mesh = read_text(".off",
                                 "COFF # colours\n# counts\n\n4 1 0\n0 0 0 255 0 0 255\n"
                                 "1 0 0 255 0 0 255\n# half\n1 1 0 0 0 0 255\r\n0 1 0 0 0 0 255\n"
                                 "4 0 1 2 3 0.5 0.5 0.5\n");
  EXPECT_EQ(mesh.positions.row(2), Eigen::RowVector3d(1, 1, 0));
  EXPECT_THAT(mesh.connectivity.polygons.corners, ElementsAre(0, 1, 2, 3));
}

TEST(Off, ZeroBytesAfterItsEndArePadding) {
  const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", zeros(4096, '\0');
  for (const std::string end : {"", "\n"}) {
    EXPECT_EQ(read_text(".off", text + end + zeros).connectivity.triangles.rows(), 1);
  }
}

TEST(Off, ReadsNormalsAndCountsBesideTheKeyword) {
  EXPECT_EQ(read_text(".off", "NOFF 3 1 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n")
                .positions.rows(),
            3);
}

TEST(Off, CountsBeyondTheFileAreFoundBeforeMemoryIsAskedFor) {
  EXPECT_THAT(error_of(".off", "OFF\n2000000000 1 0\n0 0 0\n"),
              HasSubstr("line 2: the number of vertices is 2000000000, but only"));
  EXPECT_THAT(error_of(".off", "OFF\n1 2000000000 0\n0 0 0\n"),
              HasSubstr("the number of faces is 2000000000, but only"));
}

TEST(Off, EveryPrefixThatLosesAWordIsAnError) {
  const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_THROW(read_text(".off", text.substr(0, size)), IoError) << size;
  }
}

TEST(Off, ErrorsNameTheLine) {
  EXPECT_THAT(error_of(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              HasSubstr("mesh.off: face 0 (line 6) uses vertex 3, expected 0 to 2"));
  EXPECT_THAT(error_of(".off", "ply\n"),
              HasSubstr("line 1: expected OFF, COFF or NOFF, found 'ply'"));
  EXPECT_THAT(error_of(".off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n"),
              HasSubstr("line 7: expected the end of the file, found '3'"));
}

TEST(MeshFile, ExtensionDecidesInAnyCase) {
  EXPECT_TRUE(is_mesh_extension(".OBJ"));
  EXPECT_FALSE(is_mesh_extension(".npy"));
  EXPECT_FALSE(is_mesh_extension(""));
  EXPECT_THAT(error_of(".xyz", ""),
              HasSubstr("'.xyz' is no mesh format; expected .ply, .obj, .off, .stl or .om"));
}

TEST(MeshFile, IsNotWrittenUnderANameWithoutAFormat) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(folder / "a.tmp", mixed_polygons()), OutputError);
}

}  // namespace
}  // namespace mimetra
