#include <gtest/gtest.h>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

TEST(NaturalLess, TwoComesBeforeTen) {
  EXPECT_TRUE(natural_less("frame_2.obj", "frame_10.obj"));
  EXPECT_FALSE(natural_less("frame_10.obj", "frame_2.obj"));
  EXPECT_TRUE(natural_less("a9b1", "a10b0"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("1", "99999999999999999999999999999"));
}

TEST(NaturalLess, OrdersEqualNumbersOfDifferentLengthOneWay) {
  EXPECT_NE(natural_less("f1", "f01"), natural_less("f01", "f1"));
  EXPECT_FALSE(natural_less("f1", "f1"));
  EXPECT_TRUE(natural_less("f01a", "f1b"));
}

TEST(Text, IsPrintableWithoutControlsInUtf8) {
  EXPECT_TRUE(is_printable("smile \u7b11 <&\"'>"));
  EXPECT_TRUE(is_printable(""));
  for (const char* text : {"a\nb", "\t", "\x1b[31m", "\x7f", "\u009b", "br\xe4ue", "\u202e"}) {
    EXPECT_FALSE(is_printable(text)) << text;
  }
}

TEST(Text, ListsTheFirstOfManyAndCountsTheRest) {
  EXPECT_EQ(listed({"a", "b", "c"}, 3), "a, b, c");
  EXPECT_EQ(listed({"a", "b", "c"}, 2), "a, b and 1 more");
  EXPECT_EQ(listed({}, 2), "");
}

TEST(Text, JoinsWordsAsPeopleReadThem) {
  EXPECT_EQ(joined(words_of({2}), ", ", " and "), "2");
  EXPECT_EQ(joined(words_of({2, 5, 7}), ", ", " and "), "2, 5 and 7");
}

TEST(Text, ShowsNumbersAndSharesAsPeopleReadThem) {
  EXPECT_EQ(readable(1234.56), "1235");
  EXPECT_EQ(readable(0.000123456, 2), "0.00012");
  EXPECT_EQ(readable(-184.6, 2), "-185");
  EXPECT_EQ(readable(9999.6), "10000");
  EXPECT_EQ(readable(1234567), "1.235e+06");
  EXPECT_EQ(readable(1e39), "1e+39");
  EXPECT_EQ(fixed(-0.126, 2), "-0.13");
  EXPECT_EQ(fixed(1e300, 1).size(), 303u);
  EXPECT_EQ(percent(0.1234), "12.3 %");
}

TEST(Text, LowersTheLettersOfAnExtensionAndNothingElse) {
  EXPECT_EQ(lower_extension("FACE.PLY"), ".ply");
  EXPECT_EQ(lower_extension("Face"), "");
  EXPECT_EQ(lower_case("\xC3\x84Z_9"), "\xC3\x84z_9");
}

TEST(NearestWord, IsTheOneWithTheFewestEdits) {
  EXPECT_EQ(nearest_word("decompse", {"align", "decompose", "info"}), "decompose");
  EXPECT_EQ(nearest_word("--radios", {"--ratio", "--radius"}), "--radius");
}

TEST(NearestWord, MayBeInOtherLetters) {
  EXPECT_EQ(nearest_word("JAWOPEN", {"jawLeft", "jawOpen"}), "jawOpen");
  EXPECT_EQ(nearest_word("--K", {"-o", "-k"}), "-k");
}

TEST(NearestWord, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest_word("banana", {"align", "decompose", "info"}), "");
}

TEST(NearestWord, IsTheEarlierOneOfTwoEquallyNear) {
  EXPECT_EQ(nearest_word("cat", {"bat", "hat"}), "bat");
}

}  // namespace
}  // namespace mimetra
