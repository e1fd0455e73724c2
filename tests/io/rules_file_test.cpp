#include "toolkit/io/rules_file.h"

#include <fstream>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class RulesFileTest : public testing::Test {
 protected:
  WeightRules read(const std::string& text) const {
    std::ofstream(folder_ / "rules.json") << text;
    return read_rules(folder_ / "rules.json");
  }

  void expect_refusal(const std::string& text, const std::string& message) const {
    EXPECT_THAT([&] { read(text); }, ThrowsMessage<IoError>(testing::AllOf(
                                         HasSubstr("rules.json: "), HasSubstr(message))))
        << text;
  }

  test::TemporaryFolder folder_;
};

TEST_F(RulesFileTest, HasPairsGroupsAndExpressions) {
  const WeightRules rules =
      read(R"({"pairs": [["a", "b"], ["c", "d"]], "exclusive": [["a", "c", "e"]],
               "expressions": {"jawOpen": {"minimum": -0.5, "maximum": 0.8, "gain": 1.2},
                               "b": {"offset": 0.1}}})");
  EXPECT_THAT(rules.pairs, ElementsAre(std::array<std::string, 2>{"a", "b"},
                                       std::array<std::string, 2>{"c", "d"}));
  EXPECT_THAT(rules.exclusive, ElementsAre(ElementsAre("a", "c", "e")));
  const ExpressionRule& jaw = rules.expressions.at("jawOpen");
  EXPECT_EQ(jaw.minimum, -0.5);
  EXPECT_EQ(jaw.maximum, 0.8);
  EXPECT_EQ(jaw.gain, 1.2);
  EXPECT_EQ(jaw.offset, 0);
  EXPECT_EQ(rules.expressions.at("b").offset, 0.1);
  EXPECT_EQ(rules.name, (folder_ / "rules.json").string());
}

TEST_F(RulesFileTest, MayBeEmpty) {
  EXPECT_TRUE(read("{}").empty());
  EXPECT_TRUE(read(R"({"pairs": [], "exclusive": [], "expressions": {}})").empty());
}

TEST_F(RulesFileTest, NamesTheElementThatIsWrong) {
  expect_refusal("", "rules as JSON");
  expect_refusal("{\"pairs\": [", "rules as JSON");
  expect_refusal("[]", "/: expected an object of pairs, exclusive and expressions, found a list");
  expect_refusal(R"({"pair": []})",
                 "/pair: is none of pairs, exclusive and expressions; did you "
                 "mean 'pairs'?");
  expect_refusal(R"({"pairs": {"a": "b"}})", "/pairs: expected a list of lists, found an object");
  expect_refusal(R"({"pairs": [["a", "b"], "c"]})", "/pairs/1: expected a list of names");
  expect_refusal(R"({"pairs": [["a", 1]]})", "/pairs/0/1: expected a name, found 1");
  expect_refusal(R"({"pairs": [["a", "b", "c"]]})", "/pairs/0: expected two names, found 3");
  expect_refusal(R"({"pairs": [["a", "a"]]})", "/pairs/0/1: 'a' occurs twice");
  expect_refusal(R"({"exclusive": [["a"]]})", "/exclusive/0: expected two names or more, found 1");
  expect_refusal(R"({"expressions": ["a"]})", "/expressions: expected an object of names");
  expect_refusal(R"({"expressions": {"a": 1}})", "/expressions/a: expected an object of minimum");
  expect_refusal(R"({"expressions": {"a": {"maximun": 1}}})",
                 "/expressions/a/maximun: is none of minimum, maximum, gain and offset; did you "
                 "mean 'maximum'?");
  expect_refusal(R"({"expressions": {"a": {"gain": "2"}}})", "/expressions/a/gain: expected a num");
  expect_refusal(R"({"expressions": {"a": {"offset": 1e999}}})", "number overflow");
  expect_refusal(R"({"expressions": {"a": {"offset": 1e9}}})",
                 "a/offset: expected a number from -1000 to 1000, found 1000000000.0");
}

TEST_F(RulesFileTest, RefusesLimitsThatContradictEachOther) {
  expect_refusal(R"({"expressions": {"a": {"minimum": 0.6, "maximum": 0.5}}})",
                 "/expressions/a: its minimum, 0.6, is above its maximum, 0.5");
  expect_refusal(R"({"expressions": {"a": {"gain": 0}}})", "/expressions/a/gain: expected more");
  expect_refusal(R"({"exclusive": [["b", "a"]], "expressions": {"a": {"minimum": 0.1}}})",
                 "/expressions/a: is in /exclusive/0, where it is 0 beside the others: expected "
                 "limits around 0, found 0.1 to 1");
}

TEST_F(RulesFileTest, AreFoundInAModelsFolder) {
  EXPECT_FALSE(rules_beside(folder_.path()));
  read("{}");
  EXPECT_EQ(rules_beside(folder_.path()), folder_ / "rules.json");
  EXPECT_FALSE(rules_beside(folder_ / "rules.json"));
  EXPECT_FALSE(rules_beside(""));
  std::ofstream(folder_ / "neutral.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THAT(model_files(folder_.path()), Contains(folder_ / "rules.json"));
}

}  // namespace
}  // namespace mimetra
