#include <cstdint>
#include <memory>

#include <gmock/gmock.h>
#include <zip.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

using Members = std::vector<std::pair<std::string, std::string>>;

/// As numpy.savez does, or numpy.savez_compressed.
void write_archive(const std::filesystem::path& path, const Members& members, bool compressed) {
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  ASSERT_NE(archive, nullptr);
  for (const auto& [name, bytes] : members) {
    zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    const auto index = static_cast<zip_uint64_t>(zip_file_add(archive, name.c_str(), source, 0));
    zip_set_file_compression(archive, index, compressed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  ASSERT_EQ(zip_close(archive), 0);
}

template <typename Number>
std::string npy(const std::string& type, const std::string& shape,
                const std::vector<Number>& values, const std::string& order = "False") {
  const std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }\n";
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  return bytes + header +
         std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
}

/// Two frames of a triangle and a further vertex; the second is 10 higher.
const std::vector<double> kPoses = {0, 0, 0,  1, 0, 0,  0, 1, 0,  1, 1, 0,
                                    0, 0, 10, 1, 0, 10, 0, 1, 10, 1, 1, 10};
const std::vector<std::int64_t> kFace = {0, 1, 2};

class NpzFiles : public testing::Test {
 protected:
  MeshSequence read(const ReadOptions& options = {}) const {
    return read_sequence((folder_ / "a.npz").string(), options).sequence;
  }
  void write(const Members& members, bool compressed = false) const {
    write_archive(folder_ / "a.npz", members, compressed);
  }
  std::string error(const Members& members) const {
    write(members);
    return message_of<IoError>([this] { read(); });
  }

  TemporaryFolder folder_;
  const std::pair<std::string, std::string> positions_{"positions.npy",
                                                       npy("<f8", "2, 4, 3", kPoses)};
  const std::pair<std::string, std::string> faces_{"faces.npy", npy("<i8", "1, 3", kFace)};
};

TEST_F(NpzFiles, AreReadStoredAndCompressed) {
  for (const bool compressed : {false, true}) {
    write({positions_, faces_}, compressed);
    const MeshSequence sequence = read();
    ASSERT_EQ(sequence.frames(), 2);
    EXPECT_EQ(sequence.positions().row(1), Eigen::Map<const Eigen::RowVectorXd>(&kPoses[12], 12));
    EXPECT_EQ(sequence.triangles(), Eigen::RowVector3i(0, 1, 2));
    EXPECT_FALSE(sequence.rest_is_known());
    EXPECT_EQ(read({.frames = "1:2"}).frame(0)(0, 2), 10);
  }
}

TEST_F(NpzFiles, MayNameTheirArraysOtherwise) {
  write({{"verts.npy", positions_.second}, {"tris.npy", faces_.second}});
  EXPECT_EQ(read().frames(), 2);
  write({{"arr_0.npy", positions_.second}, {"triangles.npy", faces_.second}});
  EXPECT_EQ(read().frames(), 2);
}

TEST_F(NpzFiles, MayHaveFortranOrder) {
  std::vector<double> values;
  for (int c = 0; c < 3; ++c) {
    for (int v = 0; v < 4; ++v) {
      for (int f = 0; f < 2; ++f)
        values.push_back(kPoses[12 * std::size_t(f) + 3 * std::size_t(v) + std::size_t(c)]);
    }
  }
  write({{"positions.npy", npy("<f8", "2, 4, 3", values, "True")}, faces_});
  EXPECT_EQ(read().positions().row(1), Eigen::Map<const Eigen::RowVectorXd>(&kPoses[12], 12));
}

TEST_F(NpzFiles, KnowTheirTimesAndTheirRestPose) {
  const std::vector<double> rest(kPoses.begin(), kPoses.begin() + 12);
  write({positions_,
         faces_,
         {"times.npy", npy<double>("<f8", "2,", {0.5, 0.75})},
         {"rest.npy", npy("<f8", "4, 3", rest)}});
  const MeshSequence sequence = read();
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0.5, 0.75));
  EXPECT_TRUE(sequence.rest_is_known());
}

TEST_F(NpzFiles, RefuseTwoMembersOfOneName) {
  write({positions_, {"qositions.npy", positions_.second}, faces_});
  std::string bytes = read_file(folder_ / "a.npz");
  for (auto at = bytes.find("qositions"); at != bytes.npos; at = bytes.find("qositions")) {
    bytes[at] = 'p';
  }
  write_bytes(folder_ / "a.npz", bytes);
  EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("holds 'positions.npy' twice"));
}

TEST_F(NpzFiles, WithoutFacesTakeThoseBesideThem) {
  write({positions_});
  EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("a.topology.ply"));
  Positions corners(4, 3);
  corners << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;
  write_mesh(folder_ / "a.topology.ply",
             {corners, Connectivity::from_polygons(4, {{0, 1, 3, 2}, {0, 4}})});
  EXPECT_EQ(read().triangles().rows(), 2);
}

TEST_F(NpzFiles, ComeBackBitByBitWithPolygonsTimesAndRest) {
  Positions corners(4, 3);
  corners << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1 / 3.0;
  const Connectivity mixed = Connectivity::from_polygons(4, {{0, 1, 3, 2, 0, 2, 1}, {0, 4, 7}});
  const MeshSequence sequence(mixed, Frames::Random(5, 12), Eigen::VectorXd::LinSpaced(5, 0.1, 0.7),
                              corners);
  EXPECT_THAT(write_sequence(sequence, folder_ / "a.npz", {.extra = {{"a.run.json", "{}"}}}),
              ElementsAre(folder_ / "a.npz", folder_ / "a.run.json"));
  EXPECT_THAT(folder_.names(), ElementsAre("a.npz", "a.run.json"));
  const MeshSequence back = read();
  EXPECT_EQ(back.positions(), sequence.positions());
  EXPECT_EQ(back.times(), sequence.times());
  EXPECT_EQ(back.rest(), corners);
  EXPECT_EQ(back.connectivity().polygons, mixed.polygons);
}

TEST_F(NpzFiles, AreTheSameBytesEveryTime) {
  const MeshSequence sequence(test::mesh_of(test::octahedron()).connectivity,
                              Frames::Constant(3, 18, 0.5));
  write_sequence(sequence, folder_ / "a.npz", {}, Context().with_threads(1));
  write_sequence(sequence, folder_ / "b.npz", {}, Context().with_threads(3));
  EXPECT_EQ(read_file(folder_ / "a.npz"), read_file(folder_ / "b.npz"));
}

TEST_F(NpzFiles, EveryPrefixIsAnError) {
  write({positions_, faces_});
  const std::string whole = read_file(folder_ / "a.npz");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_bytes(folder_ / "a.npz", whole.substr(0, size));
    EXPECT_THROW(read(), IoError) << size;
  }
}

TEST_F(NpzFiles, DamageOfACompressedOneIsFound) {
  write({positions_, faces_}, true);
  std::string bytes = read_file(folder_ / "a.npz");
  // Behind the first header, its name and the array's own header.
  bytes[30 + 13 + 60] ^= 1;
  write_bytes(folder_ / "a.npz", bytes);
  EXPECT_THAT(message_of<IoError>([this] { read(); }),
              HasSubstr("its member positions.npy cannot be read"));
}

TEST_F(NpzFiles, ClaimsOfAHugeSizeAreRefusedBeforeMemoryIsAskedFor) {
  for (const bool compressed : {false, true}) {
    write({positions_, faces_}, compressed);
    std::string bytes = read_file(folder_ / "a.npz");
    // Sizes stand 20 and 24 bytes behind the start of an entry of the central directory.
    const std::size_t entry = bytes.find("PK\1\2");
    bytes.replace(entry + 20, 4, "\xf0\xff\xff\x0f").replace(entry + 24, 4, "\xf0\xff\xff\x7f");
    write_bytes(folder_ / "a.npz", bytes);
    EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("lies about its size"));
  }
}

TEST_F(NpzFiles, ThatUnpackToFarMoreThanTheyStoreAreRefused) {
  // Packed 2e6 bytes, which are there, and unpacked 2e9, which deflate could make of them.
  write({positions_, faces_, {"noise.npy", std::string(std::size_t{1} << 21, 'x')}}, false);
  std::string bytes = read_file(folder_ / "a.npz");
  const std::size_t entry = bytes.find("PK\1\2");
  bytes
      .replace(entry + 10, 2, std::string("\x08\x00", 2))  // deflated
      .replace(entry + 20, 4, std::string("\x80\x84\x1e\x00", 4))
      .replace(entry + 24, 4, std::string("\x00\x94\x35\x77", 4));
  write_bytes(folder_ / "a.npz", bytes);
  EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("would take 2000 MB"));
}

TEST_F(NpzFiles, AreRefusedByTheBeginningOfAMemberBeforeAllOfItIsDecoded) {
  // Damage behind what the header needs is not seen where the header is wrong already.
  const std::string noise(std::size_t{1} << 22, 'x');
  const std::vector<double> zeros(std::size_t{1} << 19, 0);
  for (const std::string& content : {noise, npy("<f8", "7, 4, 3", zeros)}) {
    write({{"positions.npy", content}, faces_}, true);
    std::string bytes = read_file(folder_ / "a.npz");
    bytes[bytes.find("PK\3\4", 4) - 4] ^= 0x55;  // at the end of the first member's bytes
    write_bytes(folder_ / "a.npz", bytes);
    EXPECT_THAT(
        message_of<IoError>([this] { read(); }),
        testing::AnyOf(HasSubstr("is no NumPy array"), HasSubstr("bytes follow the values")));
  }
}

TEST_F(NpzFiles, NameWhatIsWrongInThem) {
  EXPECT_THAT(error({faces_}), HasSubstr("holds faces.npy, expected an array positions"));
  EXPECT_THAT(error({{"positions.npy", npy("<i8", "1, 3", kFace)}, faces_}),
              HasSubstr("a.npz: positions: holds integers"));
  EXPECT_THAT(error({positions_, {"faces.npy", npy("<i8", "3,", kFace)}}),
              HasSubstr("a.npz: faces: has shape 3, expected faces x corners"));
  EXPECT_THAT(error({positions_, {"faces.npy", npy<std::int64_t>("<i8", "1, 3", {0, 1, 4})}}),
              HasSubstr("a.npz: faces: face 0 uses vertex 4, expected 0 to 3"));
  EXPECT_THAT(error({positions_, {"faces.npy", npy<std::int64_t>("<i8", "1, 3", {0, 1, -1})}}),
              HasSubstr("a.npz: faces: "));
  EXPECT_THAT(error({positions_, faces_, {"times.npy", npy<double>("<f8", "2,", {1, 1})}}),
              HasSubstr("a.npz: times: frame 1 is at 1 s, expected times that rise"));
  EXPECT_THAT(error({positions_, faces_, {"times.npy", npy<double>("<f8", "3,", {1, 2, 3})}}),
              HasSubstr("a.npz: times: has shape 3, expected 2"));
  EXPECT_THAT(error({positions_, faces_, {"rest.npy", npy<double>("<f8", "1, 3", {1, 2, 3})}}),
              HasSubstr("a.npz: rest: has shape 1 x 3, expected 4 x 3"));
  EXPECT_THAT(error({positions_, {"faces.npy", ""}}), HasSubstr("a.npz: faces"));
  write_bytes(folder_ / "a.npz", "no archive");
  EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("a.npz: is no ZIP archive"));
}

TEST_F(NpzFiles, HaveTheTimesOfTheirRate) {
  for (const std::string name : {"fps", "mocap_framerate"}) {
    write({{"vertices.npy", npy("<f8", "2, 4, 3", kPoses)},
           {"faces.npy", npy("<i8", "1, 3", kFace)},
           {name + ".npy", npy<double>("<f8", "", {20})}});
    EXPECT_EQ(read().times(), Eigen::Vector2d(0, 0.05)) << name;
    EXPECT_TRUE(read().times_are_known());
  }
  write({{"vertices.npy", npy("<f8", "2, 4, 3", kPoses)},
         {"faces.npy", npy("<i8", "1, 3", kFace)},
         {"fps.npy", npy<double>("<f8", "1,", {0})}});
  EXPECT_THAT(message_of<IoError>([this] { read(); }), HasSubstr("fps: is 0, expected frames"));
}

}  // namespace
}  // namespace mimetra
