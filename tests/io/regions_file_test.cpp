#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

class RegionsFile : public testing::Test {
 protected:
  Regions read(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name) << content;
    return read_regions(folder_ / name, 20, shape_.triangles);
  }
  test::Shape shape_ = test::grid(5, 4);
  test::TemporaryFolder folder_;
};

TEST_F(RegionsFile, JsonComesBackAfterWriting) {
  Regions regions = regions_from_vertices(20, shape_.triangles, {{1, 2, 6}, {13, 14}});
  regions.regions[0].center = 2;
  regions.regions[0].radius = 1.25;
  regions.regions[0].energy = 7.5;
  regions.regions[1].radius = std::numeric_limits<double>::infinity();
  regions.regions[1].energy_share = 0.375;
  regions.energy_share = 0.875;
  regions.regions.back().added_for = "smile";
  const Regions found = read("r.json", regions_json(regions));
  EXPECT_EQ(found.regions.back().added_for, "smile");
  EXPECT_EQ(found.regions.front().added_for, "");
  ASSERT_EQ(found.regions.size(), 2u);
  EXPECT_EQ(found.regions[0].vertices, regions.regions[0].vertices);
  EXPECT_EQ(found.regions[0].center, 2);
  EXPECT_EQ(found.regions[0].radius, 1.25);
  EXPECT_EQ(found.regions[0].energy, 7.5);
  EXPECT_EQ(found.regions[1].radius, std::numeric_limits<double>::infinity());
  EXPECT_EQ(found.energy_share, 0.875);
  EXPECT_EQ(found.regions[1].energy_share, 0.375);
  EXPECT_EQ(found.triangles, regions.triangles);
  EXPECT_EQ(found.regions[1].center, -1);
}

TEST_F(RegionsFile, CsvComesBackAfterWriting) {
  const Regions regions = regions_from_vertices(20, shape_.triangles, {{1, 2, 6}, {13, 14}});
  const Regions found = read("r.csv", regions_csv(regions));
  ASSERT_EQ(found.regions.size(), 2u);
  EXPECT_EQ(found.regions[1].vertices, regions.regions[1].vertices);
}

TEST_F(RegionsFile, TextIsAListOrAMask) {
  EXPECT_EQ(read("a.txt", "3\n4\n9\n").regions[0].vertices, (std::vector<int>{3, 4, 9}));
  std::string mask;
  for (int v = 0; v < 20; ++v) mask += v == 7 || v == 8 ? "1\n" : "0\n";
  EXPECT_EQ(read("m.txt", mask).regions[0].vertices, (std::vector<int>{7, 8}));
}

TEST_F(RegionsFile, VertexOutsideTheMeshIsAMismatchThatNamesIt) {
  const auto refusal = [this](const std::string& name, const std::string& content) {
    return test::message_of<MismatchError>([&] { read(name, content); });
  };
  EXPECT_THAT(refusal("a.txt", "3\n20\n"),
              testing::AllOf(testing::HasSubstr("20"), testing::HasSubstr("a.txt")));
  // 2^32 + 1 would be vertex 1 where it is cut to 32 bits.
  refusal("a.txt", "4294967297\n");
  refusal("b.csv", "vertex,region\n4294967297,0\n");
  refusal("c.json", "[[4294967297]]");
  refusal("d.json", "[[-1]]");
  refusal("e.json", R"({"regions": [{"center": 20, "vertices": [1]}]})");
}

TEST_F(RegionsFile, OfAnotherMeshIsAMismatch) {
  EXPECT_THROW(read("mask.txt", "1\n0\n0\n1\n"), MismatchError);
  const Regions other = regions_from_vertices(12, test::grid(4, 3).triangles, {{1, 2}});
  EXPECT_THROW(read("r.json", regions_json(other)), MismatchError);
}

TEST_F(RegionsFile, JsonMayBeListsAndTheyMayStandUnderRegions) {
  EXPECT_EQ(read("A.JSON", "[[3, 4], [9]]").regions[1].vertices, (std::vector<int>{9}));
  EXPECT_EQ(read("b.json", R"({"regions": [[3, 4]]})").regions[0].vertices,
            (std::vector<int>{3, 4}));
}

TEST_F(RegionsFile, WhatIsNoRegionSetIsAnError) {
  EXPECT_THROW(read("f.json", "[[1.5]]"), IoError);
  EXPECT_THROW(read("g.json", "[3, 4]"), IoError);
  EXPECT_THROW(read("h.csv", "vertex,region\n1,-1\n"), IoError);
  EXPECT_THROW(read("i.csv", "vertex,region\n1,0,2\n"), IoError);
  EXPECT_THROW(read("j.region", "1\n"), IoError);
  EXPECT_THROW(read("a.json", "{}"), IoError);
  EXPECT_THROW(read("b.json", "[[1,"), IoError);
  EXPECT_THROW(read("c.csv", "a,b\n1,2\n"), IoError);
  EXPECT_THROW(read("d.txt", ""), IoError);
  EXPECT_THROW(read("e.txt", "one\n"), IoError);
  EXPECT_THROW(read_regions(folder_ / "missing.json", 20, shape_.triangles), IoError);
}

TEST_F(RegionsFile, WeightsSayWhatIsInside) {
  std::string list = "[0, 0.25";
  for (int v = 2; v < 20; ++v) list += v == 6 ? ", 1" : ", 0";
  const Regions soft =
      read("s.json", R"({"regions": [{"vertices": [2, 6]}], "weights": )" + list + "]}");
  EXPECT_EQ(soft.vertex_count(), 2);
  EXPECT_TRUE(soft.inside[1] && soft.inside[6] && !soft.inside[2]);
  const Regions again = read("t.json", regions_json(soft));
  EXPECT_EQ(again.weights, soft.weights);
  EXPECT_EQ(again.inside, soft.inside);
}

TEST_F(RegionsFile, PropertiesOfAnOmFileAreOneRegion) {
  const TriMesh mesh{shape_.positions, Connectivity::from_triangles(20, shape_.triangles)};
  const auto read_with = [&](const std::vector<Field>& fields) {
    std::filesystem::remove(folder_ / "r.om");
    write_mesh(folder_ / "r.om", mesh, {.double_precision = true, .fields = fields});
    return read_regions(folder_ / "r.om", 20, shape_.triangles);
  };
  Eigen::VectorXd mask = Eigen::VectorXd::Zero(20), weights = Eigen::VectorXd::Zero(20);
  for (const int v : {0, 1, 6}) mask[v] = 1;
  weights[0] = 1;
  weights[7] = 0.25;
  const Field roi{"roi", Field::Location::vertices, mask, true};
  const Regions hard = read_with({{"region", Field::Location::vertices, mask, true}, roi});
  ASSERT_EQ(hard.regions.size(), 1u);
  EXPECT_THAT(hard.regions.front().vertices, testing::ElementsAre(0, 1, 6));
  EXPECT_EQ(hard.weights.size(), 0);

  const Regions soft = read_with({roi, {"weight", Field::Location::vertices, weights}});
  EXPECT_EQ(soft.weights, weights);

  const auto message = [&](const std::vector<Field>& fields) {
    return test::message_of<IoError>([&] { read_with(fields); });
  };
  EXPECT_THAT(message({{"region", Field::Location::vertices, mask, true}}),
              testing::HasSubstr("r.om: no field 'roi' of numbers on the vertices; it has region"));
  mask[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({{"roi", Field::Location::vertices, mask}}),
              testing::HasSubstr("'roi' of vertex 3 is nan"));
  EXPECT_THROW(read_regions(folder_ / "r.om", 21, shape_.triangles), MismatchError);
}

TEST_F(RegionsFile, WrongWeightsAreNamed) {
  const auto message = [this](const std::string& weights) {
    return [=, this] {
      read("w.json", R"({"regions": [{"vertices": [2]}], "weights": )" + weights + "}");
    };
  };
  using testing::HasSubstr;
  EXPECT_THAT(message("7"),
              testing::ThrowsMessage<IoError>(
                  HasSubstr("w.json: \"weights\": expected a number for each vertex, found 7")));
  EXPECT_THAT(message("[1, 0]"), testing::ThrowsMessage<MismatchError>(
                                     HasSubstr("\"weights\" of 2 vertices, expected 20")));
  std::string list = "[1";
  for (int v = 1; v < 20; ++v) list += v == 3 ? ", \"a\"" : ", 0";
  EXPECT_THAT(message(list + "]"), testing::ThrowsMessage<IoError>(HasSubstr(
                                       "\"weights\": vertex 3: expected a number, found \"a\"")));
  EXPECT_THAT([this] { read("x.json", "{"); },
              testing::ThrowsMessage<IoError>(HasSubstr("\"weights\"")));
}

TEST_F(RegionsFile, AnEnergyThatIsNotKnownIsNull) {
  const Regions regions = regions_from_vertices(20, shape_.triangles, {{1, 2, 6}});
  const std::string text = regions_json(regions);
  EXPECT_THAT(text, testing::HasSubstr("\"energy_share\": null"));
  const Regions again = read("r.json", text);
  EXPECT_FALSE(again.energy_is_known());
  EXPECT_EQ(again.energy_share, 0);
}

}  // namespace
}  // namespace mimetra
