// Formats of plugins: what the table takes, and what becomes of those that do something wrong.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plugins/c/plugins.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

class PluginFormat : public testing::Test {
 protected:
  PluginFormat() {
    add_toolkit(table_);
    problems_ = add_plugins(table_, {fs::path(MIMETRA_TEST_PLUGINS) / "formats"});
  }

  /// A file that exists, for readers.
  std::string file(const std::string& name) const {
    std::ofstream(folder_.path() / name) << "text\n";
    return folder_.path() / name;
  }

  std::vector<fs::path> write(const Data& data, const std::string& name) const {
    const fs::path target = folder_.path() / name;
    const Format& format = table_.writer({"out", kind_of(data), ""}, target);
    return format.write(data, target, {}, {});
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  OperationTable table_;
  std::vector<std::string> problems_;
  test::TemporaryFolder folder_;
};

TEST_F(PluginFormat, WithAnImpossibleDescriptionIsLeftOut) {
  EXPECT_THAT(problems_,
              ElementsAre(HasSubstr("a format has no name"), HasSubstr("the kind 99"),
                          HasSubstr("'no extension' has no extensions"),
                          HasSubstr("the extension 'mesh'"), HasSubstr("the extension '.MESH'"),
                          HasSubstr("'.npy' is that of 'NumPy array' already"),
                          HasSubstr("no function to read or to write"),
                          HasSubstr("'path' is that of the file"),
                          HasSubstr("parameter 'k' means two things"),
                          HasSubstr("neither of reading nor of writing")));
  OperationTable toolkit;
  add_toolkit(toolkit);
  EXPECT_EQ(table_.formats().size(), toolkit.formats().size() + 5);
}

TEST_F(PluginFormat, ReadsAValueWithItsOptionsForTheMeshAtHand) {
  const std::string text = file("a.spot");
  const Format& format = table_.reader(DataKind::regions, text);
  Parameters parameters(format.reading);
  const ReadOptions options{.vertices = 25, .parameters = &parameters};
  const ReadValue read = format.read(text, options, {});
  EXPECT_EQ(std::get<RegionData>(read.value.data).regions.regions.size(), 1u);
  EXPECT_EQ(read.value.name, text);
  EXPECT_THAT(read.files, ElementsAre(fs::path(text)));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("a note")));
  parameters.set("vertices", std::int64_t{24});
  EXPECT_THAT([&] { format.read(text, options, {}); },
              ThrowsMessage<MismatchError>(AllOf(HasSubstr("24 vertices"), HasSubstr("25"))));
  EXPECT_THROW(format.read(folder_.path() / "none.spot", options, {}), IoError);
}

TEST_F(PluginFormat, WritesAValueUnderTheNameThatWasAskedFor) {
  const Table numbers{{"a", "b"}, {{1.0, 2.0}, {3.0, 4.0}, {5.0, 6.0}}};
  EXPECT_THAT(write(numbers, "size.count"), ElementsAre(folder_.path() / "size.count"));
  EXPECT_EQ(read_file(folder_.path() / "size.count"), "3 x 2 none\n");
  EXPECT_THAT(names(), ElementsAre("size.count"));
  EXPECT_THROW(write(numbers, "size.count"), OutputError);
}

TEST_F(PluginFormat, ThatFailsEndsWithItsMessageAndLeavesNothing) {
  const test::Shape shape = test::grid(4, 3);
  const int vertices = static_cast<int>(shape.positions.rows());
  const Data sheet =
      FieldSequence(MeshSequence(Connectivity::from_triangles(vertices, shape.triangles),
                                 Frames(shape.positions.reshaped<Eigen::RowMajor>().transpose())));
  EXPECT_THAT([&] { write(sheet, "a.none"); },
              ThrowsMessage<OutputError>(AllOf(HasSubstr("a.none"), HasSubstr("wrote nothing"))));
  EXPECT_THAT(
      [&] { write(sheet, "a.throws"); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.throws"), HasSubstr("a bad day"))));
  EXPECT_THAT([&] { write(sheet, "a.half"); },
              ThrowsMessage<MismatchError>(AllOf(HasSubstr("a.half"), HasSubstr("only half"))));
  EXPECT_THAT(names(), IsEmpty());
  const std::string text = file("b.none");
  EXPECT_THAT([&] { table_.reader(DataKind::sequence, text).read(text, {}, {}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("b.none"), HasSubstr("0 values"))));
}

}  // namespace
}  // namespace mimetra
