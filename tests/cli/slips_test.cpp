#include <algorithm>

#include <gmock/gmock.h>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

/// What somebody types in the first hour, and what the message names.
struct Slip {
  const char* line;
  std::vector<const char*> named;
  int code = 2;
};

class Slips : public test::QuickCommandTest {
 protected:
  /// Frames 0 to 11 as meshes, padded and not, and as an array.
  void SetUp() override {
    CommandTest::SetUp();
    ASSERT_EQ(run("convert head --weights take.csv --format obj -o take").code, 0);
    ASSERT_EQ(run("convert head --weights take.csv -o take.npy").code, 0);
    std::filesystem::create_directory(folder_ / "bare");
    for (int i = 0; i < 12; ++i) {
      const std::string number = std::to_string(i);
      const std::string padded = std::string(4 - number.size(), '0') + number;
      std::filesystem::copy_file(folder_ / "take" / ("frame_" + padded + ".obj"),
                                 folder_ / "bare" / ("smile_" + number + ".obj"));
    }
  }
};

TEST_F(Slips, AreAnsweredByWhatWasMeant) {
  const std::vector<Slip> slips = {
      {"tranfer take head -o out", {"did you mean 'transfer'?"}},
      {"Transfer take head -o out", {"did you mean 'transfer'?"}},
      {"version", {"did you mean '--version'?"}},
      {"--frames 0:5 info take", {"before --frames"}},
      {"mimetra info take", {"no command 'mimetra'", "--help"}},
      {"", {"expected a command"}},
      {"info", {"sequence is required", "mimetra info [OPTIONS] SEQUENCE"}},
      {"info tak", {"tak: no such file or folder; did you mean 'take'?"}, 3},
      {"info -", {"-: standard input is not read"}, 3},
      {"info takes/", {"takes/: no such file or folder; did you mean 'take'?"}, 3},
      {"info bare/smile_3.ob", {"did you mean 'bare/smile_3.obj'?"}, 3},
      {"convert take.npy -o '~/x.npy'", {"$HOME"}},
      {"regions take -k 5 -k 6 -o r.json", {"-k is given 2 times"}},
      {"info take/*.obj", {"got 12 files", "'take/*.obj' in quotes"}},
      {"info bare/smile_%04d.obj", {"'bare/smile_%d.obj' matches smile_0.obj to"}, 3},
      {"info 'bare/smile_{0..11}.obj'", {"such as 'bare/frame_%04d.obj'"}, 3},
      {"info take/frame_%03d.obj", {"'take/frame_%04d.obj' matches"}, 3},
      {"check take head", {"head", "mimetra check [OPTIONS] SEQUENCE"}},
      {"transfer take -o out", {"target is required", "-o OUT SOURCE TARGET..."}},
      {"transfer take head", {"--out is required", "-o OUT SOURCE TARGET..."}},
      {"transfer take head -o", {"--out", "-o OUT SOURCE TARGET..."}},
      {"transfer take head --output out", {"did you mean '--out'?"}},
      {"transfer head take -o out", {"take: is no model", "a sequence, which is a source"}, 3},
      {"transfer take take.npy -o out", {"take.npy: model can be read from", ".obj"}, 3},
      {"transfer take head -o out.fbx", {"out.fbx", ".glb", "'out.fbx/'"}},
      {"transfer take head --full -k 10 -o out", {"-k: no regions", "--full"}},
      {"regions take --k 5 -o r.json", {"did you mean '-k'?"}},
      {"regions take --K 5 -o r.json", {"did you mean '-k'?"}},
      {"regions take -K 5 -o r.json", {"did you mean '-k'?"}},
      {"regions take -k five -o r.json", {"-k: expected a whole number", "'five'"}},
      {"regions take -radius 0.1 -o r.json", {"option -radius", "did you mean '--radius'?"}},
      {"regions take --radius 10% -o r.json", {"--radius: expected a share", "'10%'; 10 % is 0.1"}},
      {"regions take --coverage 80 -o r.json", {"from 1e-09 to 1, found '80'; 80 % is 0.8"}},
      {"regions take --coverage 2.5% -o r.json", {"'2.5%'; 2.5 % is 0.025"}},
      {"regions take --align auto -o r.json",
       {"auto: no such file; --align takes stable, all, joint or none, or a file"},
       3},
      {"regions take --only eyes -o r.json", {"eyes: no such file; --only takes component:N"}, 3},
      {"transfer take head --source-rest neutrl -o out",
       {"--source-rest takes neutral, first or mean, or a file; did you mean 'neutral'?"},
       3},
      {"regions take --radius 0,1 -o r.json", {"as in 0.1", "'0,1'"}},
      {"regions take -z 4 -o r.json", {"unknown option -z", "--help"}},
      {"regions take -o r.vtk", {".vtp", "not as '.vtk'"}},
      {"regions take -o r", {"r: ", ".vtp", "the name has no extension"}},
      {"convert take -o take.npy", {"exists already", "--force"}, 5},
      {"convert take.npy -o one.obj", {"cannot hold 12 frames", "--frames"}, 4},
      {"convert take.npy --frames 0-5 -o x.npy", {"frames '0-5'", "A:B"}},
      {"convert take.npy --fps 30fps -o x.npy", {"--fps: expected a number", "'30fps'"}},
      {"convert take.npy --threads all -o x.npy", {"--threads: expected a whole", "'all'"}},
      {"render take.npy -o take.jpg", {".png", "not as '.jpg'"}},
      {"render take.npy --frame 3 -o f.png", {"did you mean '--frames'?"}},
      {"render take.npy --layout frame --at 100 -o f.png", {"no frame 100", "last is 11"}, 4},
      {"report take.npy -o r.html", {"a run of convert", "transfer, evaluate or regions"}, 4},
      {"evaluate take.npy head -k 5 10", {"-k takes one word: write -k 5,10"}},
      {"evaluate take.npy head -k 5-10", {"as in 10,30,40", "'5-10'"}},
  };
  for (const Slip& slip : slips) {
    const auto before = listing();
    // Only the command itself lists VTK's formats.
    const bool lists_them = std::ranges::find(slip.named, std::string(".vtp")) != slip.named.end();
    const auto result = lists_them ? CommandTest::run(slip.line) : run(slip.line);
    EXPECT_EQ(result.code, slip.code) << slip.line << '\n' << result.err;
    for (const char* name : slip.named) EXPECT_THAT(result.err, HasSubstr(name)) << slip.line;
    EXPECT_EQ(listing(), before) << slip.line;
  }
}

TEST_F(Slips, OfWhatCanMeanOneThingOnlyAreUnderstood) {
  EXPECT_EQ(run("transfer take head -k=2 -o first").code, 0);
  EXPECT_EQ(run("transfer take head -k2 -o second").code, 0);
  EXPECT_EQ(text_of(folder_ / "first/frame_0005.ply"), text_of(folder_ / "second/frame_0005.ply"));
  EXPECT_EQ(run("help transfer").out, run("transfer -h").out);
  EXPECT_EQ(run("help").out, run("--help").out);
}

}  // namespace
}  // namespace mimetra
