#include "toolkit/io/binary_file.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(OpenedFile, OfAnotherContentThanItsNameSaysIsNamed) {
  const TemporaryFolder folder;
  const auto error = [&folder](const std::string& name, const std::string& content) {
    write_bytes(folder / name, content);
    return message_of<IoError>([&] { read_sequence((folder / name).string()); });
  };
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
  for (const char* name : {"a.obj", "a.npy", "a.npz", "a.glb", "a.stl"}) {
    EXPECT_THAT(error(name, pointer), HasSubstr("'git lfs pull' fetches it")) << name;
  }
  for (const char* name : {"b.obj", "b.ply", "b.off", "b.stl"}) {
    EXPECT_THAT(error(name, ""), HasSubstr("is empty, expected a mesh")) << name;
  }
  for (const char* name : {"c.obj", "c.ply", "c.off"}) {
    EXPECT_THAT(error(name, std::string("\xFF\xFEv\0 \0", 6)), HasSubstr("is text in UTF-16"))
        << name;
  }
  write_bytes(folder / "w.json", std::string("\xFE\xFF\0{", 4));
  EXPECT_THAT(message_of<IoError>([&] { read_weights(folder / "w.json"); }), HasSubstr("UTF-16"));
}

/// A pipe, named as bash names `<(command)`.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe(ends_), 0); }
  ~Pipe() {
    close(ends_[0]);
    finish();
  }
  std::string name() const { return "/dev/fd/" + std::to_string(ends_[0]); }
  void write(const std::string& text) const {
    EXPECT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void finish() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  int ends_[2];
};

TEST(OpenedFile, WaitsForNothingThatIsNoFile) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "a.obj").c_str(), 0600), 0);
  for (const std::string device : {"/dev/zero", "/dev/null", "/dev/random"}) {
    EXPECT_EQ(message_of<IoError>([&] { read_file(device); }),
              device + ": is a device, expected a file");
  }
  EXPECT_THAT(message_of<IoError>([&] { read_mesh(folder / "a.obj"); }), HasSubstr("a named pipe"));
  EXPECT_THAT(message_of<IoError>([&] { read_sequence((folder / "a.obj").string()); }),
              HasSubstr("a named pipe"));
}

TEST(OpenedFile, RefusesASocket) {
  const TemporaryFolder folder;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "s").c_str(), sizeof address.sun_path - 1);
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(message_of<IoError>([&] { read_file(folder / "s"); }), HasSubstr("is a socket"));
  close(descriptor);
}

TEST(OpenedFile, ReadsALoopOfLinksAsAnError) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("b", folder / "a");
  std::filesystem::create_symlink("a", folder / "b");
  EXPECT_THROW(read_file(folder / "a"), IoError);
}

TEST(OpenedFile, TakesAPipeOfTheProcessToItsEnd) {
  Pipe pipe;
  pipe.write("v 0 0 0\n");
  pipe.write("v 1 0 0\n");
  pipe.finish();
  EXPECT_EQ(read_file(pipe.name()), "v 0 0 0\nv 1 0 0\n");
}

TEST(OpenedFile, StopsWaitingForAPipeWhenASignalComes) {
  const Pipe pipe;  // into which nobody writes
  const auto before = std::signal(SIGALRM, [](int) {});
  // Again and again: the first one may come before it waits.
  constexpr itimerval kEvery50ms{{0, 50000}, {0, 50000}};
  setitimer(ITIMER_REAL, &kEvery50ms, nullptr);
  EXPECT_THROW(read_file(pipe.name()), Cancelled);
  constexpr itimerval kNever{};
  setitimer(ITIMER_REAL, &kNever, nullptr);
  std::signal(SIGALRM, before);
}

TEST(OpenedFile, AModelThatNamesADeviceIsRefused) {
  const TemporaryFolder folder;
  for (const std::string part : {"neutral", "shape"}) {
    write_bytes(folder / "model.json", "{\"" + part + "\": \"/dev/zero\", \"expressions\": \"e\"}");
    EXPECT_THROW(read_model(folder.path()), IoError) << part;
  }
}

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
