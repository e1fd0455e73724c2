// What is said about series, through the table of formats.

#include <gmock/gmock.h>

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/vtp_formats.h"

namespace mimetra::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class VtpNotes : public VtpTest {
 protected:
  VtpNotes() { add_vtp(table_); }

  /// Of the quad and the triangle in as many frames as there are times.
  std::vector<std::string> notes_at(const Eigen::VectorXd& times, const std::string& file,
                                    const std::optional<std::string>& frames = {}) const {
    const MeshSequence mesh = quad_and_triangle().sequence();
    const Frames poses = mesh.positions().row(0).replicate(times.size(), 1);
    write_vtp_series(FieldSequence(MeshSequence(mesh.connectivity(), poses, times)),
                     in_folder("a.pvd"), {.overwrite = true});
    return notes_on(in_folder(file), frames);
  }

  std::vector<std::string> notes_on(const std::filesystem::path& path,
                                    const std::optional<std::string>& frames = {}) const {
    const Format& reader = table_.reader(DataKind::sequence, path);
    Parameters parameters(reader.reading);
    if (frames) parameters.set("frames", *frames);
    return reader.read(path, {.parameters = parameters}).notes;
  }

  OperationTable table_;
};

TEST_F(VtpNotes, NameTimesThatAreNumbersOfFrames) {
  const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(12, 0, 11);
  for (const char* file : {"a.pvd", "a.vtp.series"}) {
    EXPECT_THAT(notes_at(numbers, file),
                ElementsAre(HasSubstr(std::string(file) + ": its frames are 1 s apart (median)")));
  }
}

TEST_F(VtpNotes, AreNoneForSecondsAndForFramesThatWereChosen) {
  const Eigen::VectorXd numbers = Eigen::VectorXd::LinSpaced(12, 0, 11);
  EXPECT_THAT(notes_at(numbers / 30, "a.pvd"), IsEmpty());
  EXPECT_THAT(notes_at(numbers, "a.pvd", "0:11"), IsEmpty());
}

TEST_F(VtpNotes, NameARestPoseThatStayedWhereItsPointsWereBent) {
  const MeshSequence mesh = quad_and_triangle().sequence();
  vtkNew<vtkPolyData> data;
  set_polygons(*data, mesh.connectivity());
  set_positions(*data, mesh.frame(1), Precision::double_precision);
  set_rest(*data, mesh.rest());
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->SetFileName(in_folder("kept.vtp").c_str());
  writer->Write();
  EXPECT_THAT(notes_on(in_folder("kept.vtp")), IsEmpty());
  vtkNew<vtkPoints> bent;
  bent->DeepCopy(data->GetPoints());
  bent->SetPoint(2, 5, 6, 7);
  data->SetPoints(bent);
  writer->SetFileName(in_folder("bent.vtp").c_str());
  writer->Write();
  EXPECT_THAT(notes_on(in_folder("bent.vtp")),
              ElementsAre(HasSubstr("bent.vtp: filters have moved the points since their rest "
                                    "pose (mimetra_rest) was set, and not as a whole")));
}

}  // namespace
}  // namespace mimetra::test
