#include "toolkit/io/painting_file.h"

#include <algorithm>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>

#include "tests/image_bytes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// A grid of 5 x 4 vertices, whose texture is a picture as wide and high as the grid has vertices:
/// each lies on the centre of a pixel.
class PaintingFileTest : public testing::Test {
 protected:
  static constexpr int kColumns = 5, kRows = 4;

  PaintingFileTest()
      : mesh_(
            Connectivity::from_triangles(kColumns * kRows, test::grid(kColumns, kRows).triangles)) {
    for (int v = 0; v < mesh_.vertices; ++v) {
      const int row = v / kColumns;
      mesh_.texture.coordinates.emplace_back((v % kColumns + 0.5) / kColumns, (row + 0.5) / kRows);
    }
    mesh_.texture.corners = mesh_.polygons.corners;
  }

  std::string file(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string picture(const std::vector<std::uint8_t>& grey) const {
    return file("p.png", test::png_bytes(kColumns, kRows, PNG_FORMAT_GRAY, grey));
  }
  Painting read(const std::string& path) const { return read_painting(path, mesh_); }
  Eigen::VectorXd list(const std::string& name, const std::string& text) const {
    return read(file(name, text)).weights;
  }
  template <typename Error>
  void expect_refusal(const std::string& name, const std::string& text,
                      const std::string& message) const {
    EXPECT_THAT([&] { list(name, text); },
                ThrowsMessage<Error>(testing::AllOf(HasSubstr(name), HasSubstr(message))));
  }

  const test::TemporaryFolder folder_;
  Connectivity mesh_;
};

TEST_F(PaintingFileTest, OfACheckerboardIsACheckerboardWithTheFirstRowOnTop) {
  std::vector<std::uint8_t> grey;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) grey.push_back((x + y) % 2 ? 255 : 0);
  }
  const Painting painting = read(picture(grey));
  for (int v = 0; v < mesh_.vertices; ++v) {
    const int row_from_top = kRows - 1 - v / kColumns;
    EXPECT_EQ(painting.weights[v], (v % kColumns + row_from_top) % 2) << v;
  }
  EXPECT_THAT(painting.notes, IsEmpty());
}

TEST_F(PaintingFileTest, IsTheMeanOfAVertexsCornersAtASeam) {
  std::vector<std::uint8_t> grey(kColumns * kRows, 0);
  grey[0] = 255;             // u = 0.1, v = 0.875
  grey[kColumns - 1] = 102;  // u = 0.9
  // Vertex 7 has six corners: one third of them lies at the left patch, the others at the right.
  mesh_.texture.coordinates.emplace_back(0.1, 0.875);
  mesh_.texture.coordinates.emplace_back(0.9, 0.875);
  int seen = 0;
  for (std::size_t c = 0; c < mesh_.polygons.corners.size(); ++c) {
    if (mesh_.polygons.corners[c] != 7) continue;
    mesh_.texture.corners[c] = mesh_.vertices + (++seen > 2 ? 1 : 0);
  }
  ASSERT_EQ(seen, 6);
  EXPECT_NEAR(read(picture(grey)).weights[7], (2 * 1.0 + 4 * 0.4) / 6, 1e-15);
}

TEST_F(PaintingFileTest, IsZeroWhereThereAreNoTextureCoordinates) {
  for (std::size_t c = 0; c < mesh_.polygons.corners.size(); ++c) {
    if (mesh_.polygons.corners[c] == 6) mesh_.texture.corners[c] = -1;
  }
  const Painting painting = read(picture(std::vector<std::uint8_t>(kColumns * kRows, 255)));
  EXPECT_EQ(painting.weights[6], 0);
  EXPECT_EQ(painting.weights.sum(), mesh_.vertices - 1);
  EXPECT_THAT(painting.notes, ElementsAre(HasSubstr("1 vertices have no texture coordinates")));
}

TEST_F(PaintingFileTest, OfAMeshWithoutTextureIsRefusedWithWhatToDo) {
  const std::string path = picture(std::vector<std::uint8_t>(kColumns * kRows, 255));
  mesh_.texture = {};
  EXPECT_THAT([&] { read(path); },
              ThrowsMessage<MismatchError>(
                  testing::AllOf(HasSubstr("no texture coordinates"), HasSubstr("vertex field"))));
}

TEST_F(PaintingFileTest, NotesTilesAndMaterials) {
  const std::string path = picture(std::vector<std::uint8_t>(kColumns * kRows, 255));
  mesh_.texture.coordinates[2].x() += 1;
  mesh_.texture.coordinates[4].y() -= 3;
  mesh_.texture.coordinates[6].y() = 1 + 1e-6;  // rounded, and no tile
  mesh_.groups = {{0, "usemtl skin"}, {5, "usemtl teeth"}};
  EXPECT_THAT(read(path).notes,
              ElementsAre(HasSubstr("2 of 20 texture coordinates lie outside [0, 1]"),
                          HasSubstr("all materials of the mesh, skin, teeth,")));
}

TEST_F(PaintingFileTest, IsRefusedAtCoordinatesThatAreNotFinite) {
  const std::string path = picture(std::vector<std::uint8_t>(kColumns * kRows, 255));
  for (const double bad :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    mesh_.texture.coordinates[7].y() = bad;
    EXPECT_THAT([&] { read_painting(path, mesh_, "head.obj"); },
                ThrowsMessage<IoError>(testing::AllOf(
                    testing::StartsWith("head.obj: texture coordinate 7 (from 0), of vertex 7, is"),
                    HasSubstr(path))));
  }
}

TEST_F(PaintingFileTest, IsOneNumberForEachVertex) {
  std::string text = "# painted by hand\n";
  for (int v = 0; v < mesh_.vertices; ++v) text += std::to_string(v / 20.0) + "\r\n";
  const Eigen::VectorXd weights = list("w.txt", text);
  for (int v = 0; v < mesh_.vertices; ++v) EXPECT_NEAR(weights[v], v / 20.0, 1e-6);
  expect_refusal<MismatchError>("w.txt", "1 1 0", "weights of 3 vertices, expected 20");
  expect_refusal<IoError>("w.txt", "1 x", "a weight, found 'x'");
}

TEST_F(PaintingFileTest, IsAFewVerticesOfATable) {
  const Eigen::VectorXd weights = list("w.csv", "vertex,weight\n3,0.25\n19,1\n");
  EXPECT_EQ(weights[3], 0.25);
  EXPECT_EQ(weights[19], 1);
  EXPECT_EQ(weights.sum(), 1.25);
  expect_refusal<MismatchError>("w.csv", "vertex,weight\n20,1\n",
                                "vertex 20; the mesh has vertices 0 to 19");
  expect_refusal<MismatchError>("w.csv", "vertex,weight\n-1,1\n", "vertex -1;");
  expect_refusal<IoError>("w.csv", "vertex,weight\n2.5,1\n", "line 2");
  expect_refusal<IoError>("w.csv", "vertex,weight\n2,1\n2,0\n", "vertex 2 occurs twice");
  expect_refusal<IoError>("w.csv", "vertex,region\n2,1\n", "expected the columns vertex,weight");
  expect_refusal<IoError>("w.csv", "vertex,weight\n2,nan\n", "line 2");
}

TEST_F(PaintingFileTest, IsRefusedOutOfRangeWithTheUnitThatItMayHave) {
  expect_refusal<IoError>("w.csv", "vertex,weight\n3,1\n7,60\n",
                          "vertex 7 has the weight 60, expected 0 to 1; divide them by 100");
  expect_refusal<IoError>("w.csv", "vertex,weight\n3,1\n7,200\n", "divide them by 255");
  expect_refusal<IoError>("w.csv", "vertex,weight\n3,-0.5\n", "vertex 3 has the weight -0.5");
  expect_refusal<IoError>("w.csv", "vertex,weight\n3,0\n", "no vertex has a weight above 0");
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(3);
  EXPECT_NO_THROW(check_painting("p", weights));
  weights[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { check_painting("p", weights); },
              ThrowsMessage<IoError>(HasSubstr("p: vertex 2 has the weight nan")));
}

TEST_F(PaintingFileTest, IsOfKnownFilesOnly) {
  expect_refusal<IoError>("w.tga", "1", "expected a painting in .png, .jpg, .jpeg, .csv or .txt");
  EXPECT_THAT([&] { read((folder_.path() / "none.png").string()); },
              ThrowsMessage<IoError>(HasSubstr("none.png")));
}

}  // namespace
}  // namespace mimetra
