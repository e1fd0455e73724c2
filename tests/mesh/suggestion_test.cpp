#include <gtest/gtest.h>

#include "toolkit/mesh/suggestion.h"

namespace mimetra {
namespace {

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
