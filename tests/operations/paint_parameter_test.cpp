#include "toolkit/operations/paint_parameter.h"

#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// A call that is about a grid of 4 x 3 vertices with fields.
class PaintParameter : public testing::Test {
 protected:
  PaintParameter() {
    const test::Shape grid = test::grid(4, 3);
    const auto add = [this](const std::string& name, Eigen::MatrixXd values,
                            Field::Location location = Field::Location::vertices) {
      fields_.push_back({name, location, std::move(values)});
    };
    Eigen::VectorXd lips = Eigen::VectorXd::Zero(12);
    lips.head(3) << 1, 0.5, 0.25;
    add("lips", lips);
    add("percent", 100 * lips);
    add("nothing", 0 * lips);
    add("normal", Eigen::MatrixXd::Ones(12, 3));
    add("area", Eigen::VectorXd::Ones(12), Field::Location::triangles);
    const Frames frames = Positions(grid.positions).reshaped<Eigen::RowMajor>().transpose();
    invocation_.inputs["source"].push_back(
        {"take",
         FieldSequence(MeshSequence(Connectivity::from_triangles(12, grid.triangles), frames),
                       fields_)});
    invocation_.parameters = Parameters({paint_parameter()});
    invocation_.log = [this](LogLevel, const std::string& text) { log_.push_back(text); };
  }

  std::optional<GivenRegions> painted(const std::string& text) {
    invocation_.parameters.set("paint", text);
    return painted_region_of(invocation_);
  }
  template <typename Error>
  void expect_refusal(const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { painted(text); }, ThrowsMessage<Error>(HasSubstr(message)));
  }

  std::vector<Field> fields_;
  Invocation invocation_;
  std::vector<std::string> log_;
};

TEST_F(PaintParameter, IsNoneUnlessItIsGiven) {
  EXPECT_FALSE(painted_region_of(invocation_));
}

TEST_F(PaintParameter, TakesAFieldOnVertices) {
  const auto regions = painted("field:lips");
  ASSERT_TRUE(regions);
  EXPECT_EQ(regions->name, "field:lips");
  EXPECT_THAT(regions->regions.regions.front().vertices, ElementsAre(0, 1, 2));
  EXPECT_EQ(regions->regions.weights[1], 0.5);
  EXPECT_THAT(log_, IsEmpty());
}

TEST_F(PaintParameter, RefusesFieldsThatAreNoWeights) {
  expect_refusal<IoError>("field:percent",
                          "take: field 'percent': vertex 0 has the weight 100, expected 0 to 1; "
                          "divide them by 100 if they are in percent");
  expect_refusal<IoError>("field:nothing", "take: field 'nothing': no vertex has a weight above 0");
  expect_refusal<MismatchError>("field:normal",
                                "take: field 'normal' holds 3 numbers for each vertex");
  expect_refusal<MismatchError>("field:area", "take: field 'area' lies on triangles");
  expect_refusal<MismatchError>(
      "field:lip",
      "take: field 'lip' is not there; there are lips, percent, nothing; did you mean "
      "'lips'?");
}

TEST_F(PaintParameter, IsAFileWhereItNamesNoField) {
  const test::TemporaryFolder folder;
  const std::string path = (folder / "w.csv").string();
  std::ofstream(path) << "vertex,weight\n7,0.75\n";
  EXPECT_EQ(painted(path)->regions.weights[7], 0.75);
  EXPECT_THAT(invocation_.parameters.files(), ElementsAre(path));
  invocation_.parameters.set("paint", "field:lips");
  EXPECT_THAT(invocation_.parameters.files(), IsEmpty());
}

TEST_F(PaintParameter, IsReportedWithTheNumbersOfVertices) {
  Eigen::VectorXd weights(6);
  weights << 0, 0, 0, 0.5, 1, 1;
  EXPECT_EQ(
      weights_report(weights, Parameters({paint_parameter()}), Length::of(12)),
      Json({{"paint", nullptr}, {"falloff", "12abs"}, {"one", 2}, {"between", 1}, {"zero", 3}}));
}

}  // namespace
}  // namespace mimetra
