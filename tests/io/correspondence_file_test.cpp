#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class CorrespondenceFile : public testing::Test {
 protected:
  CorrespondenceFile() {
    pairs_.source_triangles = 8;
    pairs_.parts = {{2, 1.0 / 3}, {5, 2.0 / 3}, {7, 1}};
    pairs_.offsets = {0, 2, 2, 3, 3, 3, 3, 3, 3};
    pairs_.residuals = Eigen::VectorXd::Constant(8, 0.1);
    pairs_.residuals[1] = std::numeric_limits<double>::infinity();
  }
  Correspondence read(const std::string& content) {
    std::ofstream(folder_ / "pairs.json", std::ios::trunc) << content;
    return read_correspondence(folder_ / "pairs.json", source_, target_);
  }
  std::string written() const { return correspondence_json(pairs_, source_, target_); }
  /// What was written, with another value at a place.
  void refused(const char* place, const Json& value, const std::string& why) {
    Json json = parse_json("pairs.json", written());
    json[Json::json_pointer(place)] = value;
    EXPECT_THAT([&] { read(json_text(json)); }, ThrowsMessage<IoError>(HasSubstr(why))) << place;
  }

  const Connectivity source_ = test::mesh_of(test::octahedron()).connectivity;
  const Connectivity target_ = test::mesh_of(test::grid(3, 3)).connectivity;
  Correspondence pairs_;
  test::TemporaryFolder folder_;
};

TEST_F(CorrespondenceFile, ComesBackAfterWritingBitByBit) {
  const Correspondence found = read(written());
  EXPECT_EQ(found.source_triangles, 8);
  EXPECT_EQ(found.parts, pairs_.parts);
  EXPECT_EQ(found.offsets, pairs_.offsets);
  EXPECT_EQ(found.residuals, pairs_.residuals);
}

TEST_F(CorrespondenceFile, IsRefusedForAnotherMesh) {
  std::ofstream(folder_ / "pairs.json") << written();
  Triangles other = target_.triangles;
  other.row(3) << 0, 3, 4;
  const Connectivity changed = Connectivity::from_triangles(9, other);
  const auto read_for_other = [&] {
    read_correspondence(folder_ / "pairs.json", source_, changed);
  };
  EXPECT_THAT(read_for_other, ThrowsMessage<MismatchError>(HasSubstr(
                                  "made for a target of 9 vertices and 8 triangles with other "
                                  "faces than this one, of 9 and 8")));
  EXPECT_THAT([&] { read_correspondence(folder_ / "pairs.json", target_, target_); },
              ThrowsMessage<MismatchError>(HasSubstr("made for a source of 6 vertices")));
}

TEST_F(CorrespondenceFile, NamesWhatIsWrong) {
  refused("/partners/0/0", 8, "triangle 8; the source has triangles 0 to 7");
  refused("/partners/0/0", 4294967296, "triangle 4294967296");
  refused("/partners/0/0", 6, "triangle 5 comes after 6");
  refused("/partners/0/1", 0.5, "the weights of target triangle 0 add up to");
  refused("/partners/0/1", -1, "weight -1, expected one above 0 and up to 1");
  refused("/partners/2", Json::array({1}), "expected a list of triangles and weights");
  refused("/partners/2", 7, "expected a list of triangles and weights");
  refused("/partners", Json::array(), "0 partners and 8 residuals, expected 8");
  refused("/residuals/3", "far", "expected a distance");
  refused("/source", 3, "expected {\"source\"");
  EXPECT_THAT([&] { read("[1, 2"); }, ThrowsMessage<IoError>(HasSubstr("pairs.json")));
}

TEST_F(CorrespondenceFile, SaysTheSameOfPolygonsAndTheirTriangles) {
  Polygons quads;
  quads.corners = {0, 1, 4, 3};
  quads.offsets = {0, 4};
  const Connectivity quad = Connectivity::from_polygons(5, quads);
  const Connectivity triangles = Connectivity::from_triangles(5, quad.triangles);
  const Correspondence pairs = Correspondence::identity(2);
  std::ofstream(folder_ / "q.json") << correspondence_json(pairs, quad, quad);
  EXPECT_EQ(read_correspondence(folder_ / "q.json", triangles, quad).parts, pairs.parts);
}

}  // namespace
}  // namespace mimetra
