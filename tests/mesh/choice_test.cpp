#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/choice.h"

namespace mimetra {
namespace {

using testing::ElementsAre;

enum class Unnamed { one, two };

TEST(Choice, HasItsValuesInTheOrderOfTheEnum) {
  EXPECT_THAT(choices<AlignmentVertices>(),
              ElementsAre(AlignmentVertices::stable, AlignmentVertices::all));
  EXPECT_THAT(choice_names<AlignmentVertices>(), ElementsAre("stable", "all"));
}

TEST(Choice, IsFoundByItsNameOnly) {
  EXPECT_EQ(choice_of<AlignmentVertices>("all"), AlignmentVertices::all);
  for (const char* other : {"", "ALL", "al", "alls"}) {
    EXPECT_FALSE(choice_of<AlignmentVertices>(other)) << other;
  }
}

TEST(Choice, NeedsNames) {
  EXPECT_TRUE(NamedChoice<AlignmentVertices>);
  EXPECT_FALSE(NamedChoice<Unnamed>);
  EXPECT_FALSE(NamedChoice<int>);
}

}  // namespace
}  // namespace mimetra
