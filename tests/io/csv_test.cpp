#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/csv.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

class Csv : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    write_bytes(folder_ / "a.csv", text);
    return folder_ / "a.csv";
  }

  test::TemporaryFolder folder_;
};

TEST_F(Csv, HasNamesAndRowsWithoutMarkBlanksAndQuotes) {
  CsvReader csv(file("\xEF\xBB\xBF\"a, \"\"b\"\"\", c \r\n\r\n 1 ,\"2\"\r\n"));
  EXPECT_THAT(csv.names(), ElementsAre("a, \"\"b\"\"", "c"));
  EXPECT_EQ(text_of_csv(csv.names()[0]), "a, \"b\"");
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.field(0), "1");
  EXPECT_EQ(csv.number(1), 2);
  EXPECT_FALSE(csv.next_row());
}

TEST_F(Csv, NamesTheLineOfWhatIsWrong) {
  CsvReader csv(file("a,b\n\n1,x\n1\n"));
  ASSERT_TRUE(csv.next_row());
  EXPECT_THAT(message_of<IoError>([&] { csv.number(1); }),
              HasSubstr("a.csv: line 3: column 'b': expected a finite number, found 'x'"));
  EXPECT_THAT(message_of<IoError>([&] { csv.next_row(); }),
              HasSubstr("a.csv: line 4: 1 field, expected 2"));
  EXPECT_THAT(message_of<IoError>([&] { CsvReader(file("\n \n")); }), HasSubstr("is empty"));
}

TEST_F(Csv, FieldsComeBackAsTheyWereWritten) {
  for (const std::string text : {"plain", "a,b", "a;b", "#a", "say \"no\"", "\"", ","}) {
    CsvReader csv(file(csv_field(text) + ",x\n"));
    EXPECT_EQ(text_of_csv(csv.names()[0]), text);
  }
}

TEST_F(Csv, NamesMayStandInTheCommentBeforeNumbers) {
  for (const std::string text :
       {"# by hand\n# a,b\n1,2\n3,4\n", "#a;b\n1,0;2\n3;4,0\n", "# by hand\n#a,b,\n1,2,\n3,4,\n"}) {
    CsvReader csv(file(text));
    EXPECT_THAT(csv.names(), ElementsAre("a", "b"));
    ASSERT_TRUE(csv.next_row());
    EXPECT_EQ(csv.number(0), 1);
    EXPECT_EQ(csv.number(1), 2);
    ASSERT_TRUE(csv.next_row());
    EXPECT_EQ(csv.number(1), 4);
    EXPECT_EQ(csv.line(), text.starts_with("#a") ? 3 : 4);
    EXPECT_FALSE(csv.next_row());
  }
  for (const std::string first : {"nan,2", "1,", ",2", "NaN,2"}) {
    EXPECT_THAT(CsvReader(file("# a,b\n" + first + "\n3,4\n")).names(), ElementsAre("a", "b"));
  }
  EXPECT_THAT(CsvReader(file("# a,b\nnan,\n3,4\n")).names(), ElementsAre("nan"));
  for (const std::string first : {"nan,nan", "NaN,nan"}) {
    EXPECT_THAT(CsvReader(file("# a,b\n" + first + "\n3,4\n")).names(), ElementsAre("a", "b"));
  }
  EXPECT_THAT(CsvReader(file("# take 7, by hand\na,b\n1,2\n")).names(), ElementsAre("a", "b"));
  EXPECT_THAT(CsvReader(file("# take 7\n1,2\n3,4\n")).names(), ElementsAre("1", "2"));
}

TEST_F(Csv, CommasAreDecimalWhereSemicolonsSeparate) {
  CsvReader csv(file("a;\"b,c\";d\n0,5;1.5;-2,5e-1;\n1,2,3;0;0\n"));
  EXPECT_THAT(csv.names(), ElementsAre("a", "b,c", "d"));
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.number(0), 0.5);
  EXPECT_EQ(csv.number(1), 1.5);
  EXPECT_EQ(csv.number(2), -0.25);
  ASSERT_TRUE(csv.next_row());
  EXPECT_THAT(message_of<IoError>([&] { csv.number(0); }), HasSubstr("line 3: column 'a'"));
}

}  // namespace
}  // namespace mimetra
