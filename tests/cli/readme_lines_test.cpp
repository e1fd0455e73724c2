#include <gmock/gmock.h>

#include "tests/cli/command_fixture.h"

namespace mimetra::test {
namespace {

namespace fs = std::filesystem;

/// The performance as takes/smile_0000.obj on, and another person as actor/.
class ReadmeLines : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    ASSERT_EQ(run("convert head --weights take.csv --format obj -o takes").code, 0);
    const std::string frame = "frame_", takes = "takes/";
    for (const std::string& name : listing(takes)) {
      if (!name.starts_with(frame)) continue;
      fs::rename(folder_ / takes / name, folder_ / takes / ("smile_" + name.substr(frame.size())));
    }
    const MorphableModel head = model();
    Positions wide = head.mean();
    wide.col(0) *= 1.2;
    write_model(folder_ / "actor", {head.shared_connectivity(), wide, {}, head.expressions()}, {},
                false);
  }
};

TEST_F(ReadmeLines, GiveTheCommandsBytes) {
  const std::string line = "cd '" + folder_.string() + "' && " + MIMETRA_README_LINES + " > .lines";
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_THAT(text_of(folder_ / ".lines"), testing::HasSubstr(" over all triangles"));
  const CommandResult command = run("transfer takes/smile_%04d.obj actor/ -o by_command/");
  ASSERT_EQ(command.code, 0) << command.err;

  std::set<std::string> names = listing("by_command");
  EXPECT_EQ(names.size(), 13U);
  EXPECT_EQ(listing("actor_smile"), names);
  // Who wrote the frames, and when, is not the same.
  names.erase("mimetra-run.json");
  for (const std::string& name : names) {
    EXPECT_TRUE(text_of(folder_ / "actor_smile" / name) == text_of(folder_ / "by_command" / name))
        << name;
  }
}

}  // namespace
}  // namespace mimetra::test
