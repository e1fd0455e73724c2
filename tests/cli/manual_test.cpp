#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"
#include "tests/test_folders.h"

namespace mimetra {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Manual : public test::CommandTest {
 protected:
  json operations() const { return json::parse(run("operations --json").out).at("operations"); }

  /// What bash offers for the words of a line, the last of which is being typed.
  std::string offered(const std::string& words) const {
    std::ofstream(folder_ / "complete.sh")
        << "source completion.bash\nCOMP_WORDS=(" << words
        << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_mimetra\necho \"${COMPREPLY[@]}\"\n";
    const std::string line = "cd '" + folder_.string() + "' && bash complete.sh > offered.txt";
    EXPECT_EQ(std::system(line.c_str()), 0);
    return text_of(folder_ / "offered.txt");
  }
};

TEST_F(Manual, OfEveryKindNamesEveryOperationAndParameter) {
  const json table = operations();
  for (const std::string request :
       {"completion --shell bash", "completion --shell zsh", "completion --shell fish",
        "manual --format man", "manual --format markdown"}) {
    const auto result = run(request);
    ASSERT_EQ(result.code, 0);
    for (const json& operation : table) {
      EXPECT_THAT(result.out, HasSubstr(operation.at("name"))) << request;
      if (!operation.contains("parameters")) continue;
      for (const json& parameter : operation.at("parameters")) {
        std::string name = parameter.at("name");
        if (request == "manual --format man") {
          for (auto at = name.find('-'); at != std::string::npos; at = name.find('-', at + 2)) {
            name.insert(at, "\\");
          }
        }
        EXPECT_THAT(result.out, HasSubstr(name)) << request;
      }
    }
  }
}

TEST_F(Manual, ReferenceInTheDocumentsIsUpToDate) {
  EXPECT_EQ(run("manual --format markdown").out,
            text_of(test::source_folder() / "docs/commands.md"))
      << "mimetra manual --format markdown > docs/commands.md";
}

TEST_F(Manual, FormatsInTheDocumentsAreUpToDate) {
  EXPECT_EQ(run("formats --markdown").out, text_of(test::source_folder() / "docs/formats.md"))
      << "mimetra formats --markdown > docs/formats.md";
}

TEST_F(Manual, CompletionOffersCommandsOptionsChoicesAndFilesThatCanBeRead) {
  ASSERT_EQ(run("completion --shell bash > completion.bash").code, 0);
  EXPECT_EQ(offered("mimetra trans"), "transfer\n");
  EXPECT_EQ(offered("mimetra transfer --weights"), "--weights-out --weights\n");
  EXPECT_EQ(offered("mimetra transfer --space b"), "blendshape\n");
  EXPECT_THAT(offered("mimetra transfer --weights take"), HasSubstr("take.csv"));
  EXPECT_THAT(offered("mimetra transfer he"), HasSubstr("head"));
  EXPECT_THAT(offered("mimetra transfer --source-rest n"), HasSubstr("neutral"));
  EXPECT_EQ(offered("mimetra transfer -k t"), "\n");
  for (const char* name : {"set.json", "set two.csv", "set.vtp", "set.npy", "set.h5"})
    write(name, "");
  std::filesystem::create_directory(folder_ / "sets");
  EXPECT_EQ(offered("mimetra transfer --regions se"), "set.json set two.csv set.vtp sets\n");
  EXPECT_EQ(offered("mimetra transfer --components se"), "set.h5 sets\n");
  EXPECT_EQ(offered("mimetra transfer --regions-out se"), "set.json set two.csv set.vtp sets\n");
  EXPECT_THAT(offered("mimetra transfer -o se"), HasSubstr("set.npy"));
}

class Check : public test::QuickCommandTest {};

TEST_F(Check, FindsASoundSequenceUsable) {
  const auto result = run("check head --weights take.csv --json");
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(json::parse(result.out), json({{"usable", true}, {"warnings", json::array()}}));
}

TEST_F(Check, WarnsOfWhatIsOddAndRefusesItWhenStrict) {
  write("odd.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 5 5 5\nf 1 2 3\nf 1 2 4\n");
  const auto result = run("check odd.obj --json");
  EXPECT_EQ(result.code, 0);
  const json warnings = json::parse(result.out).at("warnings");
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_THAT(warnings[0], HasSubstr("1 triangle without area"));
  EXPECT_THAT(warnings[1], HasSubstr("the first is 4"));
  EXPECT_THAT(result.err, HasSubstr("odd.obj: 1 triangle without area"));
  const auto strict = run("check odd.obj --strict");
  EXPECT_EQ(strict.code, 4);
  EXPECT_THAT(strict.err, HasSubstr("and 1 more warning\n"));
  EXPECT_EQ(strict.out, "");
}

class Render : public test::CommandTest {};

TEST_F(Render, WritesAPngOfTheSizeItSays) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.pvd").code, 0);
  const auto result =
      run("render r.pvd r.pvd --color region,displacement --columns 3 --size 64 -o s.png --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("rows"), 2);
  EXPECT_EQ(report.at("columns"), 3);
  EXPECT_TRUE(report.at("ranges")[0].is_null());
  EXPECT_GT(report.at("ranges")[1].at("maximum").get<double>(), 0);
  const std::string png = text_of(folder_ / "s.png");
  ASSERT_GT(png.size(), 24u);
  const int width = report.at("width");
  EXPECT_EQ(static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]), width);
  EXPECT_TRUE(listing().contains("s.run.json"));
}

TEST_F(Render, SaysWhatToInstallWhereThereIsNoOpenGl) {
  ASSERT_EQ(setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1), 0);
  const auto result = run("render head --size 32 -o s.png");
  unsetenv("__EGL_VENDOR_LIBRARY_DIRS");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("install libegl1"));
  EXPECT_FALSE(listing().contains("s.png"));
}

TEST_F(Render, NamesTheFieldsThereAre) {
  ASSERT_EQ(run("regions head --weights take.csv -k 2 -o r.vtp").code, 0);
  const auto result = run("render r.vtp --color reigon -o s.png");
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, HasSubstr("displacement, difference, region"));
  EXPECT_FALSE(listing().contains("s.png"));
}

}  // namespace
}  // namespace mimetra
