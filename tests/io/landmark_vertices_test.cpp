#include "toolkit/io/landmark_vertices.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class LandmarkVerticesFile : public testing::Test {
 protected:
  LandmarkMapping read(const std::string& content) {
    std::ofstream(folder_ / "map.txt", std::ios::binary) << content;
    return read_landmark_mapping(folder_ / "map.txt");
  }
  std::string message(const std::string& content) {
    return test::message_of<IoError>([&] { read(content); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(LandmarkVerticesFile, IsASectionOfEos) {
  EXPECT_THAT(read("# iBUG\n[landmark_mappings]\n  # jaw\n 9 = 33 # chin\r\n\"10\" = 2\n\n"
                   "[contour_landmarks]\nright = [ 1,\n 2\n ]\n"),
              ElementsAre(Pair("9", 33), Pair("10", 2)));
}

TEST_F(LandmarkVerticesFile, IsAListOfVertices) {
  EXPECT_THAT(read("# 0-based\n1225\n1888 # jaw\n\n0\n"),
              ElementsAre(Pair("1", 1225), Pair("2", 1888), Pair("3", 0)));
}

TEST_F(LandmarkVerticesFile, NamesTheLineThatIsWrong) {
  EXPECT_THAT(message("[landmark_mappings]\n9 33\n"),
              HasSubstr("line 2: expected '=' after the landmark '9', found '33'"));
  EXPECT_THAT(message("[landmark_mappings]\n9 = chin\n"),
              HasSubstr("line 2: expected an integer for a vertex, found 'chin'"));
  EXPECT_THAT(message("[landmark_mappings]\n9 = 1\n9 = 2\n"),
              HasSubstr("line 3: the landmark '9' occurs twice"));
  EXPECT_THAT(message("[landmark_mappings]\n9 = 1 2\n"),
              HasSubstr("line 2: expected the end of the line, found '2'"));
  EXPECT_THAT(message("1\n-2\n"), HasSubstr("line 2: vertex -2 is out of range"));
  EXPECT_THAT(message("1\n99999999999\n"), HasSubstr("line 2: vertex 99999999999 is out of range"));
  EXPECT_THAT(message("# nothing\n"), HasSubstr("maps no landmark"));
  EXPECT_THAT(message("[other]\n9 = 1\n"), HasSubstr("maps no landmark"));
}

TEST_F(LandmarkVerticesFile, IsFoundInTheFolderOfAModel) {
  std::ofstream(folder_ / "readme.txt") << "x";
  EXPECT_THAT(test::message_of<IoError>([&] { find_landmark_mapping(folder_.path()); }),
              HasSubstr("holds no landmark mapping"));
  std::ofstream(folder_ / "ibug_to_face.txt") << "x";
  EXPECT_EQ(find_landmark_mapping(folder_.path()), folder_ / "ibug_to_face.txt");
  EXPECT_EQ(find_landmark_mapping(folder_ / "shape.bin"), folder_ / "ibug_to_face.txt");
  std::ofstream(folder_ / "landmarks68.txt") << "x";
  EXPECT_THAT(landmark_mappings(folder_.path()),
              ElementsAre(folder_ / "ibug_to_face.txt", folder_ / "landmarks68.txt"));
  EXPECT_THAT(test::message_of<IoError>([&] { find_landmark_mapping(folder_.path()); }),
              HasSubstr("several landmark mappings, such as ibug_to_face.txt and landmarks68.txt"));
}

TEST_F(LandmarkVerticesFile, OfTheSharedModelsIsRead) {
  MIMETRA_SKIP_WITHOUT(test::shared_path("data/sfm"));
  const auto sfm = read_landmark_mapping(find_landmark_mapping(test::shared_path("data/sfm")));
  EXPECT_EQ(sfm.size(), 50u);
  EXPECT_THAT(sfm.front(), Pair("9", 33));
  EXPECT_THAT(sfm.back(), Pair("68", 404));
  const auto ict = read_landmark_mapping(find_landmark_mapping(test::shared_path("data/ict-face")));
  EXPECT_EQ(ict.size(), 68u);
  EXPECT_THAT(ict.front(), Pair("1", 1225));
}

TEST_F(LandmarkVerticesFile, HasIbugsLandmarksByTheirNumbers) {
  EXPECT_THAT(ibug_landmarks(read("[landmark_mappings]\n9 = 33\nmp1 = 7\n68 = 4\n69 = 5\n0 = 6\n")),
              ElementsAre(Pair(8, 33), Pair(67, 4)));
}

}  // namespace
}  // namespace mimetra
