#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Options of weights, and rules in a file or in a model's folder.
class RulesTest : public test::QuickCommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("low.json", R"({"expressions": {"top": {"maximum": 0.25}}})");
  }

  void expect_failure(const std::string& arguments, int code, const std::string& message) const {
    const auto before = listing();
    const auto result = run(transfer_ + arguments);
    EXPECT_EQ(result.code, code) << arguments << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(listing(), before) << arguments;
  }

  std::string weights_of(const std::string& arguments, const std::string& name) const {
    const auto result = run(transfer_ + arguments + " -o " + name + ".npy --weights-out " + name);
    EXPECT_EQ(result.code, 0) << arguments << '\n' << result.err;
    return text_of(folder_ / name);
  }

  /// The largest number in a column of a table.
  static double largest(const std::string& csv, int column) {
    std::istringstream lines(csv);
    std::string line, cell;
    std::getline(lines, line);
    double most = 0;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      for (int c = 0; c <= column; ++c) std::getline(cells, cell, ',');
      most = std::max(most, std::stod(cell));
    }
    return most;
  }

  static constexpr int kTop = 3;
  const std::string transfer_ = "transfer head --weights take.csv head@wide=1 --full ";
};

TEST_F(RulesTest, BoundWhatIsWritten) {
  EXPECT_GT(largest(weights_of("", "free.csv"), kTop), 0.5);
  EXPECT_EQ(largest(weights_of("--rules low.json", "low.csv"), kTop), 0.25);
  EXPECT_EQ(weights_of("--rules none", "none.csv"), text_of(folder_ / "free.csv"));
}

TEST_F(RulesTest, AreTakenFromAModelsFolderWhichIsSaid) {
  const std::string asked = weights_of("--rules low.json", "low.csv");
  std::filesystem::rename(folder_ / "low.json", folder_ / "head/rules.json");
  const auto result = run(transfer_ + "-o x.npy --weights-out found.csv");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err,
              HasSubstr("head@wide=1: takes the rules in its folder (1 expression, 0 "
                        "groups of some that exclude each other and 0 pairs); --rules none"));
  EXPECT_EQ(text_of(folder_ / "found.csv"), asked);
  EXPECT_THAT(text_of(folder_ / "x.run.json"), HasSubstr("head/rules.json"));
  EXPECT_GT(largest(weights_of("--rules none", "none.csv"), kTop), 0.5);
}

TEST_F(RulesTest, AreInTheTableOfErrorsToo) {
  const auto result =
      run("evaluate head --weights take.csv head@wide=1 -k 2 --rules low.json --json");
  const auto free = run("evaluate head --weights take.csv head@wide=1 -k 2 --json");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_GT(nlohmann::json::parse(result.out)["rows"][1]["de_all"],
            nlohmann::json::parse(free.out)["rows"][1]["de_all"]);
}

TEST_F(RulesTest, AreNotLookedForInVertexSpace) {
  std::filesystem::copy_file(folder_ / "low.json", folder_ / "head/rules.json");
  const auto result = run(transfer_ + "--space vertex -o x.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("rules")));
}

TEST_F(RulesTest, RefuseWhatIsWrongOrCannotAct) {
  write("bad.json", R"({"expressions": {"top": {"maximum": -1}}})");
  write("other.json", R"({"expressions": {"topp": {"maximum": 1}}})");
  expect_failure("--rules no.json -o x.npy", 3, "no.json");
  expect_failure("--rules no.json --space vertex -o x.npy", 3, "no.json");
  expect_failure("--rules bad.json -o x.npy", 3, "bad.json: /expressions/top: its minimum, 0");
  expect_failure("--rules other.json -o x.npy", 4,
                 "other.json: the model has no expression 'topp'; did you mean 'top'?");
  expect_failure("--rules low.json --space vertex -o x.npy", 2,
                 "--rules: head@wide=1 is solved for vertices, not weights");
  expect_failure("--symmetry 1 --space vertex -o x.npy", 2, "--symmetry: head@wide=1 is solved");
  expect_failure("--exclusive eyes --space vertex -o x.npy", 2, "--exclusive: ");
  expect_failure("--l1 1 --space vertex -o x.npy", 2, "--l1: ");
  expect_failure("--symmetry -1 -o x.npy", 2, "--symmetry");
  expect_failure("--exclusive mouth -o x.npy", 2, "none, eyes, all");
  expect_failure("--symmetry 1 -o x.npy", 4, "named as left and right; name pairs in a file of");
  expect_failure("--exclusive eyes -o x.npy", 4, "--exclusive: head@wide=1: none of its expr");
  expect_failure("--rules low.json,low.json -o x.npy", 2, "--rules: 2 files");
}

TEST_F(RulesTest, SayWhichTargetsAnOptionOfWeightsLeavesOut) {
  const auto result =
      run("transfer head --weights take.csv head@wide=1 head/neutral.ply --full --ridge 0.1 -o o/");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("--ridge: neutral is solved for vertices"));
}

TEST_F(RulesTest, OfEachTargetMayBeAFileNoneOrFound) {
  std::filesystem::copy_file(folder_ / "low.json", folder_ / "head/rules.json");
  const auto made = [&](const std::string& rules) {
    const auto result =
        run("transfer head --weights take.csv head@wide=1 head@wide=2 --full -o o/ "
            "--weights-out w.csv --force --rules " +
            rules);
    EXPECT_EQ(result.code, 0) << rules << '\n' << result.err;
    std::vector<double> most;
    for (const std::string name : {"w-head@wide=1.csv", "w-head@wide=2.csv"}) {
      most.push_back(largest(text_of(folder_ / name), kTop));
    }
    return most;
  };
  const std::vector<double> free = made("none");
  ASSERT_GT(free[0], 0.5);
  ASSERT_GT(free[1], 0.5);
  EXPECT_EQ(made("low.json,none"), (std::vector{0.25, free[1]}));
  EXPECT_EQ(made("none,low.json"), (std::vector{free[0], 0.25}));
  EXPECT_EQ(made("auto,none"), (std::vector{0.25, free[1]}));
  EXPECT_EQ(made("auto"), (std::vector{0.25, 0.25}));
}

TEST_F(RulesTest, RefuseAnotherNumberThanThatOfTheTargets) {
  const std::string two = "head@wide=2 -o o/ --rules ";
  expect_failure(two + "low.json,none,auto", 2,
                 "--rules: 3 files or words (auto or none), expected");
  expect_failure(two + "low.json,", 2, "--rules: expected names between commas, found 'low.json,'");
  expect_failure(two + "low.json,no.json", 3, "no.json");
  expect_failure("--space vertex -o x.npy --markers ,", 2, "--markers: expected names between");
}

TEST_F(RulesTest, SayWhichFilesDoNotAct) {
  const std::string both =
      "transfer head --weights take.csv head@wide=1 head/neutral.ply --full -o o/ --force --rules ";
  const auto acts = run(both + "low.json,none");
  EXPECT_EQ(acts.code, 0) << acts.err;
  EXPECT_THAT(acts.err, Not(HasSubstr("does not act")));
  EXPECT_THAT(run(both + "low.json,low.json").err, HasSubstr("--rules: neutral is solved for"));
  EXPECT_EQ(run(both + "none,low.json").code, 2);
}

TEST_F(RulesTest, SayWhatWouldBeMissingWithoutThem) {
  write("still.json", R"({"expressions": {"top": {"maximum": 0.01}, "left": {"maximum": 0.01},
                          "right": {"maximum": 0.01}}})");
  const auto result = run(transfer_ + "--rules still.json -o x.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("of the deformation is missing; without --rules "));
}

TEST_F(RulesTest, DrawPairsTogether) {
  write("pairs.json", R"({"pairs": [["left", "right"]]})");
  const auto difference = [&](const std::string& arguments, const std::string& name) {
    std::istringstream lines(weights_of(arguments, name));
    std::string line;
    std::getline(lines, line);
    double sum = 0;
    for (char comma = 0; std::getline(lines, line);) {
      std::istringstream cells(line);
      double time = 0, left = 0, right = 0;
      cells >> time >> comma >> left >> comma >> right;
      sum += std::abs(left - right);
    }
    return sum;
  };
  const double free = difference("--rules pairs.json", "free.csv");
  EXPECT_LT(difference("--rules pairs.json --symmetry 10", "drawn.csv"), 0.2 * free);
  EXPECT_GT(free, 0.5);
}

TEST_F(RulesTest, SmoothnessOfZeroChangesNothingAndMoreSmoothsBothSpaces) {
  for (const std::string space : {"vertex", "blendshape"}) {
    const std::string line = transfer_ + "--space " + space + " -o " + space;
    ASSERT_EQ(run(line + "0.npy").code, 0);
    ASSERT_EQ(run(line + "1.npy --smoothness 0").code, 0);
    ASSERT_EQ(run(line + "2.npy --smoothness 0.1").code, 0);
    const std::string plain = text_of(folder_ / (space + "0.npy"));
    EXPECT_EQ(text_of(folder_ / (space + "1.npy")), plain);
    EXPECT_NE(text_of(folder_ / (space + "2.npy")), plain);
  }
}

TEST_F(RulesTest, SmoothnessSaysWhereTheInputSaysNothingOfTime) {
  ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
  std::filesystem::remove(folder_ / "take.times.csv");
  const std::string line = "transfer take.npy head@wide=1 --full -o out.npy --force ";
  const std::string said =
      "take.npy: says nothing of time, so that --smoothness takes its frames "
      "for 30 a second";
  EXPECT_THAT(run(line + "--smoothness 0.1").err, HasSubstr(said));
  EXPECT_THAT(run(line + "--smoothness 0.1 --fps 25").err, testing::Not(HasSubstr(said)));
  EXPECT_THAT(run(line).err, testing::Not(HasSubstr(said)));
}

}  // namespace
}  // namespace mimetra
