#include "toolkit/mesh/parameter.h"

#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "toolkit/operations/call.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

enum class Room { open, closed };

constexpr std::string_view choice_name(Room value) {
  switch (value) {
    case Room::open:
      return "open";
    case Room::closed:
      return "closed";
  }
  return {};
}

/// A call with values of these parameters, and the input "map".
class ExclusionTest : public testing::Test {
 protected:
  ExclusionTest() {
    Parameter files{"files", ParameterKind::file, std::string("auto"), ""};
    files.several = true;
    files.choices = {"auto"};
    parameters_ = Parameters({{"full", ParameterKind::flag, false, ""},
                              {"k", ParameterKind::integer, std::int64_t{3}, ""},
                              choice_parameter("room", Room::open, ""),
                              std::move(files)});
  }

  std::string refused(std::vector<std::string> terms, std::vector<std::string> beside) const {
    const auto has_value = [](const std::string& name) { return name == "map"; };
    return refusal({{std::move(terms), std::move(beside), "why"}}, parameters_, has_value)
        .value_or("");
  }

  Parameters parameters_;
};

TEST_F(ExclusionTest, HoldsBesideOneOfSeveral) {
  EXPECT_EQ(refused({"k"}, {"full", "map"}), "");
  parameters_.set("k", std::int64_t{3});
  EXPECT_EQ(refused({"k"}, {"full", "room=closed"}), "");
  EXPECT_EQ(refused({"k"}, {"full", "map"}), "-k: why");
  EXPECT_EQ(refused({"full", "k"}, {"map"}), "-k: why");
  EXPECT_EQ(refused({"map"}, {"k"}), "--map: why");
}

TEST_F(ExclusionTest, HoldsWhereAllPartsOfATermDo) {
  parameters_.set("k", std::int64_t{1});
  EXPECT_EQ(refused({"k"}, {"map full"}), "");
  EXPECT_EQ(refused({"k"}, {"map !full"}), "-k: why");
}

TEST_F(ExclusionTest, OfAValueHoldsByDefaultToo) {
  EXPECT_EQ(refused({"room=open"}, {"map"}), "--room open: why");
  EXPECT_EQ(refused({"!room=open"}, {"map"}), "");
  parameters_.set("room", std::string("closed"));
  EXPECT_EQ(refused({"!room=open"}, {"map"}), "--room: why");
}

TEST_F(ExclusionTest, TakesAFlagThatIsFalseAndAWordForNothing) {
  parameters_.set("full", false);
  parameters_.set("files", std::string("auto"));
  EXPECT_EQ(refused({"full", "files"}, {"map"}), "");
  parameters_.set("files", std::string("auto,a.txt"));
  EXPECT_EQ(refused({"full", "files"}, {"map"}), "--files: why");
}

/// The operations of the toolkit.
const OperationTable& all_operations() {
  static const OperationTable table = [] {
    OperationTable made;
    add_toolkit(made);
    add_markers(made);
    return made;
  }();
  return table;
}

/// "regions" of "!regions=all".
std::string name_in(const std::string& term) {
  const std::size_t begin = term.starts_with('!') ? 1 : 0;
  return term.substr(begin, term.find('=') - begin);
}

TEST(Exclusions, NameWhatOperationsHave) {
  std::set<std::string> known;
  for (const Operation& operation : all_operations().operations()) {
    for (const Input& input : operation.inputs) known.insert(input.name);
    for (const Output& output : operation.outputs) known.insert(output.name);
    for (const Parameter& parameter : operation.parameters) known.insert(parameter.name);
  }
  for (const Operation& operation : all_operations().operations()) {
    for (const Exclusion& exclusion : operation.exclusions) {
      for (const auto& terms : {exclusion.refused, exclusion.beside}) {
        for (const std::string& term : terms) {
          std::istringstream words(term);
          for (std::string word; words >> word;) {
            EXPECT_TRUE(known.contains(name_in(word))) << operation.name << ": " << term;
          }
        }
      }
    }
  }
}

TEST(Exclusions, LetEveryOperationHaveItsDefaults) {
  for (const Operation& operation : all_operations().operations()) {
    const auto found = refusal(operation.exclusions, Parameters(operation.parameters),
                               [](const std::string&) { return false; });
    EXPECT_EQ(found.value_or(""), "") << operation.name;
  }
}

TEST(Exclusions, AreRefusedBeforeInputsAreRead) {
  CallRequest request;
  request.operation = all_operations().find("transfer");
  request.parameters = Parameters(all_operations().parameters_of(*request.operation));
  request.parameters.set("full", true);
  request.named = {{"source", {"nowhere.npy"}}, {"target", {"nowhere.obj"}}};
  request.wanted = {"regions-out"};
  EXPECT_THAT([&] { Call(all_operations(), request); },
              ThrowsMessage<UsageError>("--regions-out: there are no regions with --full"));
  request.wanted = {};
  request.parameters.set("rho", 3.0);
  EXPECT_THAT([&] { Call(all_operations(), request); },
              ThrowsMessage<UsageError>(HasSubstr("--rho: no regions are looked for")));
}

}  // namespace
}  // namespace mimetra
