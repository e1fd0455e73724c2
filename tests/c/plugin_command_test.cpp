// Third-party operations in the command.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command_fixture.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class PluginCommand : public test::CommandTest {
 protected:
  /// With the plugins of a folder of the build.
  test::CommandResult run_with(const std::string& plugins, const std::string& arguments) const {
    return run(arguments, "MIMETRA_PLUGIN_PATH=" MIMETRA_TEST_PLUGINS "/" + plugins);
  }
};

TEST_F(PluginCommand, IsInHelpListingAndCompletion) {
  EXPECT_THAT(run_with("samples", "--help").out,
              AllOf(HasSubstr("smooth  "), HasSubstr("Show how fast each vertex moves")));
  EXPECT_THAT(run_with("samples", "smooth --help").out,
              AllOf(HasSubstr("--strength X"), HasSubstr("(default 0.5)"),
                    HasSubstr("mimetra smooth take.npy --strength 0.3 -o smoothed.npy")));
  EXPECT_THAT(run_with("samples", "operations --json").out, HasSubstr("\"name\": \"smooth\""));
  EXPECT_THAT(run_with("samples", "completion --shell bash").out,
              AllOf(HasSubstr("smooth"), HasSubstr("strength")));
  EXPECT_THAT(run("--help").out, Not(HasSubstr("smooth")));
}

TEST_F(PluginCommand, IsFoundInTheInstallation) {
  namespace fs = std::filesystem;
  fs::create_directories(folder_ / "bin");
  fs::copy_file(MIMETRA_COMMAND, folder_ / "bin" / "mimetra");
  fs::create_directories(folder_ / MIMETRA_PLUGIN_FOLDER);
  fs::copy_file(MIMETRA_TEST_PLUGINS "/samples/smooth.so",
                folder_ / MIMETRA_PLUGIN_FOLDER / "smooth.so");
  // By a path, by a name that the shell looks up, and through a link from elsewhere.
  fs::create_directories(folder_ / "elsewhere");
  fs::create_symlink("../bin/mimetra", folder_ / "elsewhere" / "mimetra");
  for (const char* command :
       {"bin/mimetra", "PATH=$PWD/bin:$PATH mimetra", "PATH=$PWD/elsewhere:$PATH mimetra"}) {
    EXPECT_THAT(run("", std::string(command) + " --help && true").out,
                AllOf(HasSubstr("smooth  "), Not(HasSubstr("speed  "))));
  }
}

TEST_F(PluginCommand, WorksLikeOneOfTheToolkit) {
  const auto result =
      run_with("samples", "smooth head --weights take.csv --iterations 2 -o smooth.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(listing().contains("smooth.npy"));
  EXPECT_THAT(text_of(folder_ / "smooth.run.json"), HasSubstr("\"iterations\""));
  const auto speed = run_with("samples", "speed head --weights take.csv -o speed.pvd --json");
  EXPECT_EQ(speed.code, 0) << speed.err;
  EXPECT_THAT(speed.out, HasSubstr("\"top_speed\""));
  EXPECT_EQ(run_with("samples", "smooth head --strength 2 -o no.npy").code, 2);
}

TEST_F(PluginCommand, ShowsRegionsOnTheMeshTheyWereMadeFor) {
  for (const char* name : {"spots.pvd", "spot.vtp", "spots.json", "spots.csv"}) {
    const auto made = run_with("kinds", std::string("spots head --weights take.csv -o ") + name);
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(listing().contains(name));
  }
  EXPECT_EQ(run("transfer head head --weights take.csv --regions spot.vtp -o a.npy").code, 0);
}

TEST_F(PluginCommand, ShowsTheRegionsOfSeveralSequencesEachOnItsOwn) {
  ASSERT_EQ(run("convert head --weights take.csv --frames 0:2 -o two").code, 0);
  ASSERT_EQ(run("convert head --weights take.csv --frames 0:3 -o three").code, 0);
  const auto made = run_with("kinds", "spot-each two three -o s.pvd");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(run("info s-two.pvd --json").out, HasSubstr("\"frames\": 2"));
  EXPECT_THAT(run("info s-three.pvd --json").out, HasSubstr("\"frames\": 3"));
}

TEST_F(PluginCommand, ReadsRegionsForWhateverHasAMesh) {
  ASSERT_EQ(run_with("kinds", "spots head --weights take.csv -o spot.vtp").code, 0);
  ASSERT_EQ(run_with("kinds", "spots head --weights take.csv -o spot.json").code, 0);
  for (const char* fields : {"spot.vtp", "head"}) {
    const auto counted =
        run_with("kinds", std::string("count ") + fields + " --regions spot.json --json");
    EXPECT_EQ(counted.code, 0) << counted.err;
    EXPECT_THAT(counted.out, HasSubstr("\"vertices\""));
  }
}

TEST_F(PluginCommand, NamesTheOutputsOfSeveralInputsByTheirFiles) {
  ASSERT_EQ(run("convert head --weights take.csv -o takes/one").code, 0);
  ASSERT_EQ(run("convert head --weights take.csv -o takes/two").code, 0);
  const std::string there = (folder_ / "takes").string();
  const auto made = run_with("kinds", "each " + there + "/one " + there + "/two/ -o out");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "one"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "two"));
  // The inputs have other names than the outputs, so that nothing of theirs can be replaced.
  EXPECT_EQ(run_with("kinds", "each " + there + "/one " + there + "/one -o twice --force").code, 2);
  const std::string from_inside =
      "cd takes/one && MIMETRA_PLUGIN_PATH=" MIMETRA_TEST_PLUGINS "/kinds";
  const auto dots = run("each . ../two -o ../../dots --force", from_inside);
  EXPECT_EQ(dots.code, 0) << dots.err;
  const auto patterns = run_with("kinds", "each 'takes/one/*.ply' 'takes/two/*.ply' -o patterns");
  EXPECT_EQ(patterns.code, 0) << patterns.err;
  for (const char* out : {"dots", "patterns"}) {
    EXPECT_THAT(listing(out), testing::IsSupersetOf({"one", "two"}));
  }
  const auto again = run_with("kinds", "each takes/one takes/two -o out --force");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "takes" / "two"));
}

TEST_F(PluginCommand, FailsWithTheExitCodeOfThePlugin) {
  const auto one = run_with("samples", "speed head -o no.pvd");
  EXPECT_EQ(one.code, 4);
  EXPECT_THAT(one.err, HasSubstr("speed sample: speed: one frame has no speed"));
  EXPECT_FALSE(listing().contains("no.pvd"));
  const auto thrown = run_with("misbehaving", "misbehave head --how throw -o no.npy");
  EXPECT_EQ(thrown.code, 1);
  EXPECT_THAT(thrown.err, HasSubstr("misbehaving: misbehave: threw an exception"));
}

TEST_F(PluginCommand, IsNotHarmedByBrokenPlugins) {
  const auto result = run_with("broken/DESCRIPTIONS", "info head --json");
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: plugins: "));
  EXPECT_THAT(result.out, HasSubstr("\"vertices\""));
  EXPECT_THAT(run_with("broken/THROWS", "info head -q").err, IsEmpty());
  const auto unknown = run_with("broken/OTHER_VERSION", "of-other-version");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("is for version 2"), HasSubstr("no command")));
}

TEST_F(PluginCommand, ReadsAndWritesAFormatOfAPlugin) {
  EXPECT_THAT(run_with("samples", "formats").out, HasSubstr("Medit mesh of one frame"));
  EXPECT_THAT(run_with("samples", "convert --help all").out, HasSubstr(".mesh"));
  auto result = run_with("samples", "convert head -o face.mesh");
  EXPECT_EQ(result.code, 0) << result.err;
  result = run_with("samples", "convert face.mesh -o back.npy");
  EXPECT_EQ(result.code, 0) << result.err;
  ASSERT_EQ(run("convert head -o straight.npy").code, 0);
  EXPECT_EQ(text_of(folder_ / "back.npy"), text_of(folder_ / "straight.npy"));
  EXPECT_EQ(run_with("samples", "info face.mesh").code, 0);
  EXPECT_EQ(run("info face.mesh").code, 3);
}

TEST_F(PluginCommand, SaysWhichFileAFormatOfAPluginCouldNotReadOrWrite) {
  write("cut.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n");
  const auto before = listing();
  auto result = run_with("samples", "info cut.mesh");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("cut.mesh"), HasSubstr("ends in its Vertices")));
  result = run_with("samples", "convert head --weights take.csv -o take.mesh");
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, AllOf(HasSubstr("take.mesh"), HasSubstr("holds one frame")));
  EXPECT_EQ(listing(), before);
}

}  // namespace
}  // namespace mimetra
