// The table of formats: which one a path is read or written by, and how they are listed.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

const OperationTable& toolkit_table() {
  static const OperationTable table = [] {
    OperationTable made;
    add_toolkit(made);
    return made;
  }();
  return table;
}

/// Of regions, read and written.
Format format_of(const std::string& extension) {
  Format format{.name = "mine", .kind = DataKind::regions, .extensions = {extension}};
  format.read = [](const std::string& text, const ReadOptions&, const Context&) -> ReadValue {
    return {{text, RegionData()}};
  };
  format.write = [](const Data&, const std::filesystem::path&, const WriteOptions&,
                    const Context&) { return Format::Paths(); };
  return format;
}

TEST(FormatTable, WritesNoWeightsThatWouldBeReadAsTimes) {
  const OperationTable& table = toolkit_table();
  const test::TemporaryFolder folder;
  for (const char* extension : {".csv", ".json"}) {
    const std::filesystem::path target = folder / (std::string("w") + extension);
    const Format& format = table.writer({"weights", DataKind::table, ""}, target);
    const Table timed{{"time", "jawOpen", "Time_ms"}, {{0, 0.5, 1}}};
    EXPECT_THAT([&] { format.write(timed, target, {}, {}); },
                ThrowsMessage<MismatchError>(HasSubstr("an expression is called 'Time_ms'")));
    EXPECT_FALSE(std::filesystem::exists(target));
    for (const char* name : {"Frame", "frame_index", "Timecode", "BlendShapeCount", "timestamp"}) {
      const Table numbered{{"time", "jawOpen", name}, {{0, 0.5, 1}}};
      EXPECT_THROW(format.write(numbered, target, {}, {}), MismatchError) << name;
    }
  }
}

TEST(FormatTable, ChoosesTheReaderByExtensionInAnyCase) {
  const OperationTable& table = toolkit_table();
  const auto name = [&](DataKind kind, const char* text) { return table.reader(kind, text).name; };
  EXPECT_EQ(name(DataKind::sequence, "take.NPY"), "NumPy array");
  EXPECT_EQ(name(DataKind::sequence, "take.v2/"), "folder of meshes");
  EXPECT_EQ(name(DataKind::sequence, "take_%04d.obj"), "OBJ mesh of one frame");
  EXPECT_EQ(name(DataKind::sequence, "actor@id=1.5"), "folder of meshes");
  EXPECT_EQ(name(DataKind::model, "actor@id=1.5"), "folder of shapes");
  EXPECT_EQ(name(DataKind::model, "sfm_shape.bin"), "eos shape model");
  EXPECT_EQ(name(DataKind::document, "any.thing"), "text");
}

TEST(FormatTable, ListsWhatItKnowsWhereNothingReadsAFile) {
  const OperationTable& table = toolkit_table();
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "take.fbx";
  std::ofstream(file) << "text\n";
  EXPECT_THAT([&] { table.reader(DataKind::sequence, file); },
              ThrowsMessage<IoError>(AllOf(HasSubstr("take.fbx: is an FBX scene; export it as OBJ"),
                                           HasSubstr(".npy, .npz"), HasSubstr(" or a folder"),
                                           HasSubstr("not from '.fbx'"))));
  const std::string video = folder.path() / "take.MP4";
  std::ofstream(video) << "text\n";
  EXPECT_THAT([&] { table.reader(DataKind::sequence, video); },
              ThrowsMessage<IoError>(AllOf(HasSubstr("is a video; 'mimetra fit VIDEO"),
                                           HasSubstr("not from '.mp4'"))));
  EXPECT_THAT([&] { table.reader(DataKind::components, "take.npy"); },
              ThrowsMessage<UsageError>(HasSubstr("components can be read from .h5 or .hdf5")));
  EXPECT_THAT([&] { table.reader(DataKind::pictures, "take.csv"); },
              ThrowsMessage<UsageError>(HasSubstr("no file holds a value of the kind 'pictures'")));
}

TEST(FormatTable, ReadsAFolderWithAFilesNameAsAFolder) {
  const test::TemporaryFolder folder;
  const std::filesystem::path actor = folder / "actor.glb";
  std::filesystem::create_directory(actor);
  EXPECT_EQ(toolkit_table().reader(DataKind::model, actor).name, "folder of shapes");
  EXPECT_EQ(toolkit_table().reader(DataKind::sequence, actor).name, "folder of meshes");
}

TEST(FormatTable, NamesTheOptionThatBuildsAMissingFormat) {
  OperationTable table = toolkit_table();
  table.add(Format{.name = "films",
                   .kind = DataKind::components,
                   .extensions = {".film"},
                   .built_by = "MIMETRA_FILMS"});
  const auto says_how = ThrowsMessage<UsageError>(
      HasSubstr("films is not built into this program; build it with -DMIMETRA_FILMS=ON"));
  EXPECT_THAT([&] { table.reader(DataKind::components, "a.film"); }, says_how);
  EXPECT_THAT([&] { table.writer({"out", DataKind::components, ""}, "a.film"); }, says_how);
}

TEST(FormatTable, RefusesAnExtensionThatItsKindHasAlready) {
  OperationTable table = toolkit_table();
  EXPECT_THAT([&] { table.add(format_of(".csv")); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("'.csv' is that of 'vertices and their regions' already")));
  // Beside a format that is only read, one that is only written.
  Format written = format_of(".txt");
  EXPECT_THROW(table.add(written), std::invalid_argument);
  written.read = {};
  EXPECT_NO_THROW(table.add(written));
}

TEST(FormatTable, IsWhatHelpAndMessagesOfAnOutputSay) {
  OperationTable table = toolkit_table();
  const auto help = [&table] { return table.help(table.find("regions")->outputs.front()); };
  const auto help_of_input = [&table] { return table.help(table.find("transfer")->inputs.back()); };
  EXPECT_THAT(help(), Not(HasSubstr(".mine")));
  table.add(format_of(".mine"));
  EXPECT_THAT(help(), AllOf(HasSubstr("the regions"), HasSubstr(".json, .csv or .mine")));
  EXPECT_THAT(help_of_input(), HasSubstr(": .om, .json, .csv, .txt or .mine"));
  EXPECT_THAT([&] { table.writer(table.find("regions")->outputs.front(), "a.xyz"); },
              ThrowsMessage<UsageError>(HasSubstr(".json, .csv or .mine, not as '.xyz'")));
}

TEST(FormatTable, PutsFoldersLastInLists) {
  EXPECT_EQ(listed_extensions({".a", "", ".b", ".a"}), ".a, .b or a folder");
  EXPECT_EQ(listed_extensions({"*"}), "any file");
  EXPECT_EQ(listed_extensions({".a"}), ".a");
}

}  // namespace
}  // namespace mimetra
