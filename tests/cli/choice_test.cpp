#include <gmock/gmock.h>

#include "toolkit/cli/command_line.h"
#include "toolkit/mesh/bound_parameters.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// What an option chooses: two values as in most options of the toolkit, and a third one.
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

struct PickOptions {
  Fruit fruit = Fruit::pear;

  static constexpr Option kFruit{"fruit", &PickOptions::fruit};
  static constexpr auto declared() { return std::tuple(kFruit); }
};

BoundParameters<PickOptions> pick_parameters() {
  BoundParameters<PickOptions> list;
  return list.add("fruit", PickOptions::kFruit, "what is picked");
}

/// The algorithm, which knows no names.
int stones_of(const PickOptions& options) {
  check_options(options);
  switch (options.fruit) {
    case Fruit::apple:
    case Fruit::pear:
      return 0;
    case Fruit::plum:
      return 1;
  }
  return -1;
}

OperationTable orchard() {
  Operation pick;
  pick.name = "pick";
  pick.summary = "Pick a fruit";
  pick.parameters = pick_parameters().declared();
  pick.run = [](const Invocation& invocation) {
    const int stones = stones_of(pick_parameters().read(invocation.parameters));
    return Outcome{{}, "{}", std::to_string(stones) + " stones"};
  };
  OperationTable table;
  table.add(std::move(pick));
  return table;
}

/// What the operation of a command line says.
std::string said_by(const std::vector<std::string>& arguments) {
  const OperationTable table = orchard();
  const cli::Request request = *cli::parse_command_line(table, arguments).request;
  Invocation invocation;
  invocation.parameters = request.parameters;
  return request.operation->run(invocation).summary;
}

TEST(ThirdChoice, IsNamedByTheHelp) {
  EXPECT_THAT(cli::parse_command_line(orchard(), {"pick", "--help"}).text,
              HasSubstr("{apple,pear,plum} (default pear)"));
}

TEST(ThirdChoice, IsTheOneThatRuns) {
  EXPECT_EQ(said_by({"pick", "--fruit", "plum"}), "1 stones");
  EXPECT_EQ(said_by({"pick", "--fruit", "apple"}), "0 stones");
  EXPECT_EQ(said_by({"pick"}), "0 stones");
}

TEST(ThirdChoice, IsNamedWhereAnotherIsRefused) {
  EXPECT_THAT(
      [] {
        said_by({"pick", "--fruit", "peach"});
      },
      ThrowsMessage<UsageError>("--fruit: expected one of apple, pear, plum, found 'peach'"));
}

TEST(ThirdChoice, IsTheLastThatTheAlgorithmTakes) {
  EXPECT_EQ(stones_of({.fruit = Fruit::plum}), 1);
  EXPECT_THROW(stones_of({.fruit = static_cast<Fruit>(3)}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
