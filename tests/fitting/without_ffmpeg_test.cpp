#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/landmark_input.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

TEST(WithoutFfmpeg, AskingForAVideoSaysWhichPackagesAreMissing) {
  const test::TemporaryFolder folder;
  const std::string video = folder / "take.mp4";
  std::ofstream(video) << "not looked at";
  EXPECT_THAT(test::message_of<IoError>([&] { read_landmark_input(video); }),
              testing::AllOf(testing::StartsWith(video),
                             testing::HasSubstr("without which mimetra was built"),
                             testing::HasSubstr("libavformat-dev")));
}

}  // namespace
}  // namespace mimetra
