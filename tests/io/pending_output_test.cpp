#include "toolkit/io/pending_output.h"

#include <functional>

#include <gmock/gmock.h>

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

TEST(PendingOutput, RemovesParentsThatItCreatedForNothing) {
  const TemporaryFolder folder;
  { const PendingOutput output(folder / "a/b/out.txt", Kind::file, false); }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(PendingOutput, KeepsParentsThatWereThere) {
  const TemporaryFolder folder;
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
  EXPECT_EQ(message_of<OutputError>([&] { PendingOutput(folder / "out.txt", Kind::file, false); }),
            (folder / "out.txt").string() + ": exists already; use --force to replace it");
  EXPECT_EQ(read_file(folder / "out.txt"), "old");
}

TEST(PendingOutput, RefusesATargetThatAppearedMeanwhile) {
  const TemporaryFolder folder;
  PendingOutput output(folder / "out.txt", Kind::file, false);
  write_bytes(folder / "out.txt", "somebody else's");
  EXPECT_THROW(output.commit(), OutputError);
  EXPECT_EQ(read_file(folder / "out.txt"), "somebody else's");
}

TEST(PendingOutput, OverwritingReplacesAFolderAsAWhole) {
  const TemporaryFolder folder;
  {
    PendingOutput before(folder / "out", Kind::folder, false);
    write_bytes(before.path() / "old", "old");
    before.commit();
  }
  PendingOutput output(folder / "out", Kind::folder, true);
  write_bytes(output.path() / "new", "new");
  EXPECT_TRUE(fs::exists(folder / "out/old"));
  output.commit();
  EXPECT_THAT(folder.names(), ElementsAre("out"));
  EXPECT_FALSE(fs::exists(folder / "out/old"));
  EXPECT_TRUE(fs::exists(folder / "out/new"));
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

TEST(WriteFile, WritesAllBytes) {
  const TemporaryFolder folder;
  const std::string content("a\0b\r\n", 5);
  write_file(folder / "out", content, false);
  EXPECT_EQ(read_file(folder / "out"), content);
}

/// A folder as an earlier run left it.
void write_folder(const fs::path& target, const std::string& content) {
  PendingOutput output(target, Kind::folder, true);
  write_bytes(output.path() / "frame_0000.ply", content);
  fs::create_directory(output.path() / "expressions");
  write_bytes(output.path() / "expressions/smile.ply", content);
  output.commit();
}

TEST(PendingOutput, ReplacesAFolderOfAnEarlierRun) {
  const TemporaryFolder folder;
  write_folder(folder / "out", "old");
  write_folder(folder / "out", "new");
  EXPECT_EQ(read_file(folder / "out/expressions/smile.ply"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
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
                ", which no manifest of an earlier run lists; --force replaces nothing else: move "
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
