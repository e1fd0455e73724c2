#include "toolkit/drawing/painter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include "toolkit/drawing/offscreen_window.h"
#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

enum class Align { left, center };

/// Writes into a picture with the origin in the upper left corner.
class Pen {
 public:
  Pen(vtkRenderer& renderer, const SheetLayout& layout) : renderer_(renderer), layout_(layout) {}

  /// Writes text on a baseline.
  void write(const std::string& text, int x, int baseline, Align align = Align::left) const {
    if (text.empty()) return;
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    actor->SetPosition(x, layout_.height - baseline);
    vtkTextProperty& look = *actor->GetTextProperty();
    look.SetFontSize(layout_.text);
    look.SetColor(0.1, 0.1, 0.1);
    if (align == Align::center) look.SetJustificationToCentered();
    renderer_.AddActor2D(actor);
  }

  int label_height() const { return std::max(kSmallestLabel, 3 * layout_.text / 4); }

  /// Writes text around a middle, on a light background that makes it readable on any colour.
  void label(const std::string& text, double x, double y) const {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    actor->SetPosition(x, layout_.height - y);
    vtkTextProperty& look = *actor->GetTextProperty();
    look.SetFontSize(label_height());
    look.SetColor(0.1, 0.1, 0.1);
    look.SetBackgroundColor(1, 1, 1);
    look.SetBackgroundOpacity(0.7);
    look.SetJustificationToCentered();
    look.SetVerticalJustificationToCentered();
    renderer_.AddActor2D(actor);
  }

  /// Draws equal boxes of one colour each, from bottom to top.
  void stack(const Box& box, const std::vector<Color>& colors) const {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkUnsignedCharArray> bytes;
    bytes->SetNumberOfComponents(3);
    const double bottom = layout_.height - (box.top + box.height);
    const double step = static_cast<double>(box.height) / static_cast<double>(colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const double low = bottom + step * static_cast<double>(i);
      const vtkIdType first = points->InsertNextPoint(box.left, low, 0);
      points->InsertNextPoint(box.left + box.width, low, 0);
      points->InsertNextPoint(box.left + box.width, low + step, 0);
      points->InsertNextPoint(box.left, low + step, 0);
      cells->InsertNextCell({first, first + 1, first + 2, first + 3});
      const unsigned char rgb[] = {colors[i].red, colors[i].green, colors[i].blue};
      bytes->InsertNextTypedTuple(rgb);
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetCellData()->SetScalars(bytes);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    renderer_.AddActor2D(actor);
  }

 private:
  static constexpr int kSmallestLabel = 10;

  vtkRenderer& renderer_;
  const SheetLayout& layout_;
};

std::string with_unit(double value, const std::string& unit) {
  return readable(value, 2) + (unit.empty() ? "" : " " + unit);
}

/// Cuts `text` to the width of `pixels`.
std::string fitted(const std::string& text, int pixels, int letter_height) {
  constexpr double kLetterWidth = 0.52;  // of its height, on average
  const auto letters =
      static_cast<std::size_t>(std::max(1.0, pixels / (kLetterWidth * letter_height)));
  return text.size() <= letters ? text : text.substr(0, letters - 1) + "...";
}

void write_bar(const Pen& pen, const ColorBar& bar, const Box& row_end, int text) {
  constexpr int kSteps = 64;
  std::vector<Color> colors;
  colors.reserve(kSteps);
  for (int i = 0; i < kSteps; ++i) colors.push_back(even_color((i + 0.5) / kSteps));
  const Box box{row_end.left + text, row_end.top + row_end.height / 8, text,
                3 * row_end.height / 4};
  pen.stack(box, colors);
  pen.write(bar.name, box.left, box.top - text / 2);
  const int x = box.left + box.width + text / 2;
  pen.write(with_unit(bar.maximum, bar.unit), x, box.top + text);
  pen.write(readable(bar.minimum, 2), x, box.top + box.height);
}

/// Draws a box in each number's colour beside a row, in columns.
void write_legend(const Pen& pen, const Legend& legend, const Box& row_end,
                  const SheetLayout& layout) {
  const int text = layout.text, lines = layout.legend_lines();
  pen.write(legend.name, row_end.left + text, row_end.top + text);
  for (std::size_t i = 0; i < legend.entries.size(); ++i) {
    const int column = static_cast<int>(i) / lines, line = static_cast<int>(i) % lines;
    const Box box{
        row_end.left + text + static_cast<int>(SheetLayout::kLegendColumn * text * column),
        row_end.top + static_cast<int>(text * (1.7 + SheetLayout::kLegendLine * line)), text, text};
    pen.stack(box, {legend.entries[i].color});
    pen.write(std::to_string(legend.entries[i].number), box.left + box.width + text / 4,
              box.top + 9 * text / 10);
  }
}

void write_labels(const Pen& pen, const Tile& tile, const Box& box, const View& view,
                  const Eigen::RowVector3d& center, double pixels_per_unit) {
  std::vector<Eigen::Vector2d> written;
  for (const TileLabel& label : tile.labels) {
    const Eigen::Vector3d way = (label.position - center).transpose();
    const Eigen::Vector2d place(box.left + box.width / 2.0 + pixels_per_unit * way.dot(view.right),
                                box.top + box.height / 2.0 - pixels_per_unit * way.dot(view.up));
    // If labels would overlap, only the first is written.
    const bool is_free = std::ranges::none_of(written, [&](const Eigen::Vector2d& other) {
      return (place - other).norm() < pen.label_height() * 1.4;
    });
    if (!is_free) continue;
    written.push_back(place);
    pen.label(label.text, place.x(), place.y());
  }
}

/// Draws the scale bar below the last row, at most a third of a tile wide.
void write_scale_bar(const Pen& pen, const Sheet& sheet, const SheetLayout& layout) {
  const double length = round_length(layout.tile_width / 3.0 / layout.pixels_per_unit());
  const int pixels = static_cast<int>(std::lround(length * layout.pixels_per_unit()));
  const int baseline = layout.height - layout.text / 2;
  const Box box{layout.margin, baseline - layout.text / 2, pixels, std::max(2, layout.text / 5)};
  pen.stack(box, {{26, 26, 26}});
  pen.write(with_unit(length, sheet.unit), box.left + pixels + layout.text / 2, baseline);
}

/// Adds the writing of a sheet to a renderer over the whole picture: titles, labels, colour bars,
/// legends and the scale bar.
void annotate(vtkRenderer& renderer, const Sheet& sheet, const SheetLayout& layout) {
  const Pen pen(renderer, layout);
  for (std::size_t column = 0; column < sheet.column_titles.size(); ++column) {
    const Box tile = layout.tile(0, column);
    pen.write(sheet.column_titles[column], tile.left + tile.width / 2, layout.margin + layout.text,
              Align::center);
  }
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    const Box first = layout.tile(row, 0);
    pen.write(fitted(sheet.rows[row].title, layout.width - 2 * layout.margin, layout.text),
              first.left, first.top - layout.tile_title - layout.text / 2);
    for (std::size_t column = 0; column < sheet.rows[row].tiles.size(); ++column) {
      const Box tile = layout.tile(row, column);
      pen.write(fitted(sheet.rows[row].tiles[column].title, tile.width, layout.text), tile.left,
                tile.top - layout.text / 2);
      write_labels(pen, sheet.rows[row].tiles[column], tile,
                   view_of(sheet.viewpoint, sheet.rows[row].tiles[column].turn),
                   layout.centers[row], layout.pixels_per_unit());
    }
    const Box end = layout.tile(row, sheet.rows[row].tiles.size());
    if (sheet.rows[row].bar) write_bar(pen, *sheet.rows[row].bar, end, layout.text);
    if (!sheet.rows[row].legend.entries.empty()) {
      write_legend(pen, sheet.rows[row].legend, end, layout);
    }
  }
  write_scale_bar(pen, sheet, layout);
}

vtkSmartPointer<vtkFloatArray> float_rows(const Positions& rows) {
  const auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(rows.rows());
  std::transform(rows.data(), rows.data() + rows.size(), array->GetPointer(0),
                 [](double x) { return static_cast<float>(x); });
  return array;
}

/// Cells that are drawn for a crisp tile: around each corner of a triangle the part nearest to it.
/// N' >= N points, and a colour for each cell.
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

/// Splits triangles with several colours from their middle to their corners, and to the middles of
/// edges that change colour. Other edges stay whole, as in the neighbouring triangle.
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

/// Uses positions relative to `center`, so that single precision suffices for any location of the
/// mesh.
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

/// Outlines of the polygons, moved by `lift` towards the eye, so that the surface does not hide
/// visible ones.
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

/// Adds a key light from the upper left, close enough to the eye that a face has no dark side. A
/// weak light opposite fills in, and one from above shows wrinkles.
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

/// Renderer for a box of the picture, on a white background and without lights.
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
    // Far enough for a depth buffer, but less than the thickness of a lip.
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
    // Rendering after this loop takes about as long as the loop.
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
