// What is said about series, through the table of formats.

#include <gmock/gmock.h>

#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/vtk_formats.h"

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
    return table_.reader(DataKind::sequence, path).read(path, {.frames = frames}, {}).notes;
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
  const auto has_its_note = ElementsAre(HasSubstr(
      "filters have moved the points since their rest pose (mimetra_rest) was set, and not as a "
      "whole"));
  EXPECT_THAT(notes_on(in_folder("bent.vtp")), has_its_note);
  // In the first frame there is often nothing to bend.
  std::ofstream(in_folder("later.vtp.series"))
      << R"({"file-series-version": "1.0", "files": [{"name": "kept.vtp", "time": 0},
            {"name": "bent.vtp", "time": 0.1}, {"name": "bent.vtp", "time": 0.2}]})";
  EXPECT_THAT(notes_on(in_folder("later.vtp.series")), has_its_note);
}

TEST_F(VtpNotes, NameFieldsInWhosePlaceDisplacementsAreWritten) {
  const std::filesystem::path target = in_folder("face.pvd");
  const Format& format = table_.writer(Output{"out", DataKind::sequence, ""}, target);
  FieldSequence given = quad_and_triangle();
  given.displacement = false;
  EXPECT_THAT(notes_on_losses(format, given, target, {}), IsEmpty());
  const Eigen::MatrixXd velocity = Eigen::MatrixXd::Constant(5, 3, 0.25);
  given.fields.push_back({kDisplacement, Field::Location::vertices, velocity});
  EXPECT_THAT(notes_on_losses(format, given, target, {}),
              ElementsAre(HasSubstr("face.pvd: the input's field 'displacement' is replaced by the "
                                    "displacement from the rest pose")));
  format.write(given, target, {}, {});
  const FieldSequence read = read_vtp_series(target);
  EXPECT_TRUE(read.sequence().rest_is_known());
  EXPECT_EQ(read.fields.size(), given.fields.size() - 1);

  const MeshSequence& moved = given.sequence();
  const MeshSequence without_rest(moved.connectivity(), moved.positions(), moved.times());
  given = FieldSequence(without_rest, given.fields);
  EXPECT_THAT(notes_on_losses(format, given, target, {}), IsEmpty());
}

}  // namespace
}  // namespace mimetra::test
