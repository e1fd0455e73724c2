#include "toolkit/drawing/annotation.h"

#include <algorithm>
#include <cmath>

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

enum class Align { left, center };

/// Writes into a picture that counts from the upper left corner.
class Pen {
 public:
  Pen(vtkRenderer& renderer, const SheetLayout& layout) : renderer_(renderer), layout_(layout) {}

  /// `baseline` is where the letters stand.
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

  /// Letters about a middle, light behind, that are to be read on any colour.
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

  /// Equal boxes of one colour each, from below to above.
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

/// `text` without what does not fit into `pixels`.
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

/// Beside a row: a box of each number's colour, in columns.
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
    // The first of those that would lie on each other is written.
    const bool is_free = std::ranges::none_of(written, [&](const Eigen::Vector2d& other) {
      return (place - other).norm() < pen.label_height() * 1.4;
    });
    if (!is_free) continue;
    written.push_back(place);
    pen.label(label.text, place.x(), place.y());
  }
}

/// A third of a tile at most, below the last row.
void write_scale_bar(const Pen& pen, const Sheet& sheet, const SheetLayout& layout) {
  const double length = round_length(layout.tile_width / 3.0 / layout.pixels_per_unit());
  const int pixels = static_cast<int>(std::lround(length * layout.pixels_per_unit()));
  const int baseline = layout.height - layout.text / 2;
  const Box box{layout.margin, baseline - layout.text / 2, pixels, std::max(2, layout.text / 5)};
  pen.stack(box, {{26, 26, 26}});
  pen.write(with_unit(length, sheet.unit), box.left + pixels + layout.text / 2, baseline);
}

}  // namespace

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

}  // namespace mimetra
