
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using ::testing::HasSubstr;

class VtpRead : public VtpTest {
 protected:
  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream(in_folder(name)) << text;
  }
};

/// Written in single precision.
constexpr double kRounding = 1e-6;

TEST_F(VtpRead, GivesBackWhatWasWritten) {
  const FieldSequence written = quad_and_triangle();
  write_vtp_series(written, in_folder("face.pvd"));
  for (const char* name : {"face.pvd", "face.vtp.series"}) {
    const FieldSequence read = read_vtp_series(in_folder(name));
    EXPECT_TRUE(same_faces(read.sequence().connectivity(), written.sequence().connectivity()));
    EXPECT_TRUE(read.sequence().positions().isApprox(written.sequence().positions(), kRounding));
    EXPECT_TRUE(read.sequence().times() == written.sequence().times());
    ASSERT_TRUE(read.sequence().rest_is_known());
    EXPECT_TRUE(read.sequence().rest().isApprox(written.sequence().rest(), kRounding));
    ASSERT_EQ(read.fields.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(read.fields[i].name, written.fields[i].name);
      EXPECT_EQ(read.fields[i].integer, written.fields[i].integer);
    }
    EXPECT_TRUE(read.fields[0].values == written.fields[0].values);
    // A polygon's value is the largest of its triangles', on all of them.
    EXPECT_TRUE(read.fields[2].values == Eigen::Vector3d(1, 1, 0));
  }
}

TEST_F(VtpRead, KnowsExtensionsInCapitals) {
  write_vtp_series(quad_and_triangle(), in_folder("face.PVD"));
  EXPECT_EQ(read_vtp_series(in_folder("face.PVD")).sequence().frames(), 3);
  EXPECT_EQ(vtp_series_files(in_folder("face.PVD")).size(), 4u);
}

TEST_F(VtpRead, TakesThePartThatIsAskedFor) {
  const FieldSequence written = quad_and_triangle();
  write_vtp_series(written, in_folder("face.pvd"));
  const MeshSequence read = read_vtp_series(in_folder("face.pvd"), {.frames = "2:"}).sequence();
  ASSERT_EQ(read.frames(), 1);
  EXPECT_TRUE(read.frame(0).isApprox(written.sequence().frame(2), kRounding));
  EXPECT_EQ(read.times()[0], written.sequence().times()[2]);
}

/// ParaView saves series without an index, too.
TEST_F(VtpRead, TakesNumberedFilesOfAFolderOrPattern) {
  const FieldSequence written = quad_and_triangle();
  write_vtp_series(written, in_folder("face.pvd"));
  const std::string folder = in_folder("face_vtp").string();
  for (const std::string& name :
       {folder, folder + "/face_%04d.vtp", folder + "/*.vtp", folder + "/face_*"}) {
    const MeshSequence read = read_vtp_series(name, {.frames = "1:", .fps = 10}).sequence();
    ASSERT_EQ(read.frames(), 2) << name;
    EXPECT_TRUE(read.frame(1).isApprox(written.sequence().frame(2), kRounding));
    EXPECT_DOUBLE_EQ(read.times()[1] - read.times()[0], 0.1);
    EXPECT_EQ(vtp_series_files(name).size(), 3u);
  }
  EXPECT_FALSE(read_vtp_series(folder).sequence().times_are_known());
  std::ofstream(in_folder("face_vtp.times.csv")) << "time\n1\n2\n4\n";
  EXPECT_EQ(read_vtp_series(folder).sequence().times(), Eigen::Vector3d(1, 2, 4));
  EXPECT_THAT(message_of<std::invalid_argument>([&] { read_vtp_series(folder, {.fps = 10}); }),
              HasSubstr("have times of their own"));
  std::filesystem::copy_file(folder + "/face_0000.vtp", folder + "/face_0003.vtu");
  EXPECT_THAT(message_of<IoError>([&] { read_vtp_series(folder); }),
              HasSubstr("files of several formats"));
}

TEST_F(VtpRead, NamesTheFileThatIsWrong) {
  write_text("no.pvd", "nothing");
  write_text("none.pvd", "<VTKFile type=\"Collection\"><Collection/></VTKFile>");
  write_text(
      "lost.pvd",
      "<VTKFile><Collection><DataSet timestep=\"0\" file=\"x.vtp\"/></Collection></VTKFile>");
  write_text("bad.series", "{}");
  write_text("bad.json", "{}");
  const auto message = [this](const std::string& name) {
    return message_of<IoError>([&] { read_vtp_series(in_folder(name)); });
  };
  EXPECT_THAT(message("no.pvd"), HasSubstr("no.pvd: line 1: expected XML"));
  EXPECT_THAT(message("none.pvd"), HasSubstr("none.pvd: names no frame"));
  EXPECT_THAT(message("lost.pvd"), HasSubstr("x.vtp: no such file"));
  EXPECT_THAT(message("bad.series"), HasSubstr("bad.series: expected JSON"));
  EXPECT_THAT(message("bad.json"), HasSubstr("bad.json: expected a series in .pvd"));
}

TEST_F(VtpRead, ReadsAFrameWhenItIsNeeded) {
  write_vtp_series(quad_and_triangle(), in_folder("face.pvd"));
  const FieldSequence read = read_vtp_series(in_folder("face.pvd"));
  const FieldSequence open = open_vtp_series(in_folder("face.pvd"));
  const FrameSource& frames = *open.frames;
  EXPECT_FALSE(open.is_in_memory());
  EXPECT_EQ(frames.times(), read.sequence().times());
  EXPECT_EQ(frames.rest(), read.sequence().rest());
  EXPECT_EQ(frames.read(0, 3), read.sequence().positions());
  EXPECT_EQ(frames.read(1, 1), read.sequence().positions().row(1));
  EXPECT_EQ(open.fields.size(), read.fields.size());
  write_text("face_vtp/face_0001.vtp", "<VTKFile");
  EXPECT_EQ(frames.read(2, 1), read.sequence().positions().row(2));
  EXPECT_THAT(message_of<IoError>([&] { frames.read(1, 1); }), HasSubstr("face_0001.vtp"));
  std::filesystem::remove(in_folder("face_vtp/face_0002.vtp"));
  EXPECT_THAT(message_of<IoError>([&] { open_vtp_series(in_folder("face.pvd")); }),
              HasSubstr("face_0002.vtp: no such file"));
}

TEST_F(VtpRead, RefusesAFrameWithOtherFaces) {
  write_vtp_series(quad_and_triangle(), in_folder("face.pvd"));
  FieldSequence other = quad_and_triangle();
  Frames frame = other.sequence().positions().topRows(1);
  other = FieldSequence(MeshSequence(Connectivity::from_polygons(5, {{0, 1, 2}, {0, 3}}), frame));
  other.fields.clear();
  write_vtp_series(other, in_folder("face_vtp/face_0001.vtp"), {.overwrite = true});
  const auto message =
      message_of<MismatchError>([this] { read_vtp_series(in_folder("face.pvd")); });
  EXPECT_THAT(message, HasSubstr("face_0001.vtp: other vertices or faces"));
}

}  // namespace
}  // namespace mimetra::test
