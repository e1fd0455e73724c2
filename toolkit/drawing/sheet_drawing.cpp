#include "toolkit/drawing/vtk_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include "toolkit/drawing/annotation.h"
#include "toolkit/drawing/offscreen_window.h"
#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

vtkSmartPointer<vtkFloatArray> float_rows(const Positions& rows) {
  const auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(rows.rows());
  std::transform(rows.data(), rows.data() + rows.size(), array->GetPointer(0),
                 [](double x) { return static_cast<float>(x); });
  return array;
}

/// What is drawn of a tile: its triangles, or where colours are crisp, around each corner of a
/// triangle the part nearest to it. N' >= N, a colour for each cell.
struct Cells {
  Positions positions, normals;
  std::vector<std::vector<vtkIdType>> corners;
  std::vector<Color> colors;

  vtkIdType add_point(const Eigen::RowVector3d& position, const Eigen::RowVector3d& normal) {
    added_positions.push_back(position);
    added_normals.push_back(normal.normalized());
    return positions.rows() + static_cast<vtkIdType>(added_positions.size()) - 1;
  }
  void finish() {
    const Eigen::Index given = positions.rows();
    const auto added = static_cast<Eigen::Index>(added_positions.size());
    positions.conservativeResize(given + added, 3);
    normals.conservativeResize(given + added, 3);
    for (Eigen::Index i = 0; i < added; ++i) {
      positions.row(given + i) = added_positions[static_cast<std::size_t>(i)];
      normals.row(given + i) = added_normals[static_cast<std::size_t>(i)];
    }
  }

  std::vector<Eigen::RowVector3d> added_positions, added_normals;
};

/// Splits triangles whose corners differ from their middle to their corners and to those of their
/// edges that change colour: the others stay whole, as the triangle beyond them has them.
Cells crisp_cells(const Tile& tile, const Triangles& triangles, Positions normals) {
  Cells cells{tile.positions, std::move(normals), {}, {}, {}, {}};
  const auto color = [&tile](int v) { return tile.colors[static_cast<std::size_t>(v)]; };
  const auto add = [&cells](std::vector<vtkIdType> corners, const Color& of_cell) {
    cells.corners.push_back(std::move(corners));
    cells.colors.push_back(of_cell);
  };
  for (const auto& t : triangles.rowwise()) {
    if (color(t[0]) == color(t[1]) && color(t[1]) == color(t[2])) {
      add({t[0], t[1], t[2]}, color(t[0]));
      continue;
    }
    const vtkIdType middle = cells.add_point(
        (cells.positions.row(t[0]) + cells.positions.row(t[1]) + cells.positions.row(t[2])) / 3,
        cells.normals.row(t[0]) + cells.normals.row(t[1]) + cells.normals.row(t[2]));
    for (int c = 0; c < 3; ++c) {
      const int a = t[c], b = t[(c + 1) % 3];
      if (color(a) == color(b)) {
        add({a, b, middle}, color(a));
        continue;
      }
      const vtkIdType edge = cells.add_point((cells.positions.row(a) + cells.positions.row(b)) / 2,
                                             cells.normals.row(a) + cells.normals.row(b));
      add({a, edge, middle}, color(a));
      add({edge, b, middle}, color(b));
    }
  }
  cells.finish();
  return cells;
}

vtkSmartPointer<vtkUnsignedCharArray> color_array(const std::vector<Color>& colors, int count) {
  const auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(count);
  unsigned char* out = array->GetPointer(0);
  for (int i = 0; i < count; ++i) {
    const Color color = colors.empty() ? kClay : colors[static_cast<std::size_t>(i)];
    for (const std::uint8_t part : {color.red, color.green, color.blue}) *out++ = part;
  }
  return array;
}

/// Positions relative to `center`, so that single precision suffices wherever the mesh lies.
vtkSmartPointer<vtkPolyData> surface_of(const Tile& tile, const TileRow& row,
                                        const Eigen::RowVector3d& center, const Weld& weld) {
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  const Triangles& triangles = row.connectivity->triangles;
  Positions normals = vertex_normals(tile.positions, triangles, weld).rowwise().normalized();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  if (tile.crisp) {
    const Cells parts = crisp_cells(tile, triangles, std::move(normals));
    points->SetData(float_rows(parts.positions.rowwise() - center));
    for (const auto& corners : parts.corners) {
      cells->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
    }
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetPointData()->SetNormals(float_rows(parts.normals));
    data->GetCellData()->SetScalars(
        color_array(parts.colors, static_cast<int>(parts.corners.size())));
    return data;
  }
  points->SetData(float_rows(tile.positions.rowwise() - center));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    cells->InsertNextCell({triangles(t, 0), triangles(t, 1), triangles(t, 2)});
  }
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetNormals(float_rows(normals));
  data->GetPointData()->SetScalars(
      color_array(tile.colors, static_cast<int>(tile.positions.rows())));
  return data;
}

vtkSmartPointer<vtkActor> actor_of(vtkPolyData& surface) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&surface);
  mapper->SetColorModeToDirectScalars();
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty& look = *actor->GetProperty();
  look.SetInterpolationToPhong();
  look.SetAmbient(0.2);
  look.SetDiffuse(0.84);
  look.SetSpecular(0.12);
  look.SetSpecularPower(18);
  return actor;
}

/// The outlines of the polygons, moved by `lift` towards the eye, so that the surface hides none of
/// those that are seen.
vtkSmartPointer<vtkActor> edges_of(const Tile& tile, const Polygons& polygons,
                                   const Eigen::RowVector3d& center,
                                   const Eigen::RowVector3d& lift) {
  vtkNew<vtkPoints> points;
  points->SetData(float_rows(tile.positions.rowwise() - (center - lift)));
  vtkNew<vtkCellArray> outlines;
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[static_cast<std::size_t>(face)];
    const int end = polygons.offsets[static_cast<std::size_t>(face) + 1];
    outlines->InsertNextCell(end - first + 1);
    for (int c = first; c < end; ++c) {
      outlines->InsertCellPoint(polygons.corners[static_cast<std::size_t>(c)]);
    }
    outlines->InsertCellPoint(polygons.corners[static_cast<std::size_t>(first)]);
  }
  vtkNew<vtkPolyData> lines;
  lines->SetPoints(points);
  lines->SetLines(outlines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.2, 0.22, 0.26);
  actor->GetProperty()->LightingOff();
  return actor;
}

/// A key light from the upper left, near enough to the eye that a face has no dark side, a weak one
/// opposite, and one from above, by which wrinkles show.
void add_lights(vtkRenderer& renderer) {
  struct Source {
    double x, y, z, strength;
  };
  constexpr Source kSources[] = {{-0.6, 0.7, 1.2, 0.62}, {1.3, 0.2, 0.8, 0.38}, {0, 1.5, 0.3, 0.2}};
  for (const Source& source : kSources) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(source.x, source.y, source.z);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(source.strength);
    renderer.AddLight(light);
  }
}

void aim(vtkCamera& camera, const View& view, double half_height, double distance) {
  const Eigen::Vector3d eye = distance * view.towards_eye;
  camera.ParallelProjectionOn();
  camera.SetFocalPoint(0, 0, 0);
  camera.SetPosition(eye.data());
  camera.SetViewUp(view.up.x(), view.up.y(), view.up.z());
  camera.SetParallelScale(half_height);
  camera.SetClippingRange(0.01 * distance, 2 * distance);
}

/// Draws with an empty space of the background's colour around.
vtkSmartPointer<vtkRenderer> empty_renderer(const Box& box, const SheetLayout& layout) {
  const auto renderer = vtkSmartPointer<vtkRenderer>::New();
  const double width = layout.width, height = layout.height;
  renderer->SetViewport(box.left / width, 1 - (box.top + box.height) / height,
                        (box.left + box.width) / width, 1 - box.top / height);
  renderer->SetBackground(1, 1, 1);
  renderer->AutomaticLightCreationOff();
  return renderer;
}

void add_tile(vtkRenderWindow& window, const Sheet& sheet, const SheetLayout& layout,
              std::size_t row, std::size_t column, const Weld& weld) {
  const TileRow& tiles = sheet.rows[row];
  const Tile& tile = tiles.tiles[column];
  const auto renderer = empty_renderer(layout.tile(row, column), layout);
  renderer->AddActor(actor_of(*surface_of(tile, tiles, layout.centers[row], weld)));
  const View view = view_of(sheet.viewpoint, tile.turn);
  if (sheet.edges) {
    // Far enough for a depth buffer, and nearer than a lip is thick.
    constexpr double kLift = 0.002;
    const Eigen::RowVector3d lift = kLift * layout.reach * view.towards_eye.transpose();
    renderer->AddActor(edges_of(tile, tiles.connectivity->polygons, layout.centers[row], lift));
  }
  add_lights(*renderer);
  aim(*renderer->GetActiveCamera(), view, layout.half_height, 4 * layout.reach);
  window.AddRenderer(renderer);
}

}  // namespace

Image drawn(const Sheet& sheet, const Context& context) {
  const SheetLayout layout = SheetLayout::of(sheet);
  if (layout.width > kLargestPicture || layout.height > kLargestPicture) {
    throw std::invalid_argument("a picture of " + std::to_string(layout.width) + " x " +
                                std::to_string(layout.height) + " pixels, at most " +
                                std::to_string(kLargestPicture) +
                                " can be drawn; take fewer columns or a smaller size");
  }
  const OffscreenWindow offscreen(layout.width, layout.height);
  const SilentVtk silent;
  vtkRenderWindow& window = offscreen.window();
  window.SetNumberOfLayers(2);
  window.AddRenderer(empty_renderer({0, 0, layout.width, layout.height}, layout));
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    const Weld weld = Weld::exact(sheet.rows[row].tiles.front().positions);
    for (std::size_t column = 0; column < sheet.rows[row].tiles.size(); ++column) {
      add_tile(window, sheet, layout, row, column, weld);
    }
    // What follows this loop takes as long as all of it.
    context.report(0.5 * static_cast<double>(row + 1) / static_cast<double>(sheet.rows.size()));
  }
  const auto overlay = empty_renderer({0, 0, layout.width, layout.height}, layout);
  overlay->SetLayer(1);
  annotate(*overlay, sheet, layout);
  window.AddRenderer(overlay);
  Image image = offscreen.image();
  context.report(1);
  return image;
}

std::string encoded_png(const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t row = sizeof(Color) * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {  // VTK counts rows from below
    std::memcpy(data->GetScalarPointer(0, image.height - 1 - y, 0), &image.at(0, y), row);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(data);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace mimetra
