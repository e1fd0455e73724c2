#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/face_images.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(WithoutDlib, AskingForImagesSaysWhichPackagesAreMissing) {
  const auto says_what_is_missing = [](const std::string& name) {
    return AllOf(StartsWith(name), HasSubstr("without which mimetra was built"),
                 HasSubstr("libdlib-dev"), HasSubstr("libdlib-data"));
  };
  EXPECT_THAT(test::message_of<IoError>([] { track_face(ImageFiles({"photo.png"})); }),
              says_what_is_missing("photo.png: "));
  EXPECT_THAT(test::message_of<IoError>([] { FaceFinder("model.dat"); }),
              says_what_is_missing("model.dat: "));
}

}  // namespace
}  // namespace mimetra
