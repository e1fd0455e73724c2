#include "toolkit/io/pending_output.h"

#include <chrono>
#include <csignal>
#include <functional>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;
using Kind = PendingOutput::Kind;

TEST(PendingOutput, FileAppearsOnlyOnCommit) {
  const TemporaryFolder folder;
  PendingOutput output(folder / "out.txt", Kind::file, false);
  write_bytes(output.path(), "whole");
  EXPECT_FALSE(fs::exists(folder / "out.txt"));
  output.commit();
  EXPECT_EQ(read_file(folder / "out.txt"), "whole");
  EXPECT_THAT(folder.names(), ElementsAre("out.txt"));
}

TEST(PendingOutput, TemporaryNameIsHiddenAndInTheSameFolder) {
  const TemporaryFolder folder;
  const PendingOutput output(folder / "out.txt", Kind::file, false);
  EXPECT_EQ(output.path().parent_path(), folder.path());
  EXPECT_THAT(output.path().filename().string(), StartsWith(".out.txt."));
  EXPECT_EQ(output.path().extension(), ".tmp");
}

TEST(PendingOutput, RemovesWhatWasNotCommitted) {
  const TemporaryFolder folder;
  {
    PendingOutput output(folder / "out", Kind::folder, false);
    write_bytes(output.path() / "a", "half");
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingOutput, RemovesParentsThatItCreatedForNothingAndNoOthers) {
  const TemporaryFolder folder;
  { const PendingOutput output(folder / "a/b/out.txt", Kind::file, false); }
  EXPECT_THAT(folder.names(), IsEmpty());
  fs::create_directory(folder / "a");
  { const PendingOutput output(folder / "a/b/out.txt", Kind::file, false); }
  EXPECT_TRUE(fs::is_directory(folder / "a"));
  EXPECT_FALSE(fs::exists(folder / "a/b"));
}

TEST(PendingOutput, TrailingSlashNamesTheSameFolder) {
  const TemporaryFolder folder;
  PendingOutput output(folder / "out/", Kind::folder, false);
  output.commit();
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(PendingOutput, RefusesAnExistingTarget) {
  const TemporaryFolder folder;
  write_bytes(folder / "out.txt", "old");
  EXPECT_EQ(
      message_of<OutputError>([&] { PendingOutput(folder / "out.txt", Kind::file, false); }),
      (folder / "out.txt").string() + ": exists already; use option 'overwrite' to replace it");
  EXPECT_EQ(read_file(folder / "out.txt"), "old");
}

TEST(PendingOutput, RefusesATargetThatAppearedMeanwhile) {
  const TemporaryFolder folder;
  PendingOutput output(folder / "out.txt", Kind::file, false);
  write_bytes(folder / "out.txt", "somebody else's");
  EXPECT_THROW(output.commit(), OutputError);
  EXPECT_EQ(read_file(folder / "out.txt"), "somebody else's");
}

/// A folder as an earlier run left it.
void write_folder(const fs::path& target, const std::string& content) {
  PendingOutput output(target, Kind::folder, true);
  write_bytes(output.path() / "frame_0000.ply", content);
  fs::create_directory(output.path() / "expressions");
  write_bytes(output.path() / "expressions/smile.ply", content);
  output.commit();
}

TEST(PendingOutput, OverwritingReplacesAFolderAsAWhole) {
  const TemporaryFolder folder;
  write_folder(folder / "out", "old");
  PendingOutput output(folder / "out", Kind::folder, true);
  write_bytes(output.path() / "new", "new");
  EXPECT_EQ(read_file(folder / "out/expressions/smile.ply"), "old");
  output.commit();
  EXPECT_THAT(folder.names(), ElementsAre("out"));
  EXPECT_FALSE(fs::exists(folder / "out/expressions"));
  EXPECT_FALSE(fs::exists(folder / "out/frame_0000.ply"));
  EXPECT_EQ(read_file(folder / "out/new"), "new");
}

TEST(PendingOutput, NeverReplacesAFolderByAFileOrAFileByAFolder) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder");
  write_bytes(folder / "file", "");
  EXPECT_THROW(PendingOutput(folder / "folder", Kind::file, true), OutputError);
  EXPECT_THROW(PendingOutput(folder / "file", Kind::folder, true), OutputError);
}

TEST(PendingOutput, SaysWhatCannotBeWritten) {
  const TemporaryFolder folder;
  write_bytes(folder / "file", "");
  EXPECT_THAT(
      message_of<OutputError>([&] { PendingOutput(folder / "file/out", Kind::file, false); }),
      StartsWith((folder / "file/out").string() + ": cannot be written"));
}

TEST(PendingOutput, NameThatNoFolderTakesIsAnOutputError) {
  const TemporaryFolder folder;
  const std::string too_long(5000, 'a');
  for (const fs::path& target : {folder / too_long, folder / (too_long + "/out")}) {
    EXPECT_THROW(PendingOutput(target, Kind::file, true), OutputError);
    EXPECT_THROW(PendingOutput(target, Kind::folder, true), OutputError);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingOutput, ReplacesAnEmptyFolder) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  write_folder(folder / "out", "new");
  EXPECT_EQ(read_file(folder / "out/frame_0000.ply"), "new");
}

TEST(PendingOutput, ListsTheFilesOfAFolderBesideWhatItsManifestSays) {
  const TemporaryFolder folder;
  PendingOutput output(folder / "out", Kind::folder, false);
  write_bytes(output.path() / "a.ply", "a");
  write_bytes(output.path() / "mimetra-run.json", R"({"command": "convert", "version": "1"})");
  output.commit();
  EXPECT_EQ(read_file(folder / "out/mimetra-run.json"),
            "{\n  \"command\": \"convert\",\n  \"version\": \"1\",\n  \"files\": [\n    "
            "\"a.ply\"\n  ]\n}\n");
}

/// What somebody else puts into a folder of ours.
struct Foreign {
  std::string name;
  std::function<void(const fs::path&)> make;
  std::string named;  ///< in the message
};

class ForeignFile : public testing::TestWithParam<Foreign> {};

TEST_P(ForeignFile, KeepsAFolderFromBeingReplaced) {
  const TemporaryFolder folder;
  write_folder(folder / "out", "old");
  GetParam().make(folder / "out");
  EXPECT_EQ(message_of<OutputError>([&] { write_folder(folder / "out", "new"); }),
            (folder / "out").string() + ": holds " + GetParam().named +
                ", which no manifest of an earlier run lists, so that it cannot be replaced: move "
                "what is yours, or choose another name");
  EXPECT_EQ(read_file(folder / "out/frame_0000.ply"), "old");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

INSTANTIATE_TEST_SUITE_P(
    PendingOutput, ForeignFile,
    testing::Values(
        Foreign{"Beside", [](const fs::path& out) { write_bytes(out / "notes.txt", "mine"); },
                "'notes.txt'"},
        Foreign{"Hidden", [](const fs::path& out) { write_bytes(out / ".notes", "mine"); },
                "'.notes'"},
        Foreign{"Below",
                [](const fs::path& out) {
                  fs::create_directory(out / "textures");
                  write_bytes(out / "textures/skin.png", "mine");
                },
                "'textures/skin.png'"},
        Foreign{"EmptyFolder", [](const fs::path& out) { fs::create_directory(out / "wip"); },
                "'wip'"},
        Foreign{"Link", [](const fs::path& out) { fs::create_symlink("/", out / "root"); },
                "'root'"},
        Foreign{"Several",
                [](const fs::path& out) {
                  for (const char* name : {"e", "d", "c", "b", "a"}) write_bytes(out / name, "");
                },
                "'a', 'b', 'c' and 2 more"},
        Foreign{"NoManifest", [](const fs::path& out) { fs::remove(out / "mimetra-run.json"); },
                "'expressions/smile.ply', 'frame_0000.ply'"},
        Foreign{"BrokenManifest",
                [](const fs::path& out) { write_bytes(out / "mimetra-run.json", "{"); },
                "'expressions/smile.ply', 'frame_0000.ply', 'mimetra-run.json'"}),
    [](const auto& test) { return test.param.name; });

TEST(PendingOutput, TakesNothingThatLiesUnderATemporaryName) {
  const TemporaryFolder folder;
  // Names are not to be foreseen; what has such a name from a killed run stays by itself.
  const PendingOutput first(folder / "out", Kind::folder, false);
  write_bytes(first.path() / "stale", "stale");
  PendingOutput output(folder / "out", Kind::folder, false);
  EXPECT_NE(output.path(), first.path());
  output.commit();
  EXPECT_FALSE(fs::exists(folder / "out/stale"));
}

TEST(PendingOutputs, AppearTogether) {
  const TemporaryFolder folder;
  PendingOutputs together(false);
  write_file(folder / "a", "a", false, &together);
  write_file(folder / "b", "b", false, &together);
  EXPECT_FALSE(fs::exists(folder / "a"));
  EXPECT_FALSE(fs::exists(folder / "b"));
  together.commit();
  EXPECT_THAT(folder.names(), ElementsAre("a", "b"));
}

TEST(PendingOutputs, AllStayAsTheyWereWhereOneCannotTakeItsPlace) {
  const TemporaryFolder folder;
  write_bytes(folder / "a", "old");
  write_folder(folder / "c", "old");
  PendingOutputs outputs(true);
  fs::create_directory(folder / "gone");
  // The last one takes its place first.
  write_bytes(outputs.add(folder / "gone/b", Kind::file), "new");
  write_bytes(outputs.add(folder / "a", Kind::file), "new");
  write_bytes(outputs.add(folder / "c", Kind::folder) / "new", "new");
  write_bytes(outputs.add(folder / "d", Kind::file), "new");
  fs::remove_all(folder / "gone");
  EXPECT_THROW(outputs.commit(), OutputError);
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(read_file(folder / "c/frame_0000.ply"), "old");
  EXPECT_FALSE(fs::exists(folder / "d"));
}

TEST(PendingOutputs, NothingStandsWhereOneOfThemIsNotWritten) {
  const TemporaryFolder folder;
  {
    PendingOutputs together(false);
    write_file(folder / "a", "a", false, &together);
    PendingOutputs second(false, {}, &together);
    second.add(folder / "b", Kind::file);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingOutputs, OfOneRunShareAManifest) {
  const TemporaryFolder folder;
  PendingOutputs together(false);
  for (const char* content : {"same", "same"}) {
    PendingOutputs one(false, {}, &together);
    write_bytes(one.add(folder / "x.run.json", Kind::file, PendingOutputs::Existing::anything),
                content);
    one.commit();
  }
  together.commit();
  EXPECT_EQ(read_file(folder / "x.run.json"), "same");
}

TEST(PendingOutputs, AreWrittenWhereALinkLeads) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "real");
  write_bytes(folder / "real/a", "old");
  fs::create_symlink("real/a", folder / "link");
  const std::string content("a\0b\r\n", 5);
  write_file(folder / "link", content, true);
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "real/a"), content);
  fs::remove_all(folder / "real");
  for (const bool overwrite : {false, true}) {
    EXPECT_THAT(message_of<OutputError>([&] { write_file(folder / "link", "new", overwrite); }),
                testing::HasSubstr("link: is a link that leads nowhere"));
  }
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
}

TEST(PendingOutputs, AreNeverPutInPlaceOfADevice) {
  for (const bool overwrite : {false, true}) {
    EXPECT_THAT(message_of<OutputError>([&] { write_file("/dev/null", "x", overwrite); }),
                testing::HasSubstr("no ordinary file"));
  }
}

TEST(PendingOutputs, OfAFolderWithoutANameStandBesideIt) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "out");
  {
    PendingOutput output(folder / "out/.", Kind::folder, true);
    EXPECT_EQ(output.path().parent_path(), fs::canonical(folder.path()));
  }
}

TEST(PendingOutputs, MayNotLieInASubfolderOfAnInput) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "take");
  EXPECT_THROW(check_inputs_stay(folder / "take/sub/x.npy", {folder / "take"}), OutputError);
  EXPECT_NO_THROW(check_inputs_stay(folder / "take2/x.npy", {folder / "take"}));
}

TEST(PendingOutputs, TwoOfOneNameAreRefused) {
  const TemporaryFolder folder;
  PendingOutputs together(false);
  write_file(folder / "x", "one", false, &together);
  write_file(folder / "x", "another", false, &together);
  EXPECT_THAT(message_of<OutputError>([&] { together.commit(); }),
              testing::HasSubstr("two outputs would be written there"));
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(PendingOutputs, TwoPathsOfOneFileAreRefused) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "real");
  fs::create_directory_symlink(folder / "real", folder / "link");
  PendingOutputs together(true);
  write_file(folder / "real/x", "one", true, &together);
  write_file(folder / "link/x", "another", true, &together);
  EXPECT_THAT(message_of<OutputError>([&] { together.commit(); }),
              testing::HasSubstr("two outputs would be written there"));
  EXPECT_THAT(folder.names(), ElementsAre("link", "real"));
  EXPECT_FALSE(fs::exists(folder / "real/x"));
}

TEST(PendingOutputs, OfOneFolderWithTwoPathsDoNotWaitForEachOther) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "real");
  fs::create_directory_symlink(folder / "real", folder / "link");
  const auto start = std::chrono::steady_clock::now();
  PendingOutputs together(false);
  write_file(folder / "real/x", "one", false, &together);
  write_file(folder / "link/y", "another", false, &together);
  together.commit();
  // A lock that another run holds is waited for ten seconds.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

/// Names of one file need not be equal: a second mount and a case-blind folder show it under
/// another name as a second link does.
TEST(PendingOutputs, DoNotReplaceAnInputUnderAnotherName) {
  const TemporaryFolder folder;
  write_bytes(folder / "take.npy", "input");
  fs::create_hard_link(folder / "take.npy", folder / "TAKE.npy");
  EXPECT_THAT(message_of<OutputError>(
                  [&] { check_inputs_stay(folder / "TAKE.npy", {folder / "take.npy"}); }),
              testing::HasSubstr("is an input of this run"));
}

TEST(PendingOutputs, KeepThePermissionsOfWhatTheyReplace) {
  const TemporaryFolder folder;
  write_bytes(folder / "secret", "old");
  fs::permissions(folder / "secret", fs::perms::owner_read | fs::perms::owner_write);
  write_folder(folder / "private", "old");
  fs::permissions(folder / "private", fs::perms::owner_all);
  PendingOutputs outputs(true);
  write_bytes(outputs.add(folder / "secret", Kind::file), "new");
  write_bytes(outputs.add(folder / "private", Kind::folder) / "frame", "new");
  outputs.commit();
  EXPECT_EQ(read_file(folder / "secret"), "new");
  EXPECT_EQ(fs::status(folder / "secret").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(fs::status(folder / "private").permissions(), fs::perms::owner_all);
}

TEST(PendingOutputs, ThatBeginAtOnceInAMissingFolderAreAllWritten) {
  const TemporaryFolder folder;
  const auto run = [&folder](const std::string& name) {
    { const PendingOutput trial(folder / "results/a" / name, Kind::file, false); }
    write_file(folder / "results/a" / name, name, false);
  };
  for (int round = 0; round < 50; ++round) {
    std::vector<std::thread> runs;
    for (const char* name : {"one", "two", "three", "four"}) runs.emplace_back(run, name);
    for (std::thread& each : runs) each.join();
    EXPECT_EQ(read_file(folder / "results/a/four"), "four");
    fs::remove_all(folder / "results");
  }
}

/// Two writers whose outputs have a file in common: the second sees what the first has written.
TEST(PendingOutputs, SeeACommonFileThatAnotherRunWroteMeanwhile) {
  const TemporaryFolder folder;
  PendingOutputs one(false), other(false);
  write_bytes(one.add(folder / "x.npy", Kind::file), "one");
  write_bytes(one.add(folder / "x.times", Kind::file, PendingOutputs::Existing::same), "one");
  write_bytes(other.add(folder / "x.pc2", Kind::file), "other");
  write_bytes(other.add(folder / "x.times", Kind::file, PendingOutputs::Existing::same), "other");
  one.commit();
  EXPECT_THROW(other.commit(), OutputError);
  EXPECT_EQ(read_file(folder / "x.times"), "one");
  EXPECT_FALSE(fs::exists(folder / "x.pc2"));
}

/// Ends this process at its `fatal`-th rename, unlink, mkdir or write, counted by its parent.
/// Returns false where it ended by itself before.
bool died_at(int fatal, const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
    raise(SIGSTOP);
    work();
    _exit(0);
  }
  const std::set<unsigned long long> kFatal = {
      SYS_rename, SYS_renameat, SYS_renameat2, SYS_unlink, SYS_unlinkat, SYS_rmdir,
      SYS_mkdir,  SYS_mkdirat,  SYS_write,     SYS_writev, SYS_pwrite64};
  int status = 0;
  waitpid(child, &status, 0);
  ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD);
  bool enters = true;
  for (int count = 0; true; enters = !enters) {
    ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
    waitpid(child, &status, 0);
    if (WIFEXITED(status)) return false;
    if (!WIFSTOPPED(status) || WSTOPSIG(status) != (SIGTRAP | 0x80)) {
      enters = !enters;
      continue;
    }
    user_regs_struct registers;
    ptrace(PTRACE_GETREGS, child, nullptr, &registers);
    if (!enters || !kFatal.contains(registers.orig_rax) || count++ < fatal) continue;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return true;
  }
}

/// An output that stands, overwritten by a run that dies.
class KillMatrix : public testing::TestWithParam<Kind> {
 protected:
  void write(const std::string& content) const {
    PendingOutputs outputs(true);
    const fs::path path = outputs.add(target_, GetParam());
    const bool is_folder = GetParam() == Kind::folder;
    for (const char* name : {"a", "b", "c"}) {
      write_bytes(is_folder ? path / name : path, content);
      if (!is_folder) break;
    }
    outputs.commit();
  }
  std::string read() const {
    if (GetParam() == Kind::file) return read_file(target_);
    std::string all;
    for (const char* name : {"a", "b", "c"}) all += read_file(target_ / name);
    return all;
  }

  TemporaryFolder folder_;
  fs::path target_ = folder_ / "out";
};

TEST_P(KillMatrix, OldOrNewStandsWhole) {
  int deaths = 0;
  bool dies = true;
  for (int fatal = 0; dies; ++fatal) {
    write("old");
    const std::string before = read();
    dies = died_at(fatal, [this] { write("new"); });
    deaths += dies;
    const std::string after = read();
    EXPECT_TRUE(after == before || after == (GetParam() == Kind::file ? "new" : "newnewnew"))
        << "after death " << fatal << ": " << after;
    // The same run again.
    write("new");
    EXPECT_TRUE(read().starts_with("new"));
  }
  EXPECT_GT(deaths, 2);
}

INSTANTIATE_TEST_SUITE_P(Of, KillMatrix, testing::Values(Kind::file, Kind::folder),
                         [](const auto& kind) {
                           return kind.param == Kind::file ? "AFile" : "AFolder";
                         });

TEST(PendingOutputs, OfTwoRunsAtOnceOneWinsWhole) {
  const TemporaryFolder folder;
  const auto run = [&folder](const std::string& content) {
    for (int i = 0; i < 50; ++i) {
      PendingOutputs outputs(true);
      write_bytes(outputs.add(folder / "main", Kind::file), content);
      write_bytes(outputs.add(folder / "beside", Kind::file), content);
      write_bytes(outputs.add(folder / "frames", Kind::folder) / "frame", content);
      outputs.commit();
    }
  };
  std::thread one([&] { run("one"); });
  run("two");
  one.join();
  const std::string winner = read_file(folder / "main");
  EXPECT_EQ(read_file(folder / "beside"), winner);
  EXPECT_EQ(read_file(folder / "frames/frame"), winner);
  EXPECT_THAT(folder.names(), ElementsAre("beside", "frames", "main"));
}

TEST(PendingOutput, KeepsWhatSomebodyPutsThereMeanwhile) {
  const TemporaryFolder folder;
  write_folder(folder / "out", "old");
  PendingOutput output(folder / "out", Kind::folder, true);
  write_bytes(folder / "out/notes.txt", "mine");
  EXPECT_THROW(output.commit(), OutputError);
  EXPECT_EQ(read_file(folder / "out/notes.txt"), "mine");
}

}  // namespace
}  // namespace mimetra
