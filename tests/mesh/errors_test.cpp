#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

TEST(Errors, AMessageAboutAFileStartsWithItsPath) {
  EXPECT_STREQ(IoError("a/face.obj", "no faces").what(), "a/face.obj: no faces");
  EXPECT_STREQ(OutputError("out.npy", "exists already").what(), "out.npy: exists already");
}

TEST(Errors, AMismatchIsTheCallersError) {
  EXPECT_THROW(throw MismatchError("other mesh"), std::invalid_argument);
}

TEST(Errors, CancelledSaysSo) {
  EXPECT_STREQ(Cancelled().what(), "cancelled");
}

}  // namespace
}  // namespace mimetra
