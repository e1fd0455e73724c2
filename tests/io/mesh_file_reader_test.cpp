#include "toolkit/io/mesh_file.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;

/// What reading a file came to: positions, or the kind and the text of an error.
struct Result {
  Positions positions;
  std::string error;

  bool operator==(const Result& other) const {
    return error == other.error && positions.rows() == other.positions.rows() &&
           positions == other.positions;
  }
};

std::ostream& operator<<(std::ostream& out, const Result& result) {
  return result.error.empty() ? out << result.positions : out << result.error;
}

Result result_of(const std::function<Positions()>& read) {
  try {
    return {read(), ""};
  } catch (const IoError& error) {
    return {{}, std::string("IoError ") + error.what()};
  } catch (const MismatchError& error) {
    return {{}, std::string("MismatchError ") + error.what()};
  }
}

/// A first file, and further files of any content that are read both ways.
class TwoReaders {
 public:
  TwoReaders(const std::string& extension, const std::string& first)
      : first_(folder_ / ("first" + extension)), second_(folder_ / ("second" + extension)) {
    write_bytes(first_, first);
    reader_.emplace(first_);
  }

  /// What MeshFileReader makes of `second`; a failure where read_positions makes something else.
  Result read(const std::string& second) const {
    write_bytes(second_, second);
    Result fast = result_of([&] { return reader_->read(second_); });
    const Result whole =
        result_of([&] { return read_positions(second_, reader_->mesh().connectivity, first_); });
    EXPECT_EQ(fast, whole) << "of the file\n" << second;
    return fast;
  }

 private:
  TemporaryFolder folder_;
  fs::path first_, second_;
  std::optional<MeshFileReader> reader_;
};

TriMesh textured_octahedron() {
  TriMesh mesh = test::mesh_of(test::octahedron());
  mesh.positions /= 3;
  mesh.connectivity.groups = {{0, "g upper"}, {4, "usemtl skin"}};
  mesh.connectivity.texture.coordinates = {{0, 0}, {0.5, 0.25}};
  mesh.connectivity.texture.corners.assign(mesh.connectivity.polygons.corners.size(), 1);
  return mesh;
}

std::string bytes_of(const TriMesh& mesh, const std::string& extension, bool double_precision) {
  const TemporaryFolder folder;
  write_mesh(folder / ("a" + extension), mesh, {.double_precision = double_precision});
  return read_file(folder / ("a" + extension));
}

TriMesh moved(TriMesh mesh, double by) {
  mesh.positions.array() += by;
  return mesh;
}

/// One change of the kinds that damage, edit or cut a file.
std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&random](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  static constexpr std::string_view kTelling = "0123456789 .-+eEnaif\n\r\t\\#v/x\0\x7f\xff";
  const std::size_t at = below(bytes.size());
  switch (below(5)) {
    case 0:
      bytes[at] = kTelling[below(kTelling.size())];
      break;
    case 1:
      bytes.insert(at, 1, kTelling[below(kTelling.size())]);
      break;
    case 2:
      bytes.erase(at, 1 + below(3));
      break;
    case 3:
      bytes.resize(at);
      break;
    default:
      bytes.insert(at, bytes.substr(below(bytes.size()), below(12)));
      break;
  }
  return bytes;
}

class BothReaders : public testing::TestWithParam<std::string> {};

TEST_P(BothReaders, AgreeOnFurtherFilesInEitherPrecision) {
  const TriMesh mesh = textured_octahedron();
  for (const bool double_precision : {false, true}) {
    const TwoReaders readers(GetParam(), bytes_of(mesh, GetParam(), double_precision));
    const Result found = readers.read(bytes_of(moved(mesh, 0.1), GetParam(), double_precision));
    EXPECT_EQ(found.error, "");
  }
}

TEST_P(BothReaders, AgreeOnEveryPrefix) {
  const TriMesh mesh = textured_octahedron();
  const TwoReaders readers(GetParam(), bytes_of(mesh, GetParam(), true));
  const std::string second = bytes_of(moved(mesh, 0.1), GetParam(), true);
  for (std::size_t length = 0; length < second.size(); ++length) {
    readers.read(second.substr(0, length));
  }
}

TEST_P(BothReaders, AgreeOnFilesThatAreChangedAtRandom) {
  const TriMesh mesh = textured_octahedron();
  std::mt19937 random(7);
  const TwoReaders readers(GetParam(), bytes_of(mesh, GetParam(), false));
  const std::string second = bytes_of(moved(mesh, 0.1), GetParam(), false);
  int sound = 0, refused = 0;
  for (int i = 0; i < 500; ++i) {
    ++(readers.read(mutated(second, random)).error.empty() ? sound : refused);
  }
  EXPECT_GT(sound, 0);
  EXPECT_GT(refused, 0);
}

TEST_P(BothReaders, AgreeAfterAFirstFileThatIsChangedAtRandom) {
  const TriMesh mesh = textured_octahedron();
  std::mt19937 random(8);
  const std::string first = bytes_of(mesh, GetParam(), false);
  int read = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string changed = mutated(first, random);
    try {
      const TwoReaders readers(GetParam(), changed);
      ++read;
      readers.read(changed);
      readers.read(first);
      readers.read(mutated(changed, random));
    } catch (const IoError&) {
      continue;  // a first file is refused by read_mesh
    }
  }
  EXPECT_GT(read, 0);
}

INSTANTIATE_TEST_SUITE_P(MeshFileReader, BothReaders,
                         testing::Values(".obj", ".ply", ".off", ".stl"),
                         [](const auto& instance) { return instance.param.substr(1); });

class ObjFiles : public testing::Test {
 protected:
  static constexpr const char* kFirst =
      "# first\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\n"
      "v 0 0 1\ns 1\nf -1 -2 -3\n";
  const TwoReaders readers_{".obj", kFirst};

  std::string with(const std::string& from, const std::string& to) const {
    std::string text = kFirst;
    return text.replace(text.find(from), from.size(), to);
  }
};

TEST_F(ObjFiles, MayDifferInCommentsMaterialsNormalsAndColumnsBehindThePosition) {
  for (const std::string& text :
       {with("# first", "# C:\\second\\a.obj"), with("a.mtl", "b.mtl"),
        with("vn 0 0 1", "vn 1 0 0"), with("s 1\n", "g other\n\n"),
        with("v 1 0 0", "v 1 0 0 0.5 0.5 0.5"), with("v 1 0 0", "v\t1  0 0 \r"),
        with("v 1 0 0", "v 1e-3 -0 +5")}) {
    EXPECT_EQ(readers_.read(text).error, "");
  }
}

TEST_F(ObjFiles, AreRefusedAsByTheWholeReader) {
  for (const std::string& text :
       {with("v 1 0 0", "v 1 0"), with("v 1 0 0", "v 1 0 x"), with("v 1 0 0", "v 1 0 nan"),
        with("v 1 0 0", "v 1 0 1e999"), with("v 1 0 0", "v 1 0 0\nv 1 1 1"), with("v 1 0 0\n", ""),
        with("1/1 2/1 3/1", "1/1 3/1 2/1"), with("1/1 2/1", "1/2 2/1"),
        with("f -1 -2 -3\n", "f -1 -2 -3\nf 1 2 3\n"), with("f -1 -2 -3\n", ""),
        with("f -1 -2 -3\n", "f -1 -2 -3x"),
        with("v 0 0 1\ns 1\nf -1 -2 -3", "f -1 -2 -3\nv 0 0 1"),
        with("# first", "first\\\nv 1 2 3"), with("# first", "?"), with("vt 0 0", "vt zero")}) {
    EXPECT_NE(readers_.read(text).error, "") << text;
  }
}

TEST_F(ObjFiles, MayTurnTheirFaces) {
  EXPECT_EQ(readers_.read(with("1/1 2/1 3/1", "2/1 3/1 1/1")).error, "");
}

TEST_F(ObjFiles, MayContinueLines) {
  EXPECT_EQ(readers_.read(with("v 1 0 0", "v 1 0 \\\n0")).error, "");
  EXPECT_EQ(readers_.read(with("s 1\n", "s 1 \\\nv 5 5 5\n")).error, "");
}

TEST(PlyFiles, WithFurtherPropertiesInEitherByteOrderAgree) {
  for (const std::string order : {"binary_little_endian", "binary_big_endian"}) {
    const std::string header = "ply\nformat " + order +
                               " 1.0\nelement vertex 3\nproperty uchar red\nproperty float z\n"
                               "property float x\nproperty short s\nproperty float y\n"
                               "element face 1\nproperty list uchar uchar vertex_indices\n"
                               "end_header\n";
    std::string vertices;
    for (int byte = 0; byte < 3 * 15; ++byte) vertices += static_cast<char>(32 + byte);
    const std::string face("\3\0\1\2", 4);
    const TwoReaders readers(".ply", header + vertices + face);
    vertices[20] = 'z';
    EXPECT_EQ(readers.read(header + vertices + face).error, "");
    EXPECT_NE(readers.read(header + vertices + std::string("\3\0\2\1", 4)).error, "");
    for (int byte = 0; byte < 3 * 15; ++byte) {
      std::string endless = vertices;
      endless.replace(static_cast<std::size_t>(byte) / 4 * 4, 2, "\x7f\x80");
      endless.replace(static_cast<std::size_t>(byte) / 4 * 4 + 2, 2, "\x80\x7f");
      readers.read(header + endless + face);
    }
  }
}

TEST(MeshFileReader, ReadsFilesOfOtherFormats) {
  const TemporaryFolder folder;
  const TriMesh mesh = textured_octahedron();
  write_mesh(folder / "a.obj", mesh, {.double_precision = true});
  write_mesh(folder / "b.ply", moved(mesh, 1), {.double_precision = true});
  EXPECT_EQ(MeshFileReader(folder / "a.obj").read(folder / "b.ply"), moved(mesh, 1).positions);
}

TEST(MeshFileReader, RefusesRoomForAnotherNumberOfVertices) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.obj", textured_octahedron());
  std::vector<double> room(17);
  EXPECT_THROW(MeshFileReader(folder / "a.obj").read(folder / "a.obj", room),
               std::invalid_argument);
}

TEST(MeshFileWriter, RefusesOtherFormatsAndOtherNumbersOfVertices) {
  const TriMesh mesh = textured_octahedron();
  EXPECT_THROW(MeshFileWriter(mesh.connectivity, ".npy"), std::invalid_argument);
  const Positions few = Positions::Zero(5, 3);
  EXPECT_THROW(MeshFileWriter(mesh.connectivity, ".ply").write("a", {few.data(), 5, 3}),
               std::invalid_argument);
}

/// 20 frames, more than there are threads.
MeshSequence twenty_frames() {
  const TriMesh mesh = textured_octahedron();
  Frames frames(20, mesh.positions.size());
  for (Eigen::Index f = 0; f < 20; ++f) {
    const Positions pose = moved(mesh, 0.1 * static_cast<double>(f)).positions;
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {mesh.connectivity, frames};
}

class EveryFormat : public testing::TestWithParam<std::string> {};

TEST_P(EveryFormat, IsWrittenAndReadAlikeByAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const MeshSequence sequence = twenty_frames();
  const fs::path one = folder / "1";
  write_sequence(sequence, one, {.frame_format = GetParam()}, Context().with_threads(1));
  const Frames read =
      read_sequence(one.string(), {}, Context().with_threads(1)).sequence.positions();
  for (const int threads : {2, 3}) {
    const fs::path other = folder / std::to_string(threads);
    for (const fs::path& file : write_sequence(sequence, other, {.frame_format = GetParam()},
                                               Context().with_threads(threads))) {
      EXPECT_EQ(read_file(file), read_file(one / file.filename()));
    }
    EXPECT_EQ(read_sequence(one.string(), {}, Context().with_threads(threads)).sequence.positions(),
              read);
  }
}

TEST_P(EveryFormat, NamesTheFirstBadFrameWhicheverThreadFindsIt) {
  const TemporaryFolder folder;
  write_sequence(twenty_frames(), folder / "a", {.frame_format = GetParam()});
  for (const char* frame : {"frame_0005.", "frame_0006.", "frame_0019."}) {
    write_bytes(folder / "a" / (frame + GetParam()), "?");
  }
  for (const int threads : {1, 2, 3}) {
    const std::string message = message_of<IoError>(
        [&] { read_sequence((folder / "a").string(), {}, Context().with_threads(threads)); });
    EXPECT_THAT(message, testing::HasSubstr("frame_0005." + GetParam()));
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, EveryFormat, testing::Values("obj", "ply", "off", "stl"),
                         [](const auto& instance) { return instance.param; });

/// Several pieces of what threads read and write at once.
Frames large_frames() {
  return Frames::NullaryExpr(10, 30000, [](auto f, auto i) {
    return static_cast<double>(f) + 1 / (1 + static_cast<double>(i));
  });
}

TEST(LargeArrays, AreWrittenAndReadAlikeByAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const Frames frames = large_frames();
  for (const bool single : {false, true}) {
    const Frames expected = single ? Frames(frames.cast<float>().cast<double>()) : frames;
    write_npy_frames(folder / "1.npy", frames, single, Context().with_threads(1));
    for (const int threads : {1, 2, 3}) {
      write_npy_frames(folder / "n.npy", frames, single, Context().with_threads(threads));
      EXPECT_EQ(read_file(folder / "n.npy"), read_file(folder / "1.npy"));
      EXPECT_EQ(read_npy_frames(folder / "1.npy", Context().with_threads(threads)), expected);
    }
  }
}

TEST(LargeArrays, NameTheFirstVertexWithoutAFinitePosition) {
  const TemporaryFolder folder;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), 1e200}) {
    Frames frames = large_frames();
    frames(9, 29999) = frames(3, 20002) = frames(3, 20004) = bad;
    write_npy_frames(folder / "a.npy", frames);
    for (const int threads : {1, 2, 3}) {
      EXPECT_EQ(message_of<IoError>(
                    [&] { read_npy_frames(folder / "a.npy", Context().with_threads(threads)); }),
                (folder / "a.npy").string() +
                    ": frame 3: vertex 6667 has no usable position: " + readable(bad));
    }
  }
}

TEST(LargeArrays, HoldTheLargestNumbers) {
  const TemporaryFolder folder;
  Frames frames = large_frames();
  frames(0, 0) = std::nextafter(kCoordinateLimit, 0);
  frames(0, 1) = -std::numeric_limits<double>::denorm_min();
  write_npy_frames(folder / "a.npy", frames);
  EXPECT_EQ(read_npy_frames(folder / "a.npy"), frames);
}

}  // namespace
}  // namespace mimetra
