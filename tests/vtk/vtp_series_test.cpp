#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include "tests/vtk/vtp_fixture.h"

namespace mimetra::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class VtpSeries : public VtpTest {
 protected:
  /// A file of the quad and the triangle's series, which is written once.
  static std::filesystem::path of_face(const std::string& name) {
    static const TemporaryFolder folder;
    static const auto files = write_vtp_series(quad_and_triangle(), folder / "face.pvd");
    return folder / name;
  }

  /// The frame as VTK reads it.
  vtkPolyData& read(const std::filesystem::path& path) {
    reader_->SetFileName(path.c_str());
    reader_->Update();
    return *reader_->GetOutput();
  }

 private:
  vtkNew<vtkXMLPolyDataReader> reader_;
};

std::vector<int> corners_of(vtkPolyData& data, vtkIdType cell) {
  vtkNew<vtkIdList> ids;
  data.GetPolys()->GetCellAtId(cell, ids);
  return {ids->begin(), ids->end()};
}

/// More frames than there are threads, each with positions of its own.
MeshSequence twenty_frames_of(const MeshSequence& sequence) {
  Frames frames(20, sequence.positions().cols());
  for (Eigen::Index f = 0; f < frames.rows(); ++f) {
    frames.row(f) = sequence.positions().row(0) * (1 + 0.1 * static_cast<double>(f));
  }
  return {sequence.shared_connectivity(), frames, {}, sequence.rest()};
}

TEST_F(VtpSeries, KeepsPointsToFloatPrecisionInEveryFrame) {
  const FieldSequence fields = quad_and_triangle();
  for (int f = 0; f < fields.sequence().frames(); ++f) {
    vtkPolyData& data = read(of_face("face_vtp/face_000" + std::to_string(f) + ".vtp"));
    ASSERT_EQ(data.GetNumberOfPoints(), 5);
    for (int v = 0; v < 5; ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(data.GetPoint(v)[axis], static_cast<float>(fields.sequence().frame(f)(v, axis)));
      }
    }
  }
}

TEST_F(VtpSeries, WritesTheUsersPolygonsAndNotTheirTriangles) {
  vtkPolyData& data = read(of_face("face_vtp/face_0000.vtp"));
  ASSERT_EQ(data.GetNumberOfPolys(), 2);
  EXPECT_THAT(corners_of(data, 0), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(corners_of(data, 1), ElementsAre(1, 4, 2));
}

TEST_F(VtpSeries, StoresIdsInThirtyTwoBitsAndWellFormedXml) {
  const std::string text = bytes_of(of_face("face_vtp/face_0000.vtp"));
  EXPECT_THAT(text, HasSubstr("type=\"Int32\" Name=\"connectivity\" format=\"binary\""));
  EXPECT_THAT(text, Not(HasSubstr("AppendedData")));
  EXPECT_THAT(text, HasSubstr("vtkLZ4DataCompressor"));
  EXPECT_THAT(text, Not(HasSubstr("Float64")));
}

TEST_F(VtpSeries, CompressesWithZlibOnDemand) {
  write_vtp_series(quad_and_triangle(), in_folder("face.pvd"), {.compression = Compression::small});
  EXPECT_THAT(bytes_of(in_folder("face_vtp/face_0000.vtp")), HasSubstr("vtkZLibDataCompressor"));
}

TEST_F(VtpSeries, RepeatsStaticFieldsInEveryFrame) {
  const FieldSequence fields = quad_and_triangle();
  for (const char* frame :
       {"face_vtp/face_0000.vtp", "face_vtp/face_0001.vtp", "face_vtp/face_0002.vtp"}) {
    EXPECT_EQ(read_vtp_field(of_face(frame), "direction"), fields.fields[1].values);
  }
}

TEST_F(VtpSeries, WritesDisplacementFromTheRestPose) {
  const auto frame = of_face("face_vtp/face_0001.vtp");
  // 0.1 along each axis, rounded to float once.
  EXPECT_LE((read_vtp_field(frame, "displacement").array() - 0.1).abs().maxCoeff(), 1e-8);
  EXPECT_LE(
      (read_vtp_field(frame, "displacement_length").array() - std::sqrt(0.03)).abs().maxCoeff(),
      2e-8);
  vtkDataArray* array = read(frame).GetPointData()->GetArray("displacement");
  EXPECT_STREQ(array->GetComponentName(0), "X");
  EXPECT_STREQ(array->GetComponentName(2), "Z");
}

TEST_F(VtpSeries, WritesNoDisplacementUnlessAsked) {
  FieldSequence fields = quad_and_triangle();
  fields.displacement = false;
  write_vtp_series(fields, in_folder("face.pvd"));
  EXPECT_FALSE(read(in_folder("face_vtp/face_0001.vtp")).GetPointData()->HasArray("displacement"));
}

TEST_F(VtpSeries, ListsEveryFrameWithItsTimeInFullDigits) {
  const std::string text = bytes_of(of_face("face.pvd"));
  EXPECT_THAT(text, HasSubstr("timestep=\"0\" part=\"0\" file=\"face_vtp/face_0000.vtp\""));
  EXPECT_THAT(text, HasSubstr("timestep=\"1e-07\" part=\"0\""));
  EXPECT_THAT(
      text,
      HasSubstr("timestep=\"0.3333333333333333\" part=\"0\" file=\"face_vtp/face_0002.vtp\""));
  const std::string series = bytes_of(of_face("face.vtp.series"));
  EXPECT_THAT(series, HasSubstr("\"file-series-version\": \"1.0\""));
  EXPECT_THAT(series, HasSubstr("{\"name\": \"face_vtp/face_0001.vtp\", \"time\": 1e-07}"));
}

TEST_F(VtpSeries, EscapesANameInItsIndexFiles) {
  write_vtp_series(quad_and_triangle(), in_folder("a & \"b\".pvd"));
  EXPECT_THAT(bytes_of(in_folder("a & \"b\".pvd")),
              HasSubstr("file=\"a &amp; &quot;b&quot;_vtp/a &amp; &quot;b&quot;_0000.vtp\""));
  EXPECT_THAT(bytes_of(in_folder("a & \"b\".vtp.series")),
              HasSubstr("\"a & \\\"b\\\"_vtp/a & \\\"b\\\"_0000.vtp\""));
}

TEST_F(VtpSeries, ReturnsTheFilesItWroteAndNoOthersAppear) {
  const auto written = write_vtp_series(quad_and_triangle(), in_folder("face.pvd"));
  EXPECT_THAT(
      written,
      ElementsAre(in_folder("face.pvd"), in_folder("face.vtp.series"),
                  in_folder("face_vtp/face_0000.vtp"), in_folder("face_vtp/face_0001.vtp"),
                  in_folder("face_vtp/face_0002.vtp"), in_folder("face_vtp/mimetra-run.json")));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(in_folder(""))) {
    files += entry.is_regular_file();
  }
  EXPECT_EQ(files, written.size());
}

TEST_F(VtpSeries, WritesTheFirstFrameIntoASingleVtp) {
  const FieldSequence fields = quad_and_triangle();
  const auto written = write_vtp_series(fields, in_folder("face.vtp"));
  EXPECT_THAT(written, ElementsAre(in_folder("face.vtp")));
  EXPECT_EQ(read_vtp_field(in_folder("face.vtp"), "region"), fields.fields[0].values);
}

TEST_F(VtpSeries, ReportsProgressUpToOne) {
  std::vector<double> shares;
  const auto note_share = [&](double share) {
    shares.push_back(share);
    return true;
  };
  write_vtp_series(quad_and_triangle(), in_folder("face.pvd"), {},
                   Context().with_progress(note_share));
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
}

TEST_F(VtpSeries, WritesTheSameBytesForEveryNumberOfThreads) {
  FieldSequence fields = quad_and_triangle();
  fields = FieldSequence(twenty_frames_of(fields.sequence()), fields.fields, fields.displacement);
  const auto one =
      write_vtp_series(fields, in_folder("one/face.pvd"), {}, Context().with_threads(1));
  for (const int threads : {2, 3}) {
    const auto other = write_vtp_series(fields, in_folder(std::to_string(threads) + "/face.pvd"),
                                        {}, Context().with_threads(threads));
    ASSERT_EQ(other.size(), one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(bytes_of(other[i]), bytes_of(one[i])) << other[i];
    }
  }
}

}  // namespace
}  // namespace mimetra::test
