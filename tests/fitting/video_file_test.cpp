#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/ffmpeg.h"
#include "fitting/video_file.h"
#include "tests/fitting/made_video.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pointwise;
using testing::StartsWith;

/// Grey, brighter with each frame, with a red square in the left upper corner.
Image numbered(int frame, int width = 96, int height = 64) {
  const auto grey = static_cast<std::uint8_t>(40 + 6 * frame);
  Image image(width, height, {grey, grey, grey});
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) image.at(x, y) = {220, 30, 30};
  }
  return image;
}

std::vector<Image> numbered_images(int count, int width = 96, int height = 64) {
  std::vector<Image> images;
  images.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) images.push_back(numbered(i, width, height));
  return images;
}

/// Frame number that an image shows.
int number_of(const Image& image) {
  const Color middle = image.at(image.width / 2, image.height / 2);
  return static_cast<int>(std::lround((middle.green - 40) / 6.0));
}

bool is_red(const Color& color) {
  return color.red > 150 && color.green < 90 && color.blue < 90;
}

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes_of(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// 32 bits, big-endian.
void put_number(std::string& bytes, std::size_t at, std::int32_t value) {
  for (int i = 0; i < 4; ++i) {
    bytes[at + static_cast<std::size_t>(i)] =
        static_cast<char>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
  }
}

/// The video as a player is to turn it: the matrix of its track's header.
void set_matrix(const std::filesystem::path& mp4, int a, int b, int c, int d) {
  std::string bytes = text_of_file(mp4);
  const std::size_t header = bytes.find("tkhd");
  ASSERT_NE(header, std::string::npos);
  const std::size_t matrix = header + 4 + 40;
  constexpr int kOne = 1 << 16;
  put_number(bytes, matrix, a * kOne);
  put_number(bytes, matrix + 4, b * kOne);
  put_number(bytes, matrix + 12, c * kOne);
  put_number(bytes, matrix + 16, d * kOne);
  write_bytes_of(mp4, bytes);
}

class Video : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, int frames, int width = 96,
                              int height = 64) {
    write_video(folder_ / name, numbered_images(frames, width, height), even_times(frames));
    return folder_ / name;
  }
  std::vector<double> times(const VideoFile& video) {
    return {video.times().begin(), video.times().end()};
  }
  TemporaryFolder folder_;
};

TEST_F(Video, HasTheFramesThatWereWritten) {
  for (const char* name : {"v.mp4", "v.mov", "v.mkv"}) {
    const VideoFile video(write(name, 12));
    EXPECT_THAT(video.damage(), IsEmpty()) << name;
    EXPECT_THAT(times(video), Pointwise(DoubleNear(1e-3), even_times(12))) << name;
    for (int f = 0; f < video.frames(); ++f) {
      const Image image = video.image(f);
      EXPECT_EQ(image.width, 96);
      EXPECT_EQ(image.height, 64);
      EXPECT_EQ(number_of(image), f) << name;
      EXPECT_TRUE(is_red(image.at(8, 8))) << name;
      EXPECT_FALSE(is_red(image.at(88, 8))) << name;
    }
  }
}

TEST_F(Video, OfOneFrameHasOne) {
  const VideoFile video(write("v.mp4", 1));
  EXPECT_EQ(video.frames(), 1);
  EXPECT_EQ(video.times()[0], 0);
  EXPECT_EQ(number_of(video.image(0)), 0);
}

TEST_F(Video, GivesTheSameFrameInWhateverOrderItIsAskedFor) {
  const VideoFile video(write("v.mp4", 30));
  for (const int frame : {29, 3, 4, 2, 17, 0, 29}) EXPECT_EQ(number_of(video.image(frame)), frame);
  EXPECT_THROW(video.image(30), std::out_of_range);
  EXPECT_THROW(video.image(-1), std::out_of_range);
}

TEST_F(Video, KeepsTheTimesOfAVariableRate) {
  const std::vector<double> uneven = {0, 0.04, 0.2, 0.21, 0.5, 1.7};
  for (const char* name : {"v.mp4", "v.mkv"}) {
    write_video(folder_ / name, numbered_images(6), uneven);
    const VideoFile video(folder_ / name);
    // Matroska counts milliseconds.
    EXPECT_THAT(times(video), Pointwise(DoubleNear(5e-4), uneven)) << name;
  }
}

TEST_F(Video, IsTurnedAsItsFileSays) {
  const auto path = write("v.mp4", 2);
  set_matrix(path, 0, 1, -1, 0);  // clockwise: what was on the left is on top
  Image image = VideoFile(path).image(0);
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 96);
  EXPECT_TRUE(is_red(image.at(56, 8)));
  EXPECT_FALSE(is_red(image.at(8, 8)));
  set_matrix(path, 0, -1, 1, 0);
  image = VideoFile(path).image(0);
  EXPECT_EQ(image.width, 64);
  EXPECT_TRUE(is_red(image.at(8, 88)));
  set_matrix(path, -1, 0, 0, -1);
  image = VideoFile(path).image(0);
  EXPECT_EQ(image.width, 96);
  EXPECT_TRUE(is_red(image.at(88, 56)));
  set_matrix(path, -1, 0, 0, 1);  // a mirror image
  EXPECT_TRUE(is_red(VideoFile(path).image(0).at(88, 8)));
}

TEST_F(Video, OfOddSizesIsOneColumnAndRowLarger) {
  const Image image = VideoFile(write("v.mp4", 2, 97, 63)).image(1);
  EXPECT_EQ(image.width, 98);
  EXPECT_EQ(image.height, 64);
  EXPECT_EQ(number_of(image), 1);
}

TEST_F(Video, IsTheSameFileWhenItIsWrittenAgain) {
  for (const char* extension : {".mp4", ".mkv"}) {
    const auto first = write(std::string("a") + extension, 10);
    const auto second = write(std::string("b") + extension, 10);
    EXPECT_EQ(text_of_file(first), text_of_file(second));
  }
}

TEST_F(Video, ThatIsNoneIsRefused) {
  write_bytes_of(folder_ / "text.mp4", "this is no video\n");
  EXPECT_THAT(message_of<IoError>([&] { VideoFile(folder_ / "text.mp4"); }),
              AllOf(StartsWith((folder_ / "text.mp4").string()), HasSubstr("is no video")));
  write_bytes_of(folder_ / "empty.mkv", "");
  EXPECT_THROW(VideoFile(folder_ / "empty.mkv"), IoError);
  // A list of other files, which a player would follow.
  write_bytes_of(folder_ / "list.mp4",
                 "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/hostname\n");
  EXPECT_THROW(VideoFile(folder_ / "list.mp4"), IoError);
}

TEST_F(Video, ThatWasCutBeforeItsIndexIsRefused) {
  const std::string whole = text_of_file(write("v.mp4", 20));
  write_bytes_of(folder_ / "cut.mp4", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(message_of<IoError>([&] { VideoFile(folder_ / "cut.mp4"); }),
              HasSubstr("was cut off"));
}

TEST_F(Video, ThatBreaksOffSaysAfterWhichFrame) {
  const std::string whole = text_of_file(write("v.mkv", 50));
  write_bytes_of(folder_ / "cut.mkv", whole.substr(0, whole.size() * 2 / 3));
  const VideoFile video(folder_ / "cut.mkv");
  EXPECT_GT(video.frames(), 0);
  EXPECT_LT(video.frames(), 50);
  EXPECT_THAT(video.damage(), StartsWith("frame " + std::to_string(video.frames())));
  EXPECT_EQ(number_of(video.image(video.frames() - 1)), video.frames() - 1);
}

TEST_F(Video, WithDamagedFramesEndsBeforeThem) {
  const auto path = write("v.mp4", 40);
  std::string bytes = text_of_file(path);
  const std::size_t media = bytes.find("mdat");
  ASSERT_NE(media, std::string::npos);
  // Not the lengths at the beginning, but a stretch in the middle.
  const std::size_t index = bytes.find("moov"), middle = (media + index) / 2;
  for (std::size_t at = middle; at < middle + 40; ++at) bytes[at] = '\x5a';
  write_bytes_of(path, bytes);
  const VideoFile video(path);
  EXPECT_LT(video.frames(), 40);
  EXPECT_THAT(video.damage(), Not(IsEmpty()));
}

TEST_F(Video, OfEveryPrefixIsAnErrorOrEndsEarly) {
  for (const char* name : {"v.mp4", "v.mkv"}) {
    const std::string whole = text_of_file(write(name, 8));
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 40) {
      write_bytes_of(folder_ / (std::string("cut_") + name), whole.substr(0, size));
      try {
        const VideoFile video(folder_ / (std::string("cut_") + name));
        // Where a file has no list of its frames, up to five may be missing that are stored after a
        // later one, from which they differ.
        if (video.damage().empty()) {
          EXPECT_GE(video.frames(), 3) << name << ' ' << size;
        }
      } catch (const IoError&) {
        continue;
      }
    }
  }
}

TEST_F(Video, KeepsTheSoundOfAnother) {
  // One second of a tone as PCM, 8000 samples of 16 bits.
  std::string wav = "RIFF";
  const auto add = [&wav](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) wav += static_cast<char>(value >> (8 * i));
  };
  add(36 + 16000, 4);
  wav += "WAVEfmt ";
  add(16, 4);
  add(1, 2);
  add(1, 2);
  add(8000, 4);
  add(16000, 4);
  add(2, 2);
  add(16, 2);
  wav += "data";
  add(16000, 4);
  for (int i = 0; i < 8000; ++i)
    add(static_cast<std::uint32_t>(std::lround(8000 * std::sin(0.3 * i))), 2);
  write_bytes_of(folder_ / "tone.wav", wav);
  const std::string samples = wav.substr(44);

  write_video(folder_ / "v.mkv", numbered_images(25), even_times(25), folder_ / "tone.wav");
  const std::string with_sound = text_of_file(folder_ / "v.mkv");
  const std::string silent = text_of_file(write("silent.mkv", 25));
  EXPECT_GT(with_sound.size(), silent.size() + samples.size());
  EXPECT_NE(with_sound.find(samples.substr(0, 1000)), std::string::npos);
  EXPECT_THAT(VideoFile(folder_ / "v.mkv").damage(), IsEmpty());

  // Of a part of the frames only what sounds with them.
  const std::vector<Image> images = numbered_images(5);
  write_video(folder_ / "part.mkv", images, {0.4, 0.44, 0.48, 0.52, 0.56}, folder_ / "v.mkv");
  const VideoFile part(folder_ / "part.mkv");
  EXPECT_NEAR(part.times()[0], 0, 1e-3);
  EXPECT_LT(text_of_file(folder_ / "part.mkv").size(), with_sound.size() / 2);

  EXPECT_TRUE(can_keep_sound(folder_ / "v.mkv", ".mkv"));
  EXPECT_FALSE(can_keep_sound(folder_ / "v.mkv", ".mp4"));
  EXPECT_TRUE(can_keep_sound(folder_ / "silent.mkv", ".mp4"));
}

TEST(SharedLibrary, MissingIsNamedAndSoIsAFunction) {
  const auto problem_of = [](const auto& function) {
    return message_of<std::runtime_error>(function);
  };
  EXPECT_THAT(problem_of([] { SharedLibrary("libmissing_here.so.1"); }),
              HasSubstr("libmissing_here.so.1"));
  const SharedLibrary present("libc.so.6");
  EXPECT_THAT(problem_of([&] { present.function<void (*)()>("missing_function"); }),
              AllOf(HasSubstr("libc.so.6"), HasSubstr("missing_function")));
  EXPECT_GT(present.function<decltype(&getpid)>("getpid")(), 0);
}

}  // namespace
}  // namespace mimetra::test
