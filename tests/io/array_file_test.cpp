#include "toolkit/io/array_file.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/npy.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

Frames some_frames(int frames, int vertices) {
  Frames result(frames, 3 * vertices);
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result.data()[i] = std::sin(1 + 0.7 * static_cast<double>(i)) / 3;
  }
  return result;
}

/// An array as NumPy writes it.
std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::string& data, char version = 1) {
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY";
  bytes.append({version, '\0'});
  bytes += static_cast<char>(header.size());
  bytes.append(version == 1 ? 1 : 3, '\0');
  return bytes + header + data;
}

template <typename Number>
std::string raw(const std::vector<Number>& numbers, bool swapped = false) {
  std::string bytes;
  for (const Number& number : numbers) {
    std::string one(reinterpret_cast<const char*>(&number), sizeof number);
    if (swapped) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

const std::vector<double> kSix = {1, 2, 3, 4, 5, 6.5};

TEST(ArrayFile, IsWhatAnIndependentReaderReads) {
  const TemporaryFolder folder;
  const Frames frames = some_frames(4, 5);
  write_npy_frames(folder / "a.npy", frames);
  const test::NpyArray array = test::read_npy(folder / "a.npy");
  EXPECT_THAT(array.shape, ElementsAre(4, 5, 3));
  EXPECT_EQ(Eigen::Map<const Frames>(array.values.data(), 4, 15), frames);
}

TEST(ArrayFile, ValuesStartAtAMultipleOf64Bytes) {
  const TemporaryFolder folder;
  write_npy_frames(folder / "a.npy", some_frames(4, 5));
  EXPECT_EQ((read_file(folder / "a.npy").size() - 4 * 15 * sizeof(double)) % 64, 0);
}

TEST(ArrayFile, TwoAxesAreOneFrameAlsoOfCoordinatesInOneRow) {
  const TemporaryFolder folder;
  for (const char* shape : {"(2, 3)", "(1, 6)"}) {
    write_bytes(folder / "a.npy", npy("<f8", "False", shape, raw(kSix)));
    EXPECT_EQ(read_npy_frames(folder / "a.npy"), (Frames(1, 6) << 1, 2, 3, 4, 5, 6.5).finished());
  }
}

TEST(ArrayFile, ReadsTheOtherByteOrder) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.npy", npy(">f8", "False", "(2, 3)", raw(kSix, true)));
  EXPECT_EQ(read_npy_frames(folder / "a.npy")(0, 5), 6.5);
}

TEST(ArrayFile, ReadsFortranOrder) {
  const TemporaryFolder folder;
  // a(f, n, c) = 100 f + 10 n + c, first index fastest
  std::vector<double> values;
  for (int c = 0; c < 3; ++c) {
    for (int n = 0; n < 2; ++n) {
      for (int f = 0; f < 4; ++f) values.push_back(100 * f + 10 * n + c);
    }
  }
  write_bytes(folder / "a.npy", npy("<f8", "True", "(4, 2, 3)", raw(values)));
  const Frames frames = read_npy_frames(folder / "a.npy");
  for (int f = 0; f < 4; ++f) {
    for (int n = 0; n < 2; ++n) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(frames(f, 3 * n + c), 100 * f + 10 * n + c);
    }
  }
}

TEST(ArrayFile, ReadsVersionsTwoAndThree) {
  const TemporaryFolder folder;
  for (const char version : {2, 3}) {
    write_bytes(folder / "a.npy", npy("<f8", "False", "(2, 3)", raw(kSix), version));
    EXPECT_EQ(read_npy_frames(folder / "a.npy")(0, 5), 6.5);
  }
}

TEST(ArrayFile, IntegersBecomeDoubles) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.npy", npy("<i2", "False", "(3,)", raw<std::int16_t>({1, -2, 300})));
  EXPECT_THAT(read_npy(folder / "a.npy").values, ElementsAre(1, -2, 300));
  write_bytes(folder / "a.npy", npy("|u1", "False", "(2, 1)", raw<std::uint8_t>({0, 255})));
  EXPECT_THAT(read_npy(folder / "a.npy").values, ElementsAre(0, 255));
  EXPECT_THAT(read_npy(folder / "a.npy").shape, ElementsAre(2, 1));
}

TEST(ArrayFile, EveryTruncatedPrefixIsAnError) {
  const TemporaryFolder folder;
  write_npy_frames(folder / "a.npy", some_frames(2, 3));
  const std::string bytes = read_file(folder / "a.npy");
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_bytes(folder / "cut.npy", bytes.substr(0, size));
    EXPECT_THROW(read_npy_frames(folder / "cut.npy"), IoError) << size;
  }
}

TEST(ArrayFile, OtherThanFramesIsAnErrorThatNamesThePart) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& bytes) {
    write_bytes(folder / "a.npy", bytes);
    return message_of<IoError>([&] { read_npy_frames(folder / "a.npy"); });
  };
  EXPECT_THAT(error_of(npy("<f8", "Maybe", "(2, 3)", raw(kSix))),
              HasSubstr("its fortran_order is neither True nor False"));
  EXPECT_THAT(error_of(npy("<f8", "False", "(2, -3)", raw(kSix))), HasSubstr("its shape is"));
  EXPECT_THAT(error_of(npy("<f8", "False", "(0, 3)", "")), HasSubstr("is empty: its shape is 0 x"));
  EXPECT_THAT(error_of(npy("<f8", "False", "(2, 3)", raw(kSix), 4)), HasSubstr("format version 4"));
  EXPECT_THAT(error_of(npy("<f8", "False", "(3, 2)", raw(kSix))),
              HasSubstr("has shape 3 x 2, expected frames x vertices x 3"));
  EXPECT_THAT(error_of(npy("<c8", "False", "(2, 3)", raw(kSix))),
              HasSubstr("expected float32, float64"));
  EXPECT_THAT(error_of(npy("<i8", "False", "(2, 3)", raw(kSix))), HasSubstr("holds integers"));
  EXPECT_THAT(error_of(npy("<f8", "False", "(2, 3)", raw(kSix) + "xx")),
              HasSubstr("a.npy: 2 bytes follow the values, expected the end of the file after 2 x "
                        "3"));
  EXPECT_THAT(error_of(npy("<f8', 'descr': '<f8", "False", "(2, 3)", raw(kSix))),
              HasSubstr("its header has 'descr' twice"));
  // Before memory is asked for.
  EXPECT_THAT(error_of(npy("<f8", "False", "(4000000000, 4000000000, 3)", raw(kSix))),
              HasSubstr("a.npy: is truncated: 6 values, expected 4000000000 x 4000000000 x 3"));
}

TEST(ArrayFile, ReadsFloatsInFortranOrderOfTheOtherByteOrder) {
  const TemporaryFolder folder;
  // a(n, c) = 10 n + c, first index fastest
  const std::string data = raw<float>({0, 10, 1, 11, 2, 12}, true);
  write_bytes(folder / "a.npy", npy(">f4", "True", "(2, 3)", data));
  EXPECT_EQ(read_npy_frames(folder / "a.npy"), (Frames(1, 6) << 0, 1, 2, 10, 11, 12).finished());
}

TEST(ArrayFile, FolderThatIsNotThereIsAnOutputError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_npy_frames(folder / "none/a.npy", some_frames(1, 1)), OutputError);
}

}  // namespace
}  // namespace mimetra
