#include <algorithm>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "tests/cli/bad_input.h"
#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using test::BadInput;

std::vector<BadInput> all_cases() {
  std::vector<BadInput> all;
  for (const auto& cases : {test::mesh_cases(),   test::sequence_cases(), test::array_cases(),
                            test::hdf5_cases(),   test::scene_cases(),    test::model_cases(),
                            test::weight_cases(), test::eos_cases(),      test::component_cases(),
                            test::region_cases(), test::paint_cases(),    test::json_cases(),
                            test::motion_cases(), test::geometry_cases(), test::request_cases(),
                            test::output_cases(), test::hostile_cases(),  test::fit_cases(),
                            test::match_cases(),  test::retarget_cases(), test::rig_cases()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

class BadInputTest : public test::QuickCommandTest, public testing::WithParamInterface<BadInput> {
 protected:
  /// Only the command itself lists VTK's formats.
  test::CommandResult run_case(const std::string& arguments) const {
    const BadInput& bad = GetParam();
    const auto lists_them = [](const std::string& part) {
      return part.find(".vtp") != std::string::npos;
    };
    return std::ranges::any_of(bad.says, lists_them) ? CommandTest::run(arguments, bad.prefix)
                                                     : run(arguments, bad.prefix);
  }

  /// Every file below the test's folder with what it holds.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> contents;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      const bool is_file = entry.is_regular_file();
      contents[entry.path().lexically_relative(folder_)] = is_file ? text_of(entry.path()) : "";
    }
    return contents;
  }
};

TEST_P(BadInputTest, GivesItsExitCodeAndMessageAndLeavesNothing) {
  const BadInput& bad = GetParam();
  if (bad.make) bad.make(folder_);
  const auto before = contents();
  const auto result = run_case(bad.arguments);
  EXPECT_EQ(result.code, bad.code) << bad.arguments << '\n' << result.err;
  const std::string said = bad.code == 0 ? result.out + result.err : result.err;
  for (const std::string& part : bad.says) EXPECT_THAT(said, testing::HasSubstr(part));
  const auto after = contents();
  if (bad.code != 0) {
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(after, before);
  }
  for (const auto& [name, content] : after) {
    const bool is_new = !before.contains(name);
    EXPECT_FALSE(is_new && name.find(".tmp") != std::string::npos) << name << " was left behind";
  }
}

/// What is wrong with weights, maps, examples and markers is foreseen.
class ForeseenTest : public BadInputTest {};

TEST_P(ForeseenTest, IsRefusedByADryRunAsByTheRun) {
  const BadInput& bad = GetParam();
  if (bad.make) bad.make(folder_);
  const auto before = contents();
  const auto result = run_case(bad.arguments + " --dry-run");
  EXPECT_EQ(result.code, bad.code) << bad.arguments << '\n' << result.err;
  if (bad.code != 0) {
    for (const std::string& part : bad.says) EXPECT_THAT(result.err, testing::HasSubstr(part));
  }
  EXPECT_EQ(contents(), before);
}

std::vector<BadInput> foreseen_cases() {
  // Whether a face is found in drawings of a mesh, the run alone finds out.
  const std::set<std::string> drawn = {"other_faces_without_markers", "no_face",
                                       "rig_of_other_faces"};
  std::vector<BadInput> all;
  for (const auto& cases : {test::match_cases(), test::retarget_cases(), test::rig_cases()}) {
    std::ranges::copy_if(cases, std::back_inserter(all),
                         [&drawn](const BadInput& bad) { return !drawn.contains(bad.kind); });
  }
  return all;
}

std::string name_of(const testing::TestParamInfo<BadInput>& info) {
  return info.param.subject + "__" + info.param.kind;
}

INSTANTIATE_TEST_SUITE_P(Every, BadInputTest, testing::ValuesIn(all_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Every, ForeseenTest, testing::ValuesIn(foreseen_cases()), name_of);

/// Shown by `cli_test --gtest_filter='TableOfBadInput*'`; the same table is in docs/errors.md in
/// words.
TEST(TableOfBadInput, NamesEachCaseOnceAndKnowsItsExitCode) {
  std::map<std::string, std::map<std::string, int>> table;
  for (const BadInput& bad : all_cases()) {
    EXPECT_TRUE(table[bad.kind].emplace(bad.subject, bad.code).second)
        << bad.subject << ' ' << bad.kind << " is there twice";
    EXPECT_THAT(bad.code, testing::AnyOf(0, 2, 3, 4, 5));
  }
  for (const auto& [kind, subjects] : table) {
    std::cout << std::left << std::setw(28) << kind;
    for (const auto& [subject, code] : subjects) std::cout << ' ' << subject << ':' << code;
    std::cout << '\n';
  }
}

}  // namespace
}  // namespace mimetra
