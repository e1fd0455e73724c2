#include <algorithm>

#include <gmock/gmock.h>

#include "tests/io/mesh_text.h"
#include "tests/shapes.h"

namespace mimetra {
namespace {

using test::error_of;
using test::message_of;
using test::read_text;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Stl, WeldsCornersInOrderOfFirstUse) {
  const TemporaryFolder folder;
  const test::Shape shape = test::sphere(1);
  const TriMesh mesh = test::mesh_of(shape);
  write_mesh(folder / "a.stl", mesh);
  const TriMesh read = read_mesh(folder / "a.stl");
  ASSERT_EQ(read.positions.rows(), mesh.positions.rows());
  int unseen = 0;
  for (Eigen::Index t = 0; t < shape.triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = read.connectivity.triangles(t, corner);
      EXPECT_LE(vertex, unseen);
      unseen = std::max(unseen, vertex + 1);
      EXPECT_EQ(read.positions.row(vertex).cast<float>(),
                mesh.positions.row(shape.triangles(t, corner)).cast<float>());
    }
  }
}

const std::string kAsciiStl =
    "solid two words\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 0 1 0\n"
    "   vertex 1 0 0\n   vertex 1 1 0\n  endloop\n endfacet\nendsolid two words\n";

TEST(Stl, ReadsText) {
  const TriMesh mesh = read_text(".stl", kAsciiStl);
  EXPECT_EQ(mesh.positions.rows(), 4);
  EXPECT_THAT(mesh.connectivity.polygons.corners, ElementsAre(0, 1, 2, 2, 1, 3));
}

TEST(Stl, EveryTruncatedPrefixIsAnError) {
  const std::size_t whole = kAsciiStl.find("endsolid") + std::string("endsolid").size();
  for (std::size_t size = 0; size < whole; ++size) {
    EXPECT_THROW(read_text(".stl", kAsciiStl.substr(0, size)), IoError) << size;
  }
  const TemporaryFolder folder;
  write_mesh(folder / "a.stl", test::mesh_of(test::octahedron()));
  const std::string bytes = read_file(folder / "a.stl");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(read_text(".stl", bytes.substr(0, size)), IoError) << size;
  }
}

TEST(Stl, WhatFollowsTheLastTriangleIsAnErrorThatSaysSo) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.stl", test::mesh_of(test::octahedron()));
  EXPECT_THAT(error_of(".stl", read_file(folder / "a.stl") + "x"),
              HasSubstr("is too long: 485 bytes, expected 484 for 8 triangles"));
  EXPECT_THAT(error_of(".stl", kAsciiStl + "garbage"),
              HasSubstr("line 17: expected 'solid' or the end of the file, found 'garbage'"));
}

TEST(Stl, TextErrorsNameTheLine) {
  EXPECT_THAT(error_of(".stl", "solid\nfacet normal 0 0 1\nouter ring\n"),
              HasSubstr("line 3: expected 'loop', found 'ring'"));
  EXPECT_THAT(error_of(".stl", "solid\nfacets\n"),
              HasSubstr("line 2: expected 'facet' or 'endsolid', found 'facets'"));
}

TEST(Stl, TextMayHoldSeveralSolids) {
  EXPECT_EQ(read_text(".stl", kAsciiStl + kAsciiStl).connectivity.triangles.rows(), 4);
}

TEST(Stl, BinaryFileMayStartWithSolid) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.stl", test::mesh_of(test::octahedron()));
  const std::string bytes = read_file(folder / "a.stl").replace(0, 5, "solid");
  EXPECT_EQ(read_text(".stl", bytes).positions.rows(), 6);
}

TEST(Stl, VerticesThatPartOrMeetStayWhatTheyAre) {
  const TemporaryFolder folder;
  TriMesh mesh = test::mesh_of(test::octahedron());
  write_mesh(folder / "a.stl", mesh);
  const TriMesh first = read_mesh(folder / "a.stl");
  mesh.positions.row(0) = mesh.positions.row(1);
  write_mesh(folder / "b.stl", mesh);
  const Positions second = read_positions(folder / "b.stl", first.connectivity, folder / "a.stl");
  ASSERT_EQ(second.rows(), 6);
  const int vertex = first.connectivity.triangles(0, 0);
  EXPECT_EQ(second.row(vertex), mesh.positions.row(1));
}

TEST(Stl, WhatTouchesInTheFirstFrameAndPartsLaterIsRefused) {
  const TemporaryFolder folder;
  TriMesh mesh = test::mesh_of(test::sphere(2));
  const Positions open = mesh.positions;
  const double size = box_diagonal(open);
  mesh.positions.row(1) = mesh.positions.row(0);
  write_mesh(folder / "a.stl", mesh);
  const TriMesh first = read_mesh(folder / "a.stl");
  // By the last digits of single precision.
  mesh.positions(1, 0) += 1e-7 * size;
  write_mesh(folder / "b.stl", mesh);
  EXPECT_EQ(read_positions(folder / "b.stl", first.connectivity, "a.stl").rows(), open.rows() - 1);
  mesh.positions = open;
  write_mesh(folder / "b.stl", mesh);
  EXPECT_THAT(message_of<MismatchError>(
                  [&] { read_positions(folder / "b.stl", first.connectivity, "a.stl"); }),
              AllOf(HasSubstr("b.stl: 1 vertex of a.stl"), HasSubstr("as OBJ or PLY")));
}

TEST(Stl, FurtherFileWithOtherTrianglesNamesBoth) {
  const TemporaryFolder folder;
  write_mesh(folder / "b.stl", test::mesh_of(test::octahedron()));
  EXPECT_EQ(message_of<MismatchError>([&] {
              read_positions(folder / "b.stl", test::mesh_of(test::sphere(1)).connectivity, "a");
            }),
            (folder / "b.stl").string() + ": 8 triangles, expected 32 as in a");
}

}  // namespace
}  // namespace mimetra
