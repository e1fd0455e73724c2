#include "toolkit/mesh/frame_store.h"

#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/streams.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// TMPDIR for as long as this lives.
class TemporaryFiles {
 public:
  explicit TemporaryFiles(const std::filesystem::path& folder) {
    if (const char* value = std::getenv("TMPDIR")) before_ = value;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFiles() { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }

 private:
  std::string before_;
};

MeshSequence numbered(int frames, int vertices) {
  Frames poses(frames, 3 * vertices);
  for (Eigen::Index i = 0; i < poses.size(); ++i) poses.data()[i] = static_cast<double>(i) / 7;
  return {Connectivity::from_triangles(vertices, Triangles(0, 3)), poses};
}

/// In memory, and in a file.
class FrameStoreTest : public testing::TestWithParam<std::size_t> {
 protected:
  const test::TemporaryFolder folder_;
  const TemporaryFiles here_{folder_.path()};
};

TEST_P(FrameStoreTest, GivesBackWhatSeveralThreadsWroteAndLeavesNoName) {
  const MeshSequence sequence = numbered(50, 11);
  FrameStore store(sequence.header(), GetParam());
  const Context three = Context().with_threads(3);
  parallel_for(
      25, [&](int i) { store.write(2 * i, sequence.read(2 * i, 2)); }, three);
  EXPECT_THAT(folder_.names(), IsEmpty());
  EXPECT_THAT(store.commit(), IsEmpty());
  EXPECT_TRUE(store.read(0, 50) == sequence.positions());
  EXPECT_TRUE(store.read(17, 5) == sequence.positions().middleRows(17, 5));
  EXPECT_TRUE(MeshSequence(store, three).positions() == sequence.positions());
  EXPECT_TRUE(store.times() == sequence.times());
  Frames some(4, 6);
  store.read_vertices(3, 5, FramesView(some.data(), 4, 6));
  EXPECT_TRUE(some == sequence.positions().block(3, 15, 4, 6));
}

TEST_P(FrameStoreTest, RefusesFramesThatAreNotThere) {
  FrameStore store(numbered(3, 2).header(), GetParam());
  EXPECT_THROW(store.write(2, Frames::Zero(2, 6)), std::out_of_range);
}

INSTANTIATE_TEST_SUITE_P(Every, FrameStoreTest, testing::Values(FrameStore::kMemoryBytes, 0),
                         [](const auto& instance) {
                           return instance.param == 0 ? "in_a_file" : "in_memory";
                         });

TEST(FrameStore, NeedsAFolderForTemporaryFiles) {
  const test::TemporaryFolder folder;
  const TemporaryFiles missing(folder.path() / "missing");
  const SequenceHeader header = numbered(3, 2).header();
  EXPECT_NO_THROW(FrameStore(header, FrameStore::kMemoryBytes));
  EXPECT_THAT([&] { FrameStore(header, 0); },
              ThrowsMessage<OutputError>(
                  testing::AllOf(HasSubstr("missing"), HasSubstr("set TMPDIR to a folder"))));
}

/// Ends the process with 5 and the message where the store has no room for all frames.
void store_on_a_small_disk(const MeshSequence& sequence) {
  // A disk is as small as the largest file that a process may write.
  const rlimit small = {1000, 1000};
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  try {
    FrameStore(sequence.header(), 0).write(0, sequence.positions());
  } catch (const OutputError& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(5);
  }
}

TEST(FrameStore, SaysThatThereIsNoRoom) {
  const test::TemporaryFolder folder;
  const TemporaryFiles here(folder.path());
  EXPECT_EXIT(store_on_a_small_disk(numbered(100, 100)), testing::ExitedWithCode(5),
              "cannot keep the numbers of this run for a while: File too large; set TMPDIR");
}

TEST(Stored, IsTheSourceItselfWhereThatIsQuick) {
  const auto quick = std::make_shared<const MeshSequence>(numbered(5, 2));
  EXPECT_EQ(stored(quick), quick);
}

TEST(Stored, ReadsASlowSourceOnce) {
  const MeshSequence sequence = numbered(300, 2);
  const auto slow = test::streamed(sequence);
  const auto kept = stored(slow, Context().with_threads(3));
  EXPECT_EQ(slow->frames_read(), 300);
  EXPECT_TRUE(MeshSequence(*kept).positions() == sequence.positions());
  EXPECT_EQ(slow->frames_read(), 300);
  EXPECT_TRUE(kept->is_quick());
}

TEST(Stored, ThrowsWhatReadingThrows) {
  EXPECT_THAT([] { stored(test::streamed(numbered(300, 2), 200)); },
              ThrowsMessage<std::runtime_error>("frame 200 is broken"));
}

TEST(Stored, EndsWhereProgressAsksForIt) {
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(stored(test::streamed(numbered(300, 2)), cancelled), Cancelled);
}

}  // namespace
}  // namespace mimetra
