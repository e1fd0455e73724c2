#include "toolkit/mesh/option.h"

#include <limits>

#include <gmock/gmock.h>

#include "toolkit/mesh/alignment.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::ThrowsMessage;

enum class Kind { thin, thick };

constexpr std::string_view choice_name(Kind value) {
  switch (value) {
    case Kind::thin:
      return "thin";
    case Kind::thick:
      return "thick";
  }
  return {};
}

struct PaperOptions {
  int sheets = 1;
  double weight = 80;
  std::optional<double> gloss = {};
  Kind kind = Kind::thin;
  Length side = Length::of(0.2);
  std::vector<int> pages = {1};

  static constexpr Option kSheets{"sheets", &PaperOptions::sheets, {.minimum = 1}};
  static constexpr Option kWeight{
      "weight", &PaperOptions::weight, {.minimum = 20, .maximum = 400}, "g/m2"};
  static constexpr Option kGloss{"gloss", &PaperOptions::gloss, {.maximum = 1}};
  static constexpr Option kKind{"kind", &PaperOptions::kind};
  static constexpr Option kSide{"side", &PaperOptions::side};
  static constexpr Option kPages{"pages", &PaperOptions::pages, {.minimum = 1}};
  static constexpr auto declared() {
    return std::tuple(kSheets, kWeight, kGloss, kKind, kSide, kPages);
  }
};

void expect_refusal(const PaperOptions& options, const std::string& message) {
  EXPECT_THAT([&] { check_options(options); }, ThrowsMessage<std::invalid_argument>(message));
}

TEST(Option, OutOfRangeIsNamedWithItsRange) {
  expect_refusal({.sheets = 0}, "sheets is 0; it must be at least 1");
  expect_refusal({.weight = 400.5}, "weight is 400.5; it must be from 20 to 400");
  expect_refusal({.gloss = 2}, "gloss is 2; it must be at most 1");
  expect_refusal({.pages = {3, 0}}, "pages is 0; it must be at least 1");
}

TEST(Option, ThatIsNotFiniteIsRefused) {
  EXPECT_THROW(check_options(PaperOptions{.gloss = -std::numeric_limits<double>::infinity()}),
               std::invalid_argument);
  EXPECT_THROW(check_options(PaperOptions{.weight = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

TEST(Option, OfAnEnumIsOneOfItsValues) {
  EXPECT_NO_THROW(check_options(PaperOptions{.kind = Kind::thick}));
  expect_refusal({.kind = static_cast<Kind>(2)}, "kind: no such choice");
}

TEST(Option, OfALengthIsNotBelowZeroAndNoShareAboveOne) {
  EXPECT_NO_THROW(check_options(PaperOptions{.side = Length::of(12)}));
  expect_refusal({.side = Length::share(-0.1)}, "side is -0.1; it must be from 0 to 1");
  expect_refusal({.side = Length::of(-0.1)}, "side is -0.1; it must be at least 0");
  expect_refusal({.side = Length::share(12)}, "side is 12; it must be from 0 to 1");
}

TEST(Length, IsAShareOfTheLongestSideOrAsItIs) {
  EXPECT_EQ(Length::share(0.25).in(8), 2);
  EXPECT_EQ(Length::of(0.25).in(8), 0.25);
}

enum class Unnamed { one, two };

TEST(Choice, HasItsValuesInTheOrderOfTheEnum) {
  EXPECT_THAT(choices<AlignmentVertices>(),
              ElementsAre(AlignmentVertices::stable, AlignmentVertices::all));
  EXPECT_THAT(choice_names<AlignmentVertices>(), ElementsAre("stable", "all"));
}

TEST(Choice, IsFoundByItsNameOnly) {
  EXPECT_EQ(choice_of<AlignmentVertices>("all"), AlignmentVertices::all);
  for (const char* other : {"", "ALL", "al", "alls"}) {
    EXPECT_FALSE(choice_of<AlignmentVertices>(other)) << other;
  }
}

TEST(Choice, NeedsNames) {
  EXPECT_TRUE(NamedChoice<AlignmentVertices>);
  EXPECT_FALSE(NamedChoice<Unnamed>);
  EXPECT_FALSE(NamedChoice<int>);
}

}  // namespace
}  // namespace mimetra
