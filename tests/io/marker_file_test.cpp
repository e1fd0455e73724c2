#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class MarkerFile : public testing::Test {
 protected:
  std::vector<Marker> read(const std::string& content, int base = 0) {
    std::ofstream(folder_ / "m.cons", std::ios::trunc) << content;
    return read_markers(folder_ / "m.cons", base);
  }
  void refused(const std::string& content, const std::string& why, int base = 0) {
    EXPECT_THAT([&] { read(content, base); }, ThrowsMessage<IoError>(HasSubstr(why)));
  }
  test::TemporaryFolder folder_;
};

TEST_F(MarkerFile, IsReadInEveryFormThatPeopleWrite) {
  const std::vector<Marker> expected = {{12, 34}, {56, 78}, {90, 11}};
  EXPECT_EQ(read("3\n12, 34\n56, 78\n90, 11\n"), expected) << ".cons";
  EXPECT_EQ(read("12 34\r\n56 78\r\n90 11"), expected) << ".corr";
  EXPECT_EQ(read("# nose, chin, ear\n12:34\n\n56:78 # chin\n90:11#ear\n"), expected);
  EXPECT_EQ(read("markers:\n  - 12:34\n  - 56:78\n  - 90:11\n"), expected) << "YAML";
  EXPECT_EQ(read("12 56 90\n34 78 11\n"), expected) << "two lists";
  EXPECT_EQ(read("{\"source\": [12, 56, 90],\n \"target\": [34, 78, 11]}\n"), expected) << "JSON";
  EXPECT_EQ(read("target: [34, 78, 11]\nsource: [12, 56, 90]\n"), expected);
}

TEST_F(MarkerFile, DoesNotGuessWhichListIsWhich) {
  const std::vector<Marker> expected = {{12, 34}, {56, 78}, {90, 11}};
  EXPECT_EQ(read("12 56 90\ntarget: 34 78 11\n"), expected);
  refused("tgt: 34 78 11\nsrc: 12 56 90\n", "line 1: a list of vertices named 'tgt'");
  refused("tgt: 34 78 11\n12 56 90\n", "expected one 'source' and one 'target'");
  refused("target: 34 78 11\ntarget: 12 56 90\n", "line 2: a list of vertices named 'target'");
}

TEST_F(MarkerFile, IsReadAsItIsWritten) {
  const std::vector<Marker> markers = {{12, 34}, {0, 78}, {90, 11}};
  const std::string text =
      marker_text(markers, {"nose", "chin 1 2", "ear"}, {"3 markers", "source, target"});
  EXPECT_EQ(text.substr(0, 12), "# 3 markers\n");
  EXPECT_EQ(read(text), markers);
  EXPECT_EQ(read(marker_text(markers)), markers);
}

TEST_F(MarkerFile, CountsFromOneWhereItIsToldSo) {
  EXPECT_THAT(read("12 34\n1 2\n", 1), ElementsAre(Marker{11, 33}, Marker{0, 1}));
  refused("12 34\n0 2\n", "line 2: vertex 0, expected one from 1 on", 1);
}

TEST_F(MarkerFile, NamesTheLineOfWhatIsNoPair) {
  refused("12 34\n56\n", "line 2: expected two vertices, of the source and of the target, found 1");
  refused("12 34\n56 78 90\n", "found 3");
  refused("12 34\n56 seven\n", "expected an integer for a vertex, found 'seven'");
  refused("12 34.5\n", "expected an integer for a vertex");
  refused("12 -3\n", "line 1: vertex -3, expected one from 0 on");
  refused("12 4294967296\n", "vertex 4294967296");
  refused("12 -9223372036854775808\n", "vertex -9223372036854775808", 1);
  refused("3\n12, 34\n56, 78\n", "line 1: announces 3 markers, found 2");
  refused("# nothing\n", "holds no marker");
  refused("", "holds no marker");
}

}  // namespace
}  // namespace mimetra
