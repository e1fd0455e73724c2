#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/retargeting_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Retargeting map_of_a_file() {
  Retargeting map;
  map.source_names = {"smile, left", "jaw \"open\""};
  map.target_names = {"x", "y"};
  map.gram = Eigen::Matrix2d{{2, 1.0 / 3}, {1.0 / 3, 0.1}};
  map.linear = Eigen::Matrix2d{{1e-17, 0.7}, {-2.5, 1}};
  map.lower = Eigen::Vector2d::Zero();
  map.upper = Eigen::Vector2d(1, 0);
  return map;
}

/// The message about a file in which `from` has become `to`.
std::string changed_file(const std::string& from, const std::string& to) {
  std::string text = retargeting_json(map_of_a_file());
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  const std::string message =
      test::message_of<IoError>([&] { parse_retargeting("map.json", text); });
  EXPECT_THAT(message, HasSubstr("map.json"));
  return message;
}

TEST(RetargetingFile, IsReadAsItWasWritten) {
  const Retargeting map = map_of_a_file();
  const Retargeting found = parse_retargeting("map.json", retargeting_json(map));
  EXPECT_EQ(found.source_names, map.source_names);
  EXPECT_EQ(found.target_names, map.target_names);
  EXPECT_TRUE(found.gram == map.gram);
  EXPECT_TRUE(found.linear == map.linear);
  EXPECT_TRUE(found.lower == map.lower);
  EXPECT_TRUE(found.upper == map.upper);
}

TEST(RetargetingFile, IsNoMapInAllOtherCases) {
  EXPECT_THAT(changed_file("\"gram\"", "\"garm\""), HasSubstr("has no 'gram'"));
  EXPECT_THAT(changed_file("\"version\":1", "\"version\":1,\"ridge\":0"),
              AllOf(HasSubstr("'ridge' is unknown"), HasSubstr("leave it out")));
  EXPECT_THAT(changed_file("\"version\":1", "\"version\":2"),
              HasSubstr("version: expected 1, found 2"));
  EXPECT_THAT(changed_file("weights of one rig", "weights of two rigs"), HasSubstr("kind"));
  EXPECT_THAT(changed_file("[\"x\",\"y\"]", "[\"x\",5]"),
              HasSubstr("target/1: expected a name, found 5"));
  EXPECT_THAT(changed_file("[\"x\",\"y\"]", "[\"x\",\"x\"]"), HasSubstr("'x' twice"));
  EXPECT_THAT(changed_file("\"upper\":[1.0,0.0]", "\"upper\":[1.0]"),
              HasSubstr("upper: expected 2 numbers, found 1"));
  EXPECT_THAT(changed_file("-2.5", "null"),
              HasSubstr("linear/1/0: expected a finite number, found null"));
  EXPECT_THAT(changed_file("[2.0,", "[-2.0,"),
              AllOf(HasSubstr("negative eigenvalue"), HasSubstr("--map-out")));
  EXPECT_THAT(test::message_of<IoError>([] { parse_retargeting("map.json", "[]"); }),
              HasSubstr("--map-out"));
  EXPECT_THAT(test::message_of<IoError>([] { parse_retargeting("map.json", "time,jaw\n"); }),
              HasSubstr("map.json"));
}

TEST(RetargetingFile, IsRefusedWhereverItIsCut) {
  const std::string text = retargeting_json(map_of_a_file());
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    EXPECT_THROW(parse_retargeting("map.json", text.substr(0, length)), IoError) << length;
  }
}

TEST(PlainMatrixFile, NamesRowsAndColumns) {
  EXPECT_EQ(plain_matrix_csv(map_of_a_file(), Eigen::Matrix2d{{0.5, -1}, {0, 2}}),
            "expression,\"smile, left\",\"jaw \"\"open\"\"\"\nx,0.5,-1\ny,0,2\n");
}

}  // namespace
}  // namespace mimetra
