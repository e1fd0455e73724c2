#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {
namespace {

const Parameter kCount{"k", ParameterKind::integer, std::int64_t{30}, "components", "", 1, 100};
const Parameter kRadius{"radius", ParameterKind::length, "0.1", "radius"};
const Parameter kShape{"shape", ParameterKind::choice, "disc", "shape", "", {},
                       {},      {"disc", "support"}};

std::string message_of(const Parameter& parameter, const std::string& text) {
  return test::message_of<UsageError>([&] { parse_value(parameter, text); });
}

TEST(Parameter, ParsesEachKindFromText) {
  EXPECT_EQ(parse_value(kCount, "10"), ParameterValue(std::int64_t{10}));
  EXPECT_EQ(parse_value(kShape, "support"), ParameterValue("support"));
  EXPECT_EQ(parse_value({"x", ParameterKind::number, {}, ""}, "2.5e-1"), ParameterValue(0.25));
  EXPECT_EQ(parse_value({"x", ParameterKind::number, {}, ""}, "24000/1001"),
            ParameterValue(24000.0 / 1001.0));
  EXPECT_EQ(parse_value({"x", ParameterKind::flag, false, ""}, "true"), ParameterValue(true));
  EXPECT_EQ(parse_value({"x", ParameterKind::integer_list, {}, ""}, "10,30,40"),
            ParameterValue(std::vector<std::int64_t>{10, 30, 40}));
}

TEST(Parameter, RefusesTextThatIsNoValueOfItsKind) {
  const Parameter number{"x", ParameterKind::number, {}, ""};
  for (const char* text : {"1/0", "0/0", "1/", "/2", "1/2/3", "a/2", "1 / 2", "inf", "nan"}) {
    EXPECT_THAT(message_of(number, text), testing::HasSubstr("-x: expected a number, found '"))
        << text;
  }
  EXPECT_THROW(parse_value(kRadius, "-0.1"), UsageError);
  EXPECT_THROW(parse_value(kRadius, "12mm"), UsageError);
  const Parameter list{"k", ParameterKind::integer_list, {}, "", "", 1};
  for (const char* text : {"10,0", "", "10,x"}) {
    EXPECT_THROW(parse_value(list, text), UsageError) << text;
  }
}

enum class Fruit { apple, pear, plum };

constexpr std::string_view choice_name(Fruit value) {
  switch (value) {
    case Fruit::apple:
      return "apple";
    case Fruit::pear:
      return "pear";
    case Fruit::plum:
      return "plum";
  }
  return {};
}

TEST(Parameter, IsNoShareAboveOne) {
  EXPECT_EQ(parse_value(kRadius, "1"), ParameterValue("1"));
  EXPECT_EQ(parse_value(kRadius, "12abs"), ParameterValue("12abs"));
  EXPECT_EQ(message_of(kRadius, "12"),
            "--radius: expected a share of the diameter, up to 1, as in 0.1, or a length as in "
            "12abs, found '12'");
}

TEST(Parameter, OfAnEnumTakesEachOfItsValuesByName) {
  const Parameter parameter = choice_parameter("fruit", Fruit::pear, "what is picked");
  EXPECT_THAT(parameter.choices, testing::ElementsAre("apple", "pear", "plum"));
  Parameters parameters({parameter});
  EXPECT_EQ(parameters.choice<Fruit>("fruit"), Fruit::pear);
  for (const Fruit fruit : choices<Fruit>()) {
    parameters.set("fruit", parse_value(parameter, std::string(choice_name(fruit))));
    EXPECT_EQ(parameters.choice<Fruit>("fruit"), fruit);
  }
  EXPECT_EQ(message_of(parameter, "peach"),
            "--fruit: expected one of apple, pear, plum, found 'peach'");
}

TEST(Parameters, GiveNoChoiceOfAnotherEnum) {
  Parameters parameters({kShape});
  EXPECT_THROW(parameters.choice<Fruit>("shape"), std::invalid_argument);
}

TEST(Parameter, OfAPathTakesTheValuesOfAnEnumBesideIt) {
  const Parameter parameter = file_parameter<Fruit>("rest", {}, "a fruit, or a file");
  Parameters parameters({parameter});
  EXPECT_FALSE(parameters.optional_text("rest"));
  parameters.set("rest", "plum");
  EXPECT_THAT(parameters.files(), testing::IsEmpty());
  parameters.set("rest", "tree.obj");
  EXPECT_THAT(parameters.files(), testing::ElementsAre("tree.obj"));
}

TEST(Parameter, NamesOptionRangeAndWhatWasFound) {
  EXPECT_EQ(message_of(kCount, "0"), "-k: expected a whole number from 1 to 100, found '0'");
  EXPECT_EQ(message_of(kCount, "ten"), "-k: expected a whole number from 1 to 100, found 'ten'");
  EXPECT_EQ(message_of(kShape, "ball"), "--shape: expected one of disc, support, found 'ball'");
}

TEST(Parameter, TellsTheRangeOfWholeNumbersInWholeNumbers) {
  Parameter count = kCount;
  count.maximum = 1e6;
  EXPECT_EQ(message_of(count, "0"), "-k: expected a whole number from 1 to 1000000, found '0'");
  count.minimum = -1e300;
  count.maximum = 2.5;
  EXPECT_EQ(count.minimum_text(), "-2147483647");
  EXPECT_EQ(count.maximum_text(), "2");
  count.kind = ParameterKind::number;
  EXPECT_EQ(count.maximum_text(), "2.5");
  count.maximum.reset();
  EXPECT_EQ(count.maximum_text(), "");
}

TEST(Parameter, TextOfAValueParsesBackToIt) {
  for (const double number : {0.1, 1e-300, 12345.678, 1.0 / 3}) {
    const Parameter parameter{"x", ParameterKind::number, {}, ""};
    EXPECT_EQ(parse_value(parameter, to_text(number)), ParameterValue(number));
  }
}

TEST(Parameters, AreTheirDefaultsUntilSet) {
  Parameters parameters({kCount, kRadius});
  EXPECT_EQ(parameters.integer("k"), 30);
  EXPECT_FALSE(parameters.is_set("k"));
  parameters.set("k", std::int64_t{5});
  EXPECT_EQ(parameters.integer("k"), 5);
  EXPECT_TRUE(parameters.is_set("k"));
}

TEST(Parameters, RefuseUnknownNamesAndWrongTypes) {
  Parameters parameters({kCount});
  EXPECT_THROW(parameters.set("count", std::int64_t{5}), UsageError);
  EXPECT_THROW(parameters.set("k", "five"), UsageError);
}

TEST(Parameters, LengthsAreSharesOfTheExtentUnlessAbsolute) {
  Parameters parameters({kRadius});
  EXPECT_DOUBLE_EQ(parameters.length("radius").in(200), 0.1 * 200);
  parameters.set("radius", "12abs");
  EXPECT_DOUBLE_EQ(parameters.length("radius").in(200), 12);
}

}  // namespace
}  // namespace mimetra
