#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "command.h"

namespace mimetra {
namespace {

using nlohmann::json;

class Output : public test::CommandTest {};

TEST_F(Output, FolderHoldsNumberedFramesAndTheManifestOnly) {
  ASSERT_EQ(run("convert head --weights take.csv --frames 0:3 -o take").code, 0);
  EXPECT_EQ(listing("take"), (std::set<std::string>{"frame_0000.ply", "frame_0001.ply",
                                                    "frame_0002.ply", "mimetra-run.json"}));
}

TEST_F(Output, ManifestTellsOptionsInputsAndResult) {
  ASSERT_EQ(run("decompose head --weights take.csv -k 2 -o c.h5").code, 0);
  const json manifest = json::parse(text_of(folder_ / "c.run.json"));
  EXPECT_EQ(manifest.at("command"), "decompose");
  EXPECT_EQ(manifest.at("options").at("k"), "2");
  EXPECT_EQ(manifest.at("result").at("components"), 2);
  ASSERT_FALSE(manifest.at("inputs").empty());
  for (const json& input : manifest.at("inputs")) {
    EXPECT_EQ(input.at("xxh3").get<std::string>().size(), 16u);
  }
}

TEST_F(Output, IsTheSameOnEveryRun) {
  ASSERT_EQ(
      run("transfer head --weights take.csv head@wide=1 -k 3 -o a --regions-out r/a.pvd").code, 0);
  ASSERT_EQ(
      run("transfer head --weights take.csv head@wide=1 -k 3 -o b --regions-out s/a.pvd").code, 0);
  for (const std::string& name : listing("a")) {
    if (name == "mimetra-run.json") continue;
    EXPECT_EQ(text_of(folder_ / "a" / name), text_of(folder_ / "b" / name)) << name;
  }
  for (const std::string& name : listing("r/a_vtp")) {
    EXPECT_EQ(text_of(folder_ / "r/a_vtp" / name), text_of(folder_ / "s/a_vtp" / name)) << name;
  }
}

TEST_F(Output, QuietPrintsNothing) {
  const auto result = run("convert head --weights take.csv -o take.npy -q");
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Output, ProgressBarIsDrawnOnlyWhenAskedForOffATerminal) {
  EXPECT_EQ(run("convert head --weights take.csv -o a.npy").err, "");
  EXPECT_NE(run("convert head --weights take.csv -o b.npy --progress always").err, "");
}

}  // namespace
}  // namespace mimetra
