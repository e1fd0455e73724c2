#include "toolkit/mesh/bound_parameters.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

enum class Produce { apple, pear, plum };

constexpr std::string_view choice_name(Produce value) {
  switch (value) {
    case Produce::apple:
      return "apple";
    case Produce::pear:
      return "pear";
    case Produce::plum:
      return "plum";
  }
  return {};
}

enum class Nameless { one, two };

struct BasketOptions {
  int count = 3;
  double weight = 1.5;
  std::optional<double> price = {};
  bool closed = true;
  Produce fruit = Produce::pear;
  Length size = Length::share(0.25);
  std::vector<int> days = {1, 2};
  std::variant<Produce, std::string> label = Produce::apple;
  std::string owner = {};
  std::vector<int> lids = {};
  std::optional<std::filesystem::path> list = {};
  std::optional<std::string> note = {};

  static constexpr Option kCount{"count", &BasketOptions::count, {.minimum = 1, .maximum = 9}};
  static constexpr Option kWeight{"weight", &BasketOptions::weight, {.minimum = 0}, "kg"};
  static constexpr Option kPrice{"price", &BasketOptions::price};
  static constexpr Option kClosed{"closed", &BasketOptions::closed};
  static constexpr Option kFruit{"fruit", &BasketOptions::fruit};
  static constexpr Option kSize{"size", &BasketOptions::size};
  static constexpr Option kDays{"days", &BasketOptions::days, {.minimum = 1}};
  static constexpr Option kLabel{"label", &BasketOptions::label};
  static constexpr Option kOwner{"owner", &BasketOptions::owner};
  static constexpr Option kLids{"lids", &BasketOptions::lids};
  static constexpr Option kList{"list", &BasketOptions::list};
  static constexpr Option kNote{"note", &BasketOptions::note};
};

BoundParameters<BasketOptions> basket_parameters(const BasketOptions& defaults = {}) {
  BoundParameters<BasketOptions> list(defaults);
  list.add("count", BasketOptions::kCount, "how many")
      .add("weight", BasketOptions::kWeight, "of each")
      .add("price", BasketOptions::kPrice, "of all")
      .add_opposite("open", BasketOptions::kClosed, "no lid")
      .add("fruit", BasketOptions::kFruit, "which")
      .add("size", BasketOptions::kSize, "of the basket")
      .add("days", BasketOptions::kDays, "when")
      .add_word_or_file<Produce, std::string>(
          "label", BasketOptions::kLabel, "on it",
          [](const std::string& path, const FieldSequence*) { return "at " + path; })
      .add("owner", BasketOptions::kOwner, "of it")
      .add("lids", BasketOptions::kLids, "of it")
      .add("list", BasketOptions::kList, "what to buy")
      .add("note", BasketOptions::kNote, "to the owner");
  return list;
}

Parameters values_of(const BoundParameters<BasketOptions>& list) {
  return Parameters(list.declared());
}

TEST(BoundParameters, HaveDefaultRangeAndUnitOfTheirMember) {
  const auto declared = basket_parameters().declared();
  EXPECT_EQ(declared[0].kind, ParameterKind::integer);
  EXPECT_EQ(declared[0].fallback, ParameterValue(std::int64_t{3}));
  EXPECT_EQ(declared[0].minimum, 1);
  EXPECT_EQ(declared[0].maximum, 9);
  EXPECT_EQ(declared[1].fallback, ParameterValue(1.5));
  EXPECT_EQ(declared[1].unit, "kg");
  EXPECT_FALSE(declared[1].maximum);
  EXPECT_EQ(declared[2].fallback, ParameterValue());
  EXPECT_EQ(declared[3].fallback, ParameterValue(false));
  EXPECT_THAT(declared[4].choices, ElementsAre("apple", "pear", "plum"));
  EXPECT_EQ(declared[5].kind, ParameterKind::length);
  EXPECT_EQ(declared[5].fallback, ParameterValue("0.25"));
  EXPECT_EQ(declared[6].fallback, ParameterValue(std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(declared[7].kind, ParameterKind::file);
  EXPECT_EQ(declared[7].fallback, ParameterValue("apple"));
  EXPECT_EQ(declared[8].kind, ParameterKind::text);
  EXPECT_EQ(declared[9].kind, ParameterKind::integer_list);
  EXPECT_EQ(declared[10].kind, ParameterKind::file);
  EXPECT_EQ(declared[11].kind, ParameterKind::text);
}

TEST(BoundParameters, HaveNoDefaultWhereTheMemberHoldsNothing) {
  const auto declared = basket_parameters().declared();
  for (std::size_t i = 8; i < 12; ++i) EXPECT_EQ(declared[i].fallback, ParameterValue());
  const auto filled = basket_parameters({.owner = "Ada", .lids = {3}, .list = "a.txt"}).declared();
  EXPECT_EQ(filled[8].fallback, ParameterValue("Ada"));
  EXPECT_EQ(filled[9].fallback, ParameterValue(std::vector<std::int64_t>{3}));
  EXPECT_EQ(filled[10].fallback, ParameterValue("a.txt"));
}

template <typename Value>
struct Holder {
  Value value = {};
};

/// Whether a parameter can be bound to a member of that type.
template <typename Value>
concept IsBound = requires(BoundParameters<Holder<Value>> list) {
  list.add("value", Option("value", &Holder<Value>::value), "");
};

TEST(BoundParameters, DoNotCompileForAnEnumWithoutNames) {
  static_assert(IsBound<Produce> && IsBound<int> && IsBound<std::optional<std::string>>);
  static_assert(!IsBound<Nameless> && !IsBound<std::optional<Nameless>>);
  static_assert(!IsBound<const char*>);
}

TEST(BoundParameters, ReadTheDefaultsWhereNothingIsSet) {
  const BasketOptions defaults{.count = 7, .size = Length::of(4)};
  const auto list = basket_parameters(defaults);
  const BasketOptions read = list.read(values_of(list));
  EXPECT_EQ(read.count, 7);
  EXPECT_TRUE(read.closed);
  EXPECT_TRUE(read.size.absolute);
  EXPECT_EQ(read.size.value, 4);
  EXPECT_EQ(std::get<Produce>(read.label), Produce::apple);
  EXPECT_EQ(read.owner, "");
  EXPECT_THAT(read.lids, testing::IsEmpty());
  EXPECT_FALSE(read.list);
  EXPECT_FALSE(read.note);
}

TEST(BoundParameters, ReadEachValueThatIsSetIntoItsMember) {
  const auto list = basket_parameters();
  Parameters values = values_of(list);
  values.set("count", std::int64_t{5});
  values.set("weight", 0.5);
  values.set("price", 2.0);
  values.set("open", true);
  values.set("fruit", "apple");
  values.set("size", "12abs");
  values.set("days", std::vector<std::int64_t>{4});
  values.set("label", "tag.txt");
  values.set("owner", "Ada");
  values.set("lids", std::vector<std::int64_t>{7});
  values.set("list", "list.txt");
  values.set("note", "fresh");
  const BasketOptions read = list.read(values);
  EXPECT_EQ(read.count, 5);
  EXPECT_EQ(read.weight, 0.5);
  EXPECT_EQ(read.price, 2.0);
  EXPECT_FALSE(read.closed);
  EXPECT_EQ(read.fruit, Produce::apple);
  EXPECT_EQ(read.size.in(100), 12);
  EXPECT_THAT(read.days, ElementsAre(4));
  EXPECT_EQ(std::get<std::string>(read.label), "at tag.txt");
  EXPECT_EQ(read.owner, "Ada");
  EXPECT_THAT(read.lids, ElementsAre(7));
  EXPECT_EQ(read.list, "list.txt");
  EXPECT_EQ(read.note, "fresh");
}

TEST(BoundParameters, OfAPartAreReadIntoThatPart) {
  struct Shop {
    BasketOptions basket = {};
  };
  BoundParameters<Shop> list;
  list.add(&Shop::basket, basket_parameters());
  Parameters values(list.declared());
  values.set("count", std::int64_t{2});
  EXPECT_EQ(list.read(values).basket.count, 2);
}

/// The next number beyond an end of a range.
double beyond(double end, double direction, bool whole) {
  return whole ? end + std::copysign(1, direction) : std::nextafter(end, direction);
}

std::string typed(double number, bool whole) {
  return whole ? to_text(static_cast<std::int64_t>(number)) : to_text(number);
}

/// The command refuses what the algorithm refuses, and takes what it takes.
template <typename Options, typename Value>
void expect_same_limits(const BoundParameters<Options>& list, const std::string& name,
                        const Option<Options, Value>& option) {
  const auto declared = list.declared();
  const auto parameter = std::ranges::find(declared, name, &Parameter::name);
  ASSERT_NE(parameter, declared.end()) << name;
  constexpr bool kWhole = std::is_same_v<Value, int> || std::is_same_v<Value, std::optional<int>>;
  const auto check = [&](double end, double direction) {
    Options options;
    options.*option.member = static_cast<Value>(end);
    EXPECT_NO_THROW(check_options(options)) << name;
    EXPECT_NO_THROW(parse_value(*parameter, typed(end, kWhole))) << name;
    const double outside = beyond(end, direction, kWhole);
    options.*option.member = static_cast<Value>(outside);
    EXPECT_THROW(check_options(options), std::invalid_argument) << name;
    EXPECT_THROW(parse_value(*parameter, typed(outside, kWhole)), UsageError) << name;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (option.range.minimum) check(*option.range.minimum, -kInfinity);
  if (option.range.maximum) check(*option.range.maximum, kInfinity);
}

TEST(BoundParameters, HaveTheLimitsThatTheAlgorithmsCheck) {
  using Decomposition = DecompositionOptions;
  BoundParameters<Decomposition> decomposition;
  decomposition.add("rho", Decomposition::kRho, "")
      .add("iterations", Decomposition::kIterations, "")
      .add("basis-tolerance", Decomposition::kBasisTolerance, "");
  expect_same_limits(decomposition, "rho", Decomposition::kRho);
  expect_same_limits(decomposition, "iterations", Decomposition::kIterations);
  expect_same_limits(decomposition, "basis-tolerance", Decomposition::kBasisTolerance);
  using Vertex = VertexTransferOptions;
  BoundParameters<Vertex> vertex;
  vertex.add("outside-weight", Vertex::kOutsideWeight, "");
  expect_same_limits(vertex, "outside-weight", Vertex::kOutsideWeight);
}

/// Parameters of the operation transfer, as the table has it.
std::vector<Parameter> transfer_declares() {
  OperationTable table;
  add_toolkit(table);
  return table.find("transfer")->parameters;
}

TEST(PipelineParameters, AreThoseThatTheTableDeclares) {
  const auto declared = transfer_declares();
  for (const auto& group : {count_parameters().declared(), analysis_parameters().declared(),
                            solving_parameters().declared(), region_parameters().declared()}) {
    for (const Parameter& parameter : group) {
      const auto found = std::ranges::find(declared, parameter.name, &Parameter::name);
      ASSERT_NE(found, declared.end()) << parameter.name;
      EXPECT_EQ(found->fallback, parameter.fallback) << parameter.name;
      EXPECT_EQ(found->minimum, parameter.minimum) << parameter.name;
      EXPECT_EQ(found->maximum, parameter.maximum) << parameter.name;
    }
  }
}

TEST(PipelineParameters, HaveTheDefaultsOfTheApi) {
  const Parameters values(transfer_declares());
  const AnalysisOptions analysis = analysis_parameters().read(values);
  EXPECT_EQ(analysis.d_min.value, AnalysisOptions{}.d_min.value);
  EXPECT_EQ(analysis.rho, DecompositionOptions{}.rho);
  EXPECT_EQ(analysis.nonnegative, DecompositionOptions{}.nonnegative);
  EXPECT_EQ(count_parameters().read(values).count, AnalysisOptions{}.count);
  const SolveOptions solve = solving_parameters().read(values);
  EXPECT_EQ(solve.outside_weight, VertexTransferOptions{}.outside_weight);
  EXPECT_FALSE(solve.anchor);
}

TEST(PipelineParameters, TakeAnAnchorByNameOrNumber) {
  Parameters values(solving_parameters().declared());
  const auto anchor = [&](const std::string& text) {
    values.set("anchor", text);
    return solving_parameters().read(values);
  };
  EXPECT_EQ(anchor("source").anchor, Anchor::source_motion);
  EXPECT_EQ(anchor("centroid").anchor, Anchor::centroid);
  EXPECT_EQ(anchor("7").anchor, Anchor::vertex);
  EXPECT_EQ(anchor("7").anchor_vertex, 7);
  EXPECT_THAT([&] { anchor("nose"); },
              ThrowsMessage<UsageError>(HasSubstr("--anchor: expected a whole number")));
}

TEST(PipelineParameters, LeaveFilesUnreadWithoutAMesh) {
  Parameters values(alignment_parameters().declared());
  values.set("align", "nowhere.json");
  EXPECT_TRUE(alignment_parameters().read(values).head_motion);
}

std::string refusal_of(Topic topic) {
  Parameters values(analysis_parameters().declared());
  return test::message_of<std::invalid_argument>(
      [&] { refuse(OptionError(topic, "something"), values); });
}

TEST(CommandTerms, NameTheOptionThatHelps) {
  EXPECT_EQ(refusal_of(Topic::component_count), "-k: something");
  EXPECT_EQ(refusal_of(Topic::no_vertex_inside), "--only, --without: something");
  EXPECT_EQ(refusal_of(Topic::no_expressions), "something; use --space vertex");
  EXPECT_EQ(refusal_of(Topic::support_range),
            "--d-min: expected less than --d-max, found 0.1 and 0.7");
  EXPECT_EQ(refusal_of(Topic::other), "something");
  EXPECT_THROW(refuse(OptionError(Topic::held_anchor, ""), Parameters()), UsageError);
  EXPECT_THROW(refuse(OptionError(Topic::anchor_vertex, ""), Parameters()), MismatchError);
}

TEST(CommandTerms, AreAddedToNotes) {
  std::vector<std::string> warnings;
  Invocation call;
  call.log = [&warnings](LogLevel, const std::string& text) { warnings.push_back(text); };
  const std::string unknown = "take: its neutral is not known";
  with_notes_as_warnings(call).note(unknown, Topic::unknown_neutral);
  with_notes_as_warnings(call).note("plain");
  // By the option that the operation has.
  call.parameters = Parameters(source_rest_parameters().declared());
  with_notes_as_warnings(call).note(unknown, Topic::unknown_neutral);
  EXPECT_THAT(warnings, ElementsAre(unknown + "; give it with --rest FILE", "plain",
                                    unknown + "; give it with --source-rest FILE"));
}

}  // namespace
}  // namespace mimetra
