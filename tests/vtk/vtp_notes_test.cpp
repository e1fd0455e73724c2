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

  std::vector<std::string> notes_on(const std::filesystem::path& path) const {
    const Format& reader = table_.reader(DataKind::sequence, path);
    const Parameters parameters(reader.reading);
    return reader.read(path, {.parameters = parameters}).notes;
  }

  OperationTable table_;
};

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
