#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace {

/// Smaller ones always succeed: libstdc++'s filesystem::path crashes by itself where one fails.
constexpr std::size_t kLarge = 1024;

/// Large allocations until one fails; below 0 for none.
std::atomic<long> left = -1;

bool fails(std::size_t bytes) {
  return bytes >= kLarge && left >= 0 && left-- == 0;
}

}  // namespace

// The linker sends the test's allocations here (--wrap, in CMakeLists.txt).
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the linker's names
extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_realloc(void* memory, std::size_t bytes);
void* __real__Znwm(std::size_t bytes);
void* __real__Znam(std::size_t bytes);
void* __real__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);

void* __wrap_malloc(std::size_t bytes);
void* __wrap_malloc(std::size_t bytes) {
  return fails(bytes) ? nullptr : __real_malloc(bytes);
}

void* __wrap_realloc(void* memory, std::size_t bytes);
void* __wrap_realloc(void* memory, std::size_t bytes) {
  return fails(bytes) ? nullptr : __real_realloc(memory, bytes);
}

void* __wrap__Znwm(std::size_t bytes);
void* __wrap__Znwm(std::size_t bytes) {
  if (fails(bytes)) throw std::bad_alloc();
  return __real__Znwm(bytes);
}

void* __wrap__Znam(std::size_t bytes);
void* __wrap__Znam(std::size_t bytes) {
  if (fails(bytes)) throw std::bad_alloc();
  return __real__Znam(bytes);
}

void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment);
void* __wrap__ZnwmSt11align_val_t(std::size_t bytes, std::align_val_t alignment) {
  if (fails(bytes)) throw std::bad_alloc();
  return __real__ZnwmSt11align_val_t(bytes, alignment);
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace mimetra {
namespace {

/// Runs `work` with its first large allocation failing, its second, and so on until none fails.
/// Calls `check` after each that failed. Returns how many did.
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

/// Large enough for its parts to count.
MeshSequence short_take() {
  const test::Shape shape = test::grid(12, 12);
  Frames frames(3, shape.positions.size());
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), frames.cols());
  return {Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
          frames};
}

const std::vector<std::string> kTakes = {"take/",   "take.npy", "take.npz", "take.pc2",
                                         "take.h5", "take.glb", "take.mdd"};

TEST(FailedAllocation, WhileWritingLeavesNothingUnderTheName) {
  const MeshSequence take = short_take();
  for (const std::string& name : kTakes) {
    const test::TemporaryFolder folder;
    const auto write = [&] {
      write_sequence(take, folder / name, {.overwrite = true}, Context().with_threads(1));
    };
    const int failed = fail_each(write, [&] {
      for (const std::string& left_behind : folder.names()) {
        EXPECT_FALSE(left_behind.starts_with("take")) << name << ": " << left_behind;
      }
    });
    EXPECT_GT(failed, 2) << name;
  }
}

TEST(FailedAllocation, WhileReadingIsAnErrorAndNotACrash) {
  const test::TemporaryFolder folder;
  for (const std::string& name : kTakes) {
    write_sequence(short_take(), folder / name, {.overwrite = true});
    const std::string path = (folder / name).string();
    EXPECT_GT(fail_each([&] { read_sequence(path, {}, Context().with_threads(1)); }, [] {}), 2)
        << name;
  }
  write_bytes(folder / "a.json", "[\"" + std::string(2 * kLarge, 'x') + "\"]");
  EXPECT_GT(fail_each([&] { json_text(read_json(folder / "a.json")); }, [] {}), 2);
}

}  // namespace
}  // namespace mimetra
