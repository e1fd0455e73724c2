#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mimetra/fitting/face_images.h>

#include "temporary_folder.h"

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
  EXPECT_THAT(test::message_of<IoError>([] { track_face({"photo.png"}); }),
              says_what_is_missing("photo.png: "));
  EXPECT_THAT(test::message_of<IoError>([] { FaceFinder("model.dat"); }),
              says_what_is_missing("model.dat: "));
  const test::TemporaryFolder folder;
  EXPECT_THAT(
      test::message_of<OutputError>([&] { write_png(Image(2, 2, {}), folder / "out.png"); }),
      says_what_is_missing((folder / "out.png").string()));
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace mimetra
