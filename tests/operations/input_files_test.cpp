#include "toolkit/operations/call.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "tests/thread_ranks.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class InputFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  /// What the second of two ranks says, whose files are in the folder "other".
  std::string said_by_second(const std::vector<std::string>& names) {
    std::string said;
    test::on_ranks(2, [&](const Ranks& ranks) {
      std::vector<std::filesystem::path> files;
      files.reserve(names.size());
      for (const std::string& name : names) {
        files.push_back(folder_ / (ranks.rank() == 0 ? "own" : "other") / name);
      }
      try {
        check_same_inputs(files, Context().with_ranks(ranks));
      } catch (const MismatchError& error) {
        EXPECT_EQ(ranks.rank(), 1);
        said = error.what();
      }
    });
    return said;
  }

  test::TemporaryFolder folder_;
};

TEST_F(InputFiles, AreThoseOfFoldersInOrder) {
  write("b/2.txt", "2");
  write("b/1.txt", "1");
  write("a.txt", "a");
  EXPECT_THAT(input_files({folder_ / "b", folder_ / "a.txt"}),
              ElementsAre(folder_ / "b/1.txt", folder_ / "b/2.txt", folder_ / "a.txt"));
}

TEST_F(InputFiles, OfAllRanksAreTheSameWhateverTheirPlace) {
  for (const std::string place : {"own/", "other/"}) {
    write(place + "take.npy", std::string(300'000, 'x'));
    write(place + "empty", "");
  }
  EXPECT_EQ(said_by_second({"take.npy", "empty"}), "");
}

TEST_F(InputFiles, OfAnotherSizeBeginningOrEndAreNamed) {
  const std::string take(300'000, 'x');
  write("own/rest.obj", "v");
  write("other/rest.obj", "v");
  write("own/take.npy", take);
  for (const std::string& other :
       {take + "x", "y" + take.substr(1), take.substr(1) + "y", std::string()}) {
    write("other/take.npy", other);
    EXPECT_THAT(said_by_second({"rest.obj", "take.npy"}),
                AllOf(HasSubstr("other/take.npy: process 1 reads another content than process 0")));
  }
}

TEST_F(InputFiles, OfAnotherNumberAreCounted) {
  for (const std::string name : {"own/f/1.obj", "own/f/2.obj", "other/f/1.obj"}) write(name, "v");
  EXPECT_THAT(said_by_second({"f"}), HasSubstr("process 1 reads 1 file, process 0 2"));
}

}  // namespace
}  // namespace mimetra
