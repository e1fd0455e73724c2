#include <fstream>

#include <gmock/gmock.h>

#include "tests/io/hdf5_library.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/hdf5/components_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::Hdf5Made;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two quads and a triangle with texture coordinates, 70 frames at times of their own.
MeshSequence sequence_of_quads() {
  Polygons polygons;
  polygons.corners = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 6};
  polygons.offsets = {0, 4, 8, 11};
  auto faces = std::make_shared<Connectivity>(Connectivity::from_polygons(7, polygons));
  faces->texture.coordinates = {{0, 0}, {0.5, 0}, {1, 0.25}};
  faces->texture.corners = {0, 1, 2, -1, 1, 2, 0, 1, 2, 2, 2};
  Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(70, 0.5, 3);
  return {faces, Eigen::MatrixXd::Random(70, 21), times, Positions(Positions::Random(7, 3))};
}

class Splocs : public testing::Test {
 protected:
  MeshSequence read() const { return read_sequence(file_.string()).sequence; }
  std::string message() const {
    return test::message_of<IoError>([this] { read(); });
  }
  /// As the reference implementation's import: compressed float32, 64-bit indices.
  void make(const Hdf5Made::Sizes& sizes, const std::vector<double>& tris) const {
    const Hdf5Made made(file_);
    made.add("verts", sizes, test::counted_up(sizes), H5T_IEEE_F32LE,
             test::in_chunks({2, 3, 2}, [](hid_t set) { H5Pset_deflate(set, 4); }));
    made.add("tris", {tris.size() / 3, 3}, tris, H5T_STD_I64LE);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "take.h5";
};

TEST_F(Splocs, SequenceComesBackEqualAfterWriting) {
  const MeshSequence written = sequence_of_quads();
  write_sequence(written, file_);
  const MeshSequence found = read();
  EXPECT_EQ(*found.in_memory(), *written.in_memory());
  EXPECT_EQ(found.times(), written.times());
  EXPECT_TRUE(found.rest_is_known());
  EXPECT_EQ(found.rest(), written.rest());
  EXPECT_EQ(found.connectivity().polygons, written.connectivity().polygons);
  EXPECT_EQ(found.connectivity().texture.coordinates, written.connectivity().texture.coordinates);
  EXPECT_EQ(found.connectivity().texture.corners, written.connectivity().texture.corners);
  EXPECT_THAT(folder_.names(), ElementsAre("take.h5"));
}

TEST_F(Splocs, SequenceIsWhatTheReferenceReads) {
  const MeshSequence written = sequence_of_quads();
  write_sequence(written, file_, {.single_precision = true});
  EXPECT_THAT(test::library_shape(file_, "verts"), ElementsAre(70, 7, 3));
  const auto verts = test::library_values(file_, "verts");
  const Frames expected = written.in_memory()->cast<float>().cast<double>();
  EXPECT_TRUE(std::equal(verts.begin(), verts.end(), expected.data()));
  EXPECT_THAT(test::library_values(file_, "tris"),
              ElementsAre(0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 6));
}

TEST_F(Splocs, SequenceOfTheReferenceIsRead) {
  make({5, 4, 3}, {0, 1, 2, 0, 2, 3});
  const MeshSequence found = read();
  const auto expected = test::counted_up({5, 12});
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), found.in_memory()->data()));
  EXPECT_EQ(found.connectivity().polygons.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_FALSE(found.rest_is_known());
  EXPECT_EQ(found.frames(), 5);
}

TEST_F(Splocs, SequenceOfOtherToolsIsReadByTheirNamesAndAxes) {
  const std::vector<double> tris = {0, 1, 2, 2, 1, 3};
  const Hdf5Made::Sizes sizes = {5, 4, 3}, turned = {4, 3, 5};
  {
    const Hdf5Made made(file_);
    made.add("vertices", sizes, test::counted_up(sizes), H5T_IEEE_F32LE);
    made.add("faces", {2, 3}, tris, H5T_STD_U32LE);
  }
  const MeshSequence plain = read();
  ASSERT_EQ(plain.frames(), 5);
  EXPECT_EQ(plain.connectivity().triangles.rows(), 2);
  std::vector<double> values = test::counted_up(sizes);
  const Eigen::Map<const Frames> frames(values.data(), 5, 12);
  EXPECT_EQ(plain.positions(), frames);
  const Frames transposed = frames.transpose();
  {
    const Hdf5Made made(file_);
    made.add("verts", turned, {transposed.data(), transposed.data() + 60}, H5T_IEEE_F64LE);
    made.add("tris", {2, 3}, tris, H5T_STD_I64LE);
  }
  EXPECT_EQ(read().positions(), frames);
  EXPECT_EQ(read_sequence(file_.string(), {.frames = "3:"}).sequence.positions(),
            frames.bottomRows(2));
}

TEST_F(Splocs, SequenceIsTheSameBytesEveryTime) {
  write_sequence(sequence_of_quads(), folder_ / "a.h5", {}, Context().with_threads(1));
  { const std::vector<std::string> scribble(1000, std::string(5000, 'x')); }
  std::srand(1);
  const MeshSequence written = read_sequence((folder_ / "a.h5").string()).sequence;
  write_sequence(written, folder_ / "b.h5", {}, Context().with_threads(2));
  EXPECT_TRUE(read_file(folder_ / "a.h5") == read_file(folder_ / "b.h5"));
}

TEST_F(Splocs, SequenceTruncatedAnywhereIsAnError) {
  write_sequence(sequence_of_quads(), file_);
  const std::string bytes = read_file(file_);
  for (std::size_t cut = 1; cut <= bytes.size(); cut += 131) {
    write_bytes(file_, bytes.substr(0, bytes.size() - cut));
    EXPECT_THROW(read(), IoError) << cut;
  }
}

TEST_F(Splocs, SequenceWithPartsThatDoNotFitIsAnError) {
  make({5, 4, 2}, {0, 1, 2});
  EXPECT_THAT(message(), HasSubstr("dataset 'verts' is 5 x 4 x 2, expected frames x vertices x 3"));
  make({5, 4, 3}, {0, 1, 4});
  EXPECT_THAT(message(), HasSubstr("dataset 'tris' holds 4, expected 0 to 3"));
  make({5, 4, 3}, {0, 1, 2});
  {
    const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hsize_t sizes[1] = {4};
    const hid_t space = H5Screate_simple(1, sizes, nullptr);
    H5Dclose(
        H5Dcreate2(file, "times", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
    H5Fclose(file);
  }
  EXPECT_THAT(message(), HasSubstr("dataset 'times'"));
}

TEST_F(Splocs, ComponentsAndSequencesAreToldApart) {
  write_sequence(sequence_of_quads(), file_);
  EXPECT_THAT(test::message_of<IoError>([this] { read_components(file_); }),
              HasSubstr("holds a sequence, expected components"));
  Components components;
  const test::Shape shape = test::grid(3, 3);
  components.rest = shape.positions;
  components.triangles = shape.triangles;
  components.displacements = Eigen::MatrixXd::Random(2, 27);
  write_components(folder_ / "c.h5", components);
  EXPECT_THAT(test::message_of<IoError>([this] { read_sequence((folder_ / "c.h5").string()); }),
              HasSubstr("holds components, expected a sequence"));
  {
    const Hdf5Made made(folder_ / "o.h5");
    made.add("other", {3}, {1, 2, 3});
  }
  EXPECT_THAT(test::message_of<IoError>([this] { read_sequence((folder_ / "o.h5").string()); }),
              HasSubstr("holds other, expected the dataset 'verts'"));
}

}  // namespace
}  // namespace mimetra
