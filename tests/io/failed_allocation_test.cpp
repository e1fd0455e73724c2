#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace {

/// Allocations until one fails; below 0 for none.
std::atomic<long> left = -1;

}  // namespace

void* operator new(std::size_t bytes) {
  if (left >= 0 && left-- == 0) throw std::bad_alloc();
  void* memory = std::malloc(bytes > 0 ? bytes : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace mimetra {
namespace {

/// Runs `work` with its first allocation failing, its second, and so on until none fails. Calls
/// `check` after each that failed. Returns how many did.
template <typename Work, typename Check>
int fail_each(const Work& work, const Check& check) {
  for (long n = 0;; ++n) {
    bool is_done = false;
    left = n;
    try {
      work();
      is_done = true;
    } catch (const std::bad_alloc&) {
    } catch (const IoError&) {  // of a library that says so in its way
    } catch (const OutputError&) {
    }
    const bool failed = left < 0;
    left = -1;
    if (!failed) {
      EXPECT_TRUE(is_done);
      return static_cast<int>(n);
    }
    check();
  }
}

MeshSequence short_take() {
  const test::Shape shape = test::grid(3, 3);
  Frames frames(3, shape.positions.size());
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), frames.cols());
  return {Connectivity::from_triangles(9, shape.triangles), frames};
}

TEST(FailedAllocation, WhileWritingLeavesNothingUnderTheName) {
  const MeshSequence take = short_take();
  for (const std::string name : {"take/", "take.npy", "take.npz", "take.pc2"}) {
    const test::TemporaryFolder folder;
    const auto write = [&] {
      write_sequence(take, folder / name, {.overwrite = true, .threads = 1});
    };
    const int failed = fail_each(write, [&] {
      for (const std::string& left_behind : folder.names()) {
        EXPECT_EQ(left_behind.find("take"), std::string::npos) << name << ": " << left_behind;
      }
    });
    EXPECT_GT(failed, 3) << name;
  }
}

TEST(FailedAllocation, WhileReadingIsAnErrorAndNotACrash) {
  const test::TemporaryFolder folder;
  for (const std::string name : {"take/", "take.npy", "take.npz", "take.pc2"}) {
    write_sequence(short_take(), folder / name, {.overwrite = true});
    const std::string path = (folder / name).string();
    EXPECT_GT(fail_each([&] { read_sequence(path, {.threads = 1}); }, [] {}), 3) << name;
  }
  write_bytes(folder / "a.json",
              R"({"a": [1, {"b": "a long text that is allocated for itself"}]})");
  EXPECT_GT(fail_each([&] { json_text(read_json(folder / "a.json")); }, [] {}), 3);
}

}  // namespace
}  // namespace mimetra
