#include <gtest/gtest.h>

#include "toolkit/cli/suggestion.h"

namespace mimetra::cli {
namespace {

TEST(NearestWord, IsTheOneWithTheFewestEdits) {
  EXPECT_EQ(nearest_word("decompse", {"align", "decompose", "info"}), "decompose");
  EXPECT_EQ(nearest_word("--radios", {"--ratio", "--radius"}), "--radius");
}

TEST(NearestWord, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest_word("banana", {"align", "decompose", "info"}), "");
}

TEST(NearestWord, IsTheEarlierOneOfTwoEquallyNear) {
  EXPECT_EQ(nearest_word("cat", {"bat", "hat"}), "bat");
}

}  // namespace
}  // namespace mimetra::cli
