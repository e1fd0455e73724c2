#include "toolkit/pictures/picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <Eigen/Geometry>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
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

#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/pictures/annotation.h"
#include "toolkit/pictures/offscreen_window.h"
#include "toolkit/pictures/sheet_layout.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

/// Unit normals per vertex (N x 3), by area; vertices at one place share theirs.
Positions smooth_normals(const Positions& positions, const Triangles& triangles, const Weld& weld) {
  const auto place = [&weld](int v) { return weld.representative[static_cast<std::size_t>(v)]; };
  Positions sums = Positions::Zero(positions.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector3d a = positions.row(triangles(t, 0));
    const Eigen::RowVector3d b = positions.row(triangles(t, 1));
    const Eigen::RowVector3d c = positions.row(triangles(t, 2));
    for (int i = 0; i < 3; ++i) sums.row(place(triangles(t, i))) += (b - a).cross(c - a);
  }
  Positions normals(positions.rows(), 3);
  for (int v = 0; v < normals.rows(); ++v) normals.row(v) = sums.row(place(v)).normalized();
  return normals;
}

vtkSmartPointer<vtkFloatArray> float_rows(const Positions& rows) {
  const auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(rows.rows());
  std::transform(rows.data(), rows.data() + rows.size(), array->GetPointer(0),
                 [](double x) { return static_cast<float>(x); });
  return array;
}

vtkSmartPointer<vtkUnsignedCharArray> color_array(const std::vector<Color>& colors, int vertices) {
  const auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(vertices);
  unsigned char* out = array->GetPointer(0);
  for (int v = 0; v < vertices; ++v) {
    const Color color = colors.empty() ? kClay : colors[static_cast<std::size_t>(v)];
    for (const std::uint8_t part : {color.red, color.green, color.blue}) *out++ = part;
  }
  return array;
}

/// Positions relative to `center`, so that single precision suffices wherever the mesh lies.
vtkSmartPointer<vtkPolyData> surface_of(const Tile& tile, const TileRow& row,
                                        const Eigen::RowVector3d& center, const Weld& weld) {
  const auto data = vtkSmartPointer<vtkPolyData>::New();
  const Triangles& triangles = row.connectivity->triangles;
  vtkNew<vtkPoints> points;
  points->SetData(float_rows(tile.positions.rowwise() - center));
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    cells->InsertNextCell({triangles(t, 0), triangles(t, 1), triangles(t, 2)});
  }
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetNormals(float_rows(smooth_normals(tile.positions, triangles, weld)));
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
  look.SetAmbient(0.14);
  look.SetDiffuse(0.88);
  look.SetSpecular(0.12);
  look.SetSpecularPower(18);
  return actor;
}

/// A key light that grazes from the upper left, a weak one opposite, and one from above.
void add_lights(vtkRenderer& renderer) {
  struct Source {
    double x, y, z, strength;
  };
  constexpr Source kSources[] = {
      {-1.1, 1.0, 1.0, 0.76}, {1.2, 0.1, 0.9, 0.40}, {0, 1.5, 0.2, 0.16}};
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
  add_lights(*renderer);
  aim(*renderer->GetActiveCamera(), view_of(sheet.viewpoint, tile.turn), layout.half_height,
      4 * layout.reach);
  window.AddRenderer(renderer);
}

}  // namespace

Image draw(const Sheet& sheet, const DrawOptions& options) {
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
    report_progress(options.progress,
                    0.5 * static_cast<double>(row + 1) / static_cast<double>(sheet.rows.size()));
  }
  const auto overlay = empty_renderer({0, 0, layout.width, layout.height}, layout);
  overlay->SetLayer(1);
  annotate(*overlay, sheet, layout);
  window.AddRenderer(overlay);
  Image image = offscreen.image();
  report_progress(options.progress, 1);
  return image;
}

double drawing_bytes(const Sheet& sheet) {
  // Colour and depth in each of four samples a pixel, once resolved, once read, once as PNG.
  constexpr double kBytesPerPixel = 64;
  const SheetLayout layout = SheetLayout::of(sheet);
  return kBytesPerPixel * layout.width * layout.height;
}

std::string png_of(const Image& image) {
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
