// Files as VTK's own writers make them, in every way that they store arrays.

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vtkBitArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/vtk_file.h"

namespace mimetra::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Enough points that arrays take several blocks of a compressor.
constexpr int kColumns = 60, kRows = 50;

template <typename Array>
vtkSmartPointer<Array> numbers(const char* name, vtkIdType tuples, int components, double step) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) {
    array->SetValue(i, static_cast<typename Array::ValueType>(step * static_cast<double>(i % 211)));
  }
  return array;
}

/// A bent grid of quads, two triangles, a line and a vertex, with fields of many types.
template <typename DataSet>
void add_points_and_fields(DataSet& data, vtkIdType cells) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      points->InsertNextPoint(column, row, 0.01 * row * column + 1.0 / 3);
    }
  }
  data.SetPoints(points);
  const vtkIdType count = points->GetNumberOfPoints();
  data.GetPointData()->AddArray(numbers<vtkDoubleArray>("heat, cold", count, 2, 1.0 / 7));
  data.GetPointData()->AddArray(numbers<vtkUnsignedCharArray>("byte", count, 3, 1));
  const auto ids = numbers<vtkIdTypeArray>("ids", count, 1, 3);
  data.GetPointData()->SetGlobalIds(ids);
  data.GetCellData()->AddArray(numbers<vtkIntArray>("label", cells, 1, -2));
}

constexpr vtkIdType kQuads = (kColumns - 1) * (kRows - 1);

std::array<vtkIdType, 4> quad(vtkIdType cell) {
  const vtkIdType first = cell / (kColumns - 1) * kColumns + cell % (kColumns - 1);
  return {first, first + 1, first + kColumns + 1, first + kColumns};
}

vtkSmartPointer<vtkPolyData> surface() {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const vtkNew<vtkCellArray> verts, lines, polys;
  const std::array<vtkIdType, 3> line = {1, 2, 3};
  verts->InsertNextCell(1, line.data());
  lines->InsertNextCell(3, line.data());
  for (vtkIdType cell = 0; cell < kQuads; ++cell) {
    const auto corners = quad(cell);
    polys->InsertNextCell(cell % 5 == 0 ? 3 : 4, corners.data());
  }
  data->SetVerts(verts);
  data->SetLines(lines);
  data->SetPolys(polys);
  add_points_and_fields(*data, kQuads + 2);
  return data;
}

/// The same polygons; the vertex and the line come between them.
vtkSmartPointer<vtkUnstructuredGrid> grid() {
  auto data = vtkSmartPointer<vtkUnstructuredGrid>::New();
  for (vtkIdType cell = 0; cell < kQuads; ++cell) {
    const auto corners = quad(cell);
    if (cell == 20) data->InsertNextCell(VTK_VERTEX, 1, corners.data());
    if (cell == 30) data->InsertNextCell(VTK_LINE, 2, corners.data());
    data->InsertNextCell(cell % 5 == 0 ? VTK_TRIANGLE : VTK_QUAD, cell % 5 == 0 ? 3 : 4,
                         corners.data());
  }
  add_points_and_fields(*data, kQuads + 2);
  return data;
}

/// Label of each polygon of the grid: its number among the cells, times -2 as numbers() has it.
double label_in_grid(vtkIdType polygon) {
  const vtkIdType cell = polygon + (polygon >= 20) + (polygon >= 30);
  return -2.0 * static_cast<double>(cell % 211);
}
double label_in_surface(vtkIdType polygon) {
  return -2.0 * static_cast<double>((polygon + 2) % 211);
}

/// Checks what is read against the data that VTK has written.
void expect_read(const std::filesystem::path& path, double (*label)(vtkIdType polygon),
                 const std::string& how) {
  const VtkFile file(path);
  const auto data = file.poly_data();
  const auto expected = surface();
  const std::string name = path.string();
  EXPECT_EQ(positions_of(*data, name), positions_of(*expected, name)) << how;
  EXPECT_EQ(positions_of(*file.points(), name), positions_of(*expected, name)) << how;
  const Connectivity faces = connectivity_of(*data, name);
  EXPECT_TRUE(same_faces(faces, connectivity_of(*expected, name))) << how;
  for (const char* field : {"heat, cold", "byte", "ids"}) {
    ASSERT_TRUE(point_values(*data, field)) << how << field;
    EXPECT_EQ(*point_values(*data, field), *point_values(*expected, field)) << how << field;
  }
  const std::vector<Field> fields = fields_of(*data, faces);
  ASSERT_EQ(fields.size(), 4u) << how;
  for (Eigen::Index t = 0; t < fields[3].values.rows(); ++t) {
    ASSERT_EQ(fields[3].values(t, 0), label(faces.polygon_of_triangle[t])) << how << t;
  }
}

class VtkFiles : public VtpTest {
 protected:
  std::string refusal(const std::string& name, const std::string& text) const {
    std::ofstream(in_folder(name), std::ios::binary) << text;
    return message_of<IoError>([&] { VtkFile(in_folder(name)).poly_data(); });
  }
};

template <typename Writer>
void write_xml(Writer& writer, vtkDataObject& data, const std::filesystem::path& path) {
  writer.SetInputDataObject(&data);
  writer.SetFileName(path.c_str());
  ASSERT_EQ(writer.Write(), 1);
}

TEST_F(VtkFiles, InXmlAreReadInEveryDataModeCompressionAndByteOrder) {
  const auto polygons = surface();
  const auto cells = grid();
  const std::vector<std::pair<std::string, std::function<void(vtkXMLWriter&)>>> modes = {
      {"ascii", [](vtkXMLWriter& writer) { writer.SetDataModeToAscii(); }},
      {"binary", [](vtkXMLWriter& writer) { writer.SetDataModeToBinary(); }},
      {"raw", [](vtkXMLWriter& writer) { writer.EncodeAppendedDataOff(); }},
      {"appended", [](vtkXMLWriter& writer) { writer.EncodeAppendedDataOn(); }}};
  const auto write = [](vtkXMLWriter& writer, vtkDataObject& data, int compressor, int order,
                        int header, const auto& set_mode, const std::filesystem::path& path) {
    writer.SetCompressorType(compressor);
    writer.SetByteOrder(order);
    writer.SetHeaderType(header);
    set_mode(writer);
    write_xml(writer, data, path);
  };
  for (const auto& [mode, set_mode] : modes) {
    for (const int compressor :
         {vtkXMLWriter::NONE, vtkXMLWriter::ZLIB, vtkXMLWriter::LZ4, vtkXMLWriter::LZMA}) {
      for (const int order : {vtkXMLWriter::LittleEndian, vtkXMLWriter::BigEndian}) {
        const int header =
            order == vtkXMLWriter::BigEndian ? vtkXMLWriter::UInt64 : vtkXMLWriter::UInt32;
        const std::string how = mode + ' ' + std::to_string(compressor) + std::to_string(order);
        vtkNew<vtkXMLPolyDataWriter> of_polygons;
        write(*of_polygons, *polygons, compressor, order, header, set_mode, in_folder("a.vtp"));
        expect_read(in_folder("a.vtp"), label_in_surface, how);
        if (order == vtkXMLWriter::BigEndian) continue;
        vtkNew<vtkXMLUnstructuredGridWriter> of_cells;
        write(*of_cells, *cells, compressor, order, header, set_mode, in_folder("a.vtu"));
        expect_read(in_folder("a.vtu"), label_in_grid, how);
      }
    }
  }
}

TEST_F(VtkFiles, InPiecesAreJoined) {
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetNumberOfPieces(1);
  const auto data = surface();
  write_xml(*writer, *data, in_folder("one.vtp"));
  // The same piece twice.
  std::string text = bytes_of(in_folder("one.vtp"));
  const std::size_t first = text.find("<Piece"), end = text.find("</Piece>") + 8;
  text.insert(end, text.substr(first, end - first));
  std::ofstream(in_folder("two.vtp"), std::ios::binary) << text;
  const auto read = VtkFile(in_folder("two.vtp")).poly_data();
  EXPECT_EQ(read->GetNumberOfPoints(), 2 * data->GetNumberOfPoints());
  EXPECT_EQ(read->GetNumberOfPolys(), 2 * data->GetNumberOfPolys());
  EXPECT_EQ(read->GetPoint(kColumns * kRows + 5)[0], 5);
}

TEST_F(VtkFiles, InFormerFormatsAreReadInTextAndBinary) {
  const auto polygons = surface();
  const auto cells = grid();
  for (const int version : {vtkDataWriter::VTK_LEGACY_READER_VERSION_4_2,
                            vtkDataWriter::VTK_LEGACY_READER_VERSION_5_1}) {
    for (const int type : {VTK_ASCII, VTK_BINARY}) {
      const std::string how = std::to_string(version) + ' ' + std::to_string(type);
      vtkNew<vtkPolyDataWriter> of_polygons;
      of_polygons->SetInputData(polygons);
      of_polygons->SetFileVersion(version);
      of_polygons->SetFileType(type);
      of_polygons->SetFileName(in_folder("a.vtk").c_str());
      ASSERT_EQ(of_polygons->Write(), 1);
      vtkNew<vtkUnstructuredGridWriter> of_cells;
      of_cells->SetInputData(cells);
      of_cells->SetFileVersion(version);
      of_cells->SetFileType(type);
      of_cells->SetFileName(in_folder("b.vtk").c_str());
      ASSERT_EQ(of_cells->Write(), 1);
      // Text has six significant digits.
      if (type == VTK_ASCII) {
        const auto read = VtkFile(in_folder("a.vtk")).poly_data();
        EXPECT_TRUE(positions_of(*read, "").isApprox(positions_of(*polygons, ""), 1e-5)) << how;
        EXPECT_EQ(*point_values(*read, "ids"), *point_values(*polygons, "ids")) << how;
        EXPECT_TRUE(same_faces(connectivity_of(*read, ""), connectivity_of(*polygons, "")));
      } else {
        expect_read(in_folder("a.vtk"), label_in_surface, how);
        expect_read(in_folder("b.vtk"), label_in_grid, how);
      }
    }
  }
}

TEST_F(VtkFiles, WithAttributesOfEveryKindAreRead) {
  std::ofstream(in_folder("a.vtk"))
      << "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\n"
         "FIELD FieldData 1\ntime 1 1 double\n0.5\n"
         "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n"
         "POINT_DATA 3\nSCALARS a%20b float\nLOOKUP_TABLE own\n1 2 3\n"
         "LOOKUP_TABLE own 2\n0 0 0 1 1 1 1 1\n"
         "VECTORS v double\n1 2 3 4 5 6 7 8 9\nMETADATA\nINFORMATION 0\n\n"
         "TEXTURE_COORDINATES uv 2 float\n0 0 1 0 0 1\nCOLOR_SCALARS c 1\n0.5 0.5 1\n"
         "CELL_DATA 1\nFIELD more 2\nx 2 1 int\n4 5\ny 1 1 short\n6\n";
  const auto data = VtkFile(in_folder("a.vtk")).poly_data();
  EXPECT_EQ(*point_values(*data, "a b"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(point_values(*data, "v")->row(2), Eigen::RowVector3d(7, 8, 9));
  EXPECT_EQ(point_values(*data, "uv")->row(1), Eigen::RowVector2d(1, 0));
  EXPECT_EQ(*point_values(*data, "c"), Eigen::Vector3d(0.5, 0.5, 1));
  EXPECT_EQ(data->GetCellData()->GetArray("x")->GetComponent(0, 1), 5);
  EXPECT_EQ(data->GetCellData()->GetArray("y")->GetComponent(0, 0), 6);
}

TEST_F(VtkFiles, ThatAreNoSurfaceAreRefused) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\n";
  EXPECT_THAT(refusal("a.vtk", head + "DATASET STRUCTURED_POINTS\n"),
              HasSubstr("expected DATASET POLYDATA or UNSTRUCTURED_GRID"));
  EXPECT_THAT(refusal("a.vtk", head), HasSubstr("expected DATASET"));
  EXPECT_THAT(refusal("a.vtk", head + "DATASET POLYDATA\n"), HasSubstr("has no points"));
  EXPECT_THAT(refusal("a.vtk", head + "DATASET POLYDATA\nPOINTS 4 float\n0 0 0\n"),
              HasSubstr("array 'Points' is truncated"));
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
  EXPECT_THAT(refusal("a.vtk", head + "DATASET POLYDATA\n" + points + "POLYGONS 1 3\n3 0 1\n"),
              HasSubstr("cell 0 has more corners than the file"));
  EXPECT_THAT(refusal("a.vtk", head + "DATASET POLYDATA\n" + points + "POLYGONS 1 4\n3 0 1 4\n"),
              HasSubstr("corner 4 is none of the 4 points"));
  EXPECT_THAT(refusal("a.vtk", head + "DATASET UNSTRUCTURED_GRID\n" + points +
                                   "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"),
              AllOf(HasSubstr("type 10"), HasSubstr("Extract Surface")));
}

TEST_F(VtkFiles, ThatAreDamagedGiveAnErrorOrAMesh) {
  vtkNew<vtkXMLPolyDataWriter> xml;
  xml->SetCompressorTypeToLZ4();
  const auto data = surface();
  write_xml(*xml, *data, in_folder("a.vtp"));
  vtkNew<vtkPolyDataWriter> legacy;
  legacy->SetInputData(data);
  legacy->SetFileType(VTK_BINARY);
  legacy->SetFileName(in_folder("a.vtk").c_str());
  legacy->Write();
  std::uint32_t state = 1;
  for (const char* name : {"a.vtp", "a.vtk"}) {
    const std::string whole = bytes_of(in_folder(name));
    int read = 0;
    for (int attempt = 0; attempt < 300; ++attempt) {
      std::string text = whole;
      for (int change = 0; change < 3; ++change) {
        state = state * 1664525 + 1013904223;
        // Most of the head is in the first 4096 bytes.
        const std::size_t range =
            change == 0 ? text.size() : std::min<std::size_t>(4096, text.size());
        text[(state >> 8) % range] = static_cast<char>(state >> 3);
      }
      std::ofstream(in_folder("damaged"), std::ios::binary) << text;
      try {
        const auto found = VtkFile(in_folder("damaged")).poly_data();
        connectivity_of(*found, "damaged");
        ++read;
      } catch (const IoError&) {
      }
    }
    EXPECT_LT(read, 300) << name;
  }
}

}  // namespace
}  // namespace mimetra::test
