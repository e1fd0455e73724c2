#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "tests/cli/run_here.h"
#include "toolkit/io/weight_file.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using std::chrono::duration;
using std::chrono::steady_clock;

/// $MIMETRA_KILLS moments for each run below; a few by default, for the time that they take.
int moments() {
  const char* asked = std::getenv("MIMETRA_KILLS");
  return asked ? std::atoi(asked) : 3;
}

/// The command with one output in the folder `parent`, which holds two frames of another sequence.
struct Killed {
  std::string name;
  std::string arguments;
  std::string output;
  std::vector<std::string> companions;
};

class KillTest : public test::CommandTest, public testing::WithParamInterface<Killed> {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    WeightTrack track{performance().names, Eigen::MatrixXd(kFrames, 3), {}};
    for (int f = 0; f < kFrames; ++f) {
      track.weights.row(f) << 0.5 + 0.5 * std::sin(0.1 * f), 0.3, f / double(kFrames);
    }
    write_weights(folder_ / "long.csv", track, false);
    fs::create_directory(folder_ / "parent");
    for (const std::string frame : {"f1.obj", "f2.obj"}) {
      write("parent/" + frame, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }
  }

  /// Starts the command and kills it after `seconds`; true where it had ended by itself before.
  bool run_and_kill(double seconds) const {
    const pid_t child = fork();
    if (child == 0) {
      // exec: the process that is killed is the command, not a shell around it.
      const std::string line = "cd '" + folder_.string() + "' && exec " + MIMETRA_COMMAND + ' ' +
                               GetParam().arguments + " > /dev/null 2>&1 < /dev/null";
      execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(duration<double>(seconds));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status);
  }

  /// What stands under the names asked for, but for the manifest, which holds how long it took.
  std::map<std::string, std::string> result() const {
    std::map<std::string, std::string> contents;
    const auto add = [&](const fs::path& path) {
      const bool is_manifest = path.filename().string().ends_with("run.json");
      contents[path.lexically_relative(folder_)] = is_manifest ? "" : text_of(path);
    };
    const fs::path output = folder_ / GetParam().output;
    if (fs::is_directory(output)) {
      for (const auto& entry : fs::directory_iterator(output)) add(entry.path());
    } else if (fs::exists(output)) {
      add(output);
    }
    return contents;
  }

  /// Whatever whole files the killed run left under the names that it makes.
  void remove_result() const {
    fs::remove_all(folder_ / GetParam().output);
    for (const std::string& name : GetParam().companions) fs::remove(folder_ / name);
  }

  static constexpr int kFrames = 200;
};

TEST_P(KillTest, LeavesNothingOrTheWholeResultAndALaterRunSucceeds) {
  // The first run reads the program from the disk; those that are killed find it in memory.
  double seconds = 0;
  std::map<std::string, std::string> whole;
  for (int warm = 0; warm < 2; ++warm) {
    remove_result();
    const auto start = steady_clock::now();
    ASSERT_EQ(run(GetParam().arguments).code, 0);
    seconds = duration<double>(steady_clock::now() - start).count();
    whole = result();
    ASSERT_FALSE(whole.empty());
  }
  remove_result();

  std::mt19937 generator(20);
  std::uniform_real_distribution<double> place(0, 1);
  int killed = 0;
  for (int i = 0; i < moments(); ++i) {
    killed += !run_and_kill(seconds * (i + place(generator)) / moments());
    const auto left = result();
    EXPECT_TRUE(left.empty() || left == whole) << left.size() << " files are left";
    EXPECT_EQ(read_sequence((folder_ / "parent").string()).sequence.frames(), 2);
    fs::remove_all(folder_ / GetParam().output);
  }
  EXPECT_GT(killed, 0);
  const auto later = run(GetParam().arguments);
  EXPECT_EQ(later.code, 0) << later.err;
  EXPECT_EQ(result(), whole);
  // The moments between the renames are too short to be met by chance: companions alone are left.
  fs::remove_all(folder_ / GetParam().output);
  for (const std::string& name : GetParam().companions) {
    ASSERT_TRUE(fs::exists(folder_ / name)) << name;
  }
  EXPECT_EQ(run(GetParam().arguments).code, 0);
  EXPECT_EQ(result(), whole);
}

INSTANTIATE_TEST_SUITE_P(
    Every, KillTest,
    testing::Values(Killed{"transfer_folder",
                           "transfer head --weights long.csv head@wide=1 -k 3 -o parent/x",
                           "parent/x",
                           {"parent/x.rest.ply"}},
                    Killed{"convert_npy",
                           "convert head --weights long.csv -o parent/x.npy",
                           "parent/x.npy",
                           {"parent/x.rest.ply", "parent/x.topology.ply", "parent/x.run.json"}}),
    [](const auto& instance) { return instance.param.name; });

using Companion = test::QuickCommandTest;

TEST_F(Companion, OfSomebodyElseIsNotReplaced) {
  write("x.rest.ply", "mine");
  for (const std::string force : {"", " --force"}) {
    const auto result = run("convert head --weights take.csv -o x.npy" + force);
    EXPECT_EQ(result.code, 5);
    EXPECT_THAT(result.err, testing::HasSubstr("x.rest.ply: stands without 'x.npy'"));
  }
  EXPECT_EQ(text_of(folder_ / "x.rest.ply"), "mine");
  EXPECT_FALSE(listing().contains("x.npy"));
}

}  // namespace
}  // namespace mimetra
