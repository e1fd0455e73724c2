#include <algorithm>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/threads/together.h"
#include "toolkit/formats/formats.h"
#include "toolkit/formats/sequence_file.h"

namespace mimetra {
namespace {

using test::kTogether;
using test::together;

constexpr int kFrames = 16;

const Context kTwoThreads = Context().with_threads(2);

/// Formats whose sequences can be written and read again.
std::vector<Format> sequence_formats() {
  std::vector<Format> found = formats();
  std::erase_if(found, [](const Format& format) {
    return !format.open || !format.create || format.has(Format::kFolder);
  });
  return found;
}

/// A file, or a folder where the format's files hold one mesh each.
std::string output_of(const Format& format) {
  const std::string& extension = format.extensions.front();
  return is_mesh_extension(extension) ? extension.substr(1) + "/" : "a" + extension;
}

WriteOptions options_of(const Format& format) {
  WriteOptions options{.overwrite = true};
  const std::string& extension = format.extensions.front();
  if (is_mesh_extension(extension)) options.frame_format = extension.substr(1);
  return options;
}

TEST(SequencesOfEveryFormat, AreReadByThreadsAtOnce) {
  const test::TemporaryFolder folder;
  const MeshSequence take = test::bulging_sphere(kFrames);
  for (const Format& format : sequence_formats()) {
    const std::filesystem::path target = folder / output_of(format);
    write_sequence(take, target, options_of(format), kTwoThreads);
    const auto frames = open_sequence(target.string(), {}, kTwoThreads).frames;
    const Frames expected = frames->read(0, kFrames);
    together([&](int i) {
      for (int f = 0; f < kFrames; ++f) {
        const int frame = (f * (i + 1)) % kFrames;  // each in an order of its own
        EXPECT_TRUE(frames->read(frame, 1) == expected.row(frame)) << format.name;
      }
    });
  }
}

TEST(SequencesOfEveryFormat, OfThreadsThatWriteOneOutputOneWinsWhole) {
  const test::TemporaryFolder folder;
  const MeshSequence take = test::bulging_sphere(4);
  for (const Format& format : sequence_formats()) {
    const std::filesystem::path target = folder / output_of(format);
    together([&](int i) {
      const Frames poses = take.positions() * (i + 1);
      write_sequence(take.with_frames(poses), target, options_of(format), kTwoThreads);
    });
    const Frames found = read_sequence(target.string()).sequence.positions();
    const bool is_one_of_them = std::ranges::any_of(std::array{1, 2, 3, 4}, [&](double scale) {
      return format.extensions.front() == ".stl" ||  // numbers its vertices anew
             found.isApprox(take.positions() * scale, 1e-6);
    });
    EXPECT_TRUE(is_one_of_them) << format.name;
  }
}

}  // namespace
}  // namespace mimetra
