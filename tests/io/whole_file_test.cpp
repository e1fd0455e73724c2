#include "toolkit/io/pending_output.h"

#include <functional>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;

TEST(ReadFile, ReadsFilesOfAnySize) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0, 1, 65535, 65536, 65537, 1000000}) {
    std::string content(size, '\0');
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i % 251);
    write_bytes(folder / "a", content);
    EXPECT_TRUE(read_file(folder / "a") == content) << size;
  }
}

TEST(ReadFile, SaysWhetherAFileIsMissingOrAFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of<IoError>([&] { read_file(folder / "none"); }),
            (folder / "none").string() + ": no such file");
  EXPECT_EQ(message_of<IoError>([&] { read_file(folder.path()); }),
            folder.path().string() + ": is a folder, expected a file");
}

}  // namespace
}  // namespace mimetra
