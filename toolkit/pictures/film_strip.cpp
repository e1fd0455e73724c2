#include "toolkit/pictures/film_strip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "toolkit/correspondence/mesh_drawing.h"
#include "toolkit/drawing/sheet_layout.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

const RowColor& color_of(const StripOptions& options, std::size_t row) {
  return options.colors.size() == 1 ? options.colors.front() : options.colors[row];
}

std::string row_name(const StripOptions& options, std::size_t row) {
  return "row " + std::to_string(row + 1) +
         (options.titles.empty() ? "" : " (" + options.titles[row] + ")");
}

void check(const std::vector<FieldSequence>& sequences, const StripOptions& options) {
  if (sequences.empty()) throw std::invalid_argument("a strip needs a sequence");
  check_options(options);
  check_options(options.viewpoint);
  if (options.colors.size() != 1 && options.colors.size() != sequences.size()) {
    throw std::invalid_argument(std::to_string(options.colors.size()) + " colours for " +
                                std::to_string(sequences.size()) +
                                " rows; expected one for all, or one each");
  }
  if (!options.titles.empty() && options.titles.size() != sequences.size()) {
    throw std::invalid_argument(std::to_string(options.titles.size()) + " titles for " +
                                std::to_string(sequences.size()) + " rows");
  }
}

/// Number of frames that all rows share. Sequences that move must have equal lengths.
int common_frames(const std::vector<FieldSequence>& sequences, const StripOptions& options) {
  int frames = 1;
  for (std::size_t row = 0; row < sequences.size(); ++row) {
    const int own = sequences[row].frames->frames();
    if (own == 1 || own == frames) continue;
    if (frames != 1) {
      throw MismatchError(row_name(options, row) + ": " + std::to_string(own) +
                          " frames, expected " + std::to_string(frames) +
                          " as in the rows above; use option 'frames'");
    }
    frames = own;
  }
  return frames;
}

std::vector<int> evenly_spread(int frames, int most) {
  const int columns = std::min(most, frames);
  std::vector<int> shown;
  shown.reserve(static_cast<std::size_t>(columns));
  for (int column = 0; column < columns; ++column) {
    shown.push_back(columns == 1 ? 0 : column * (frames - 1) / (columns - 1));
  }
  return shown;
}

std::vector<int> shown_frames(int frames, const StripOptions& options) {
  for (const int frame : options.frames) {
    if (frame >= frames) {
      throw MismatchError("there is no frame " + std::to_string(frame) + " to draw: the last is " +
                          std::to_string(frames - 1) + " (0-based)");
    }
  }
  const int first = options.frames.empty() ? 0 : options.frames.front();
  switch (options.layout) {
    case StripLayout::strip:
      return options.frames.empty() ? evenly_spread(frames, options.columns) : options.frames;
    case StripLayout::frame:
      return {first};
    case StripLayout::turntable:
      return std::vector<int>(static_cast<std::size_t>(options.columns), first);
  }
  return {};
}

/// Reads a pose when it is drawn, so that a picture of some frames reads no others.
Positions pose(const FieldSequence& fields, int frame) {
  return FrameBlock(*fields.frames, fields.frames->frames() == 1 ? 0 : frame, 1).frame(0);
}

/// Values of triangles on their vertices: the largest of each vertex.
Eigen::VectorXd on_vertices(const Eigen::VectorXd& values, const FrameSource& sequence) {
  Eigen::VectorXd result =
      Eigen::VectorXd::Constant(sequence.vertices(), std::numeric_limits<double>::quiet_NaN());
  const Triangles& triangles = sequence.triangles();
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (const int v : triangles.row(t)) result[v] = std::fmax(result[v], values[t]);
  }
  return result;
}

const Field& field_of(const FieldSequence& fields, const std::string& name,
                      const std::string& row) {
  const auto found = std::ranges::find(fields.fields, name, &Field::name);
  if (found != fields.fields.end()) return *found;
  std::string known = joined(choice_names<StripColor>());
  for (const Field& field : fields.fields) known += ", " + field.name;
  throw MismatchError(row + ": no field '" + name + "'; it can be coloured by " + known);
}

/// One value per vertex; fields with several columns give their length.
Eigen::VectorXd vertex_values(const Field& field, const FrameSource& sequence) {
  const Eigen::VectorXd values = field.values.cols() == 1
                                     ? Eigen::VectorXd(field.values.col(0))
                                     : Eigen::VectorXd(field.values.rowwise().norm());
  return field.location == Field::Location::vertices ? values : on_vertices(values, sequence);
}

/// Whether the whole numbers of a field are names: regions, or numbers with negative ones for
/// "none".
bool is_category(const Field& field) {
  return field.integer && field.values.cols() == 1 && field.values.size() > 0 &&
         (field.name == "region" || field.values.minCoeff() < 0);
}

/// View of a whole mesh as the picture shows it.
MeshView whole_view(const TriMesh& mesh, const View& view) {
  MeshView whole;
  whole.axes << view.right.transpose(), view.up.transpose(), view.towards_eye.transpose();
  const Positions used =
      mesh.positions(surface_vertices(mesh.positions, mesh.connectivity.triangles), Eigen::all);
  const Positions turned = used * whole.axes.transpose();
  const Eigen::RowVector3d low = turned.colwise().minCoeff(), high = turned.colwise().maxCoeff();
  whole.centre = whole.axes.transpose() * ((low + high) / 2).transpose();
  constexpr double kRim = 1.02;
  whole.side = kRim * (high - low).head<2>().maxCoeff();
  whole.pixels = 400;
  whole.samples = 1;
  return whole;
}

/// Distance of each pixel in a square of `side` pixels to the nearest pixel with another number, in
/// steps that may be diagonal.
std::vector<int> margins_of(const std::vector<int>& numbers, int side) {
  std::vector<int> margins(numbers.size(), 0);
  const auto index = [side](int column, int row) {
    return static_cast<std::size_t>(row) * side + column;
  };
  const auto margin = [&](int column, int row, int step) {
    const std::size_t here = index(column, row);
    int least = std::numeric_limits<int>::max();
    for (const auto& [across, down] : {std::pair(-step, 0), {-1, -step}, {0, -step}, {1, -step}}) {
      const int x = column + across, y = row + down;
      const bool is_inside = x >= 0 && x < side && y >= 0 && y < side;
      const bool is_same = is_inside && numbers[index(x, y)] == numbers[here];
      least = std::min(least, is_same ? margins[index(x, y)] : 0);
    }
    return least + 1;
  };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      margins[index(column, row)] = margin(column, row, 1);
    }
  }
  for (int row = side - 1; row >= 0; --row) {
    for (int column = side - 1; column >= 0; --column) {
      int& known = margins[index(column, row)];
      known = std::min(known, margin(column, row, -1));
    }
  }
  return margins;
}

/// Colours of one row.
class RowPainter {
 public:
  RowPainter(const std::vector<FieldSequence>& sequences, const StripOptions& options,
             std::size_t row, const std::vector<int>& frames)
      : sequences_(sequences), options_(options), row_(row) {
    const RowColor& color = color_of(options, row);
    if (const auto* measured = std::get_if<StripColor>(&color)) {
      measure(*measured, frames);
    } else {
      show(field_of(sequences[row], std::get<std::string>(color), row_name(options, row)),
           frames.size());
    }
  }

  std::optional<ColorBar> bar() const {
    if (values_.empty() || !categories_.empty()) return {};
    ColorBar bar{0, 0, unit_, name_};
    for (const Eigen::VectorXd& values : values_) {
      for (const double value : values) {
        if (!std::isfinite(value)) continue;
        bar.minimum = std::min(bar.minimum, value);
        bar.maximum = std::max(bar.maximum, value);
      }
    }
    if (options_.maximum) bar.maximum = *options_.maximum;
    return bar;
  }

  /// Legend of numbers that are names, without "none".
  Legend legend() const {
    std::map<int, Color> colors;
    for (std::size_t v = 0; v < numbers_.size(); ++v) {
      if (numbers_[v] >= 0) colors.emplace(numbers_[v], categories_[v]);
    }
    Legend legend{name_, {}};
    for (const auto& [number, color] : colors) legend.entries.push_back({number, color});
    return legend;
  }

  bool is_crisp() const { return !categories_.empty(); }

  /// Labels with the numbers, each placed as deep inside its colour as possible in `view`.
  std::vector<TileLabel> labels(const Positions& pose, const View& view) const {
    if (numbers_.empty()) return {};
    const TriMesh mesh{pose, sequences_[row_].frames->connectivity()};
    const MeshView from = whole_view(mesh, view);
    if (!(from.side > 0)) return {};  // seen as a single point
    const MeshPainter painter(mesh);
    const std::vector<SeenPlace> places = painter.draw(from).places;
    std::vector<int> seen(places.size(), -1);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const SeenPlace& place = places[i];
      if (place.triangle < 0 || !painter.shows_outside(place.triangle, from)) continue;
      int nearest = 0;
      place.shares.maxCoeff(&nearest);
      const VertexIndex v = mesh.connectivity.triangles(place.triangle, nearest);
      seen[i] = numbers_[static_cast<std::size_t>(v)];
    }
    const std::vector<int> margins = margins_of(seen, from.pixels);
    std::map<int, std::size_t> deepest;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] < 0) continue;
      const auto best = deepest.try_emplace(seen[i], i).first;
      if (margins[i] > margins[best->second]) best->second = i;
    }
    std::vector<TileLabel> labels;
    for (const auto& [number, pixel] : deepest) {
      labels.push_back({std::to_string(number), painter.position(places[pixel]).transpose()});
    }
    return labels;
  }

  std::vector<Color> colors(std::size_t column, const std::optional<ColorBar>& bar) const {
    if (!categories_.empty() || values_.empty()) return categories_;
    const double range = bar->maximum - bar->minimum;
    std::vector<Color> colors;
    for (const double value : values_[column]) {
      colors.push_back(even_color(range > 0 ? (value - bar->minimum) / range : 0));
    }
    return colors;
  }

 private:
  /// Measures lengths in each of the frames.
  void measure(StripColor color, const std::vector<int>& frames) {
    const FieldSequence& own = sequences_[row_];
    unit_ = options_.unit;
    name_ = choice_name(color);
    for (const int frame : frames) {
      switch (color) {
        case StripColor::none:
          break;
        case StripColor::displacement:
          values_.push_back(distance(pose(own, frame), own.frames->rest()));
          break;
        case StripColor::difference:
          values_.push_back(difference(frame));
          break;
      }
    }
  }

  /// Shows a field, which is the same in all columns.
  void show(const Field& field, std::size_t columns) {
    const FrameSource& sequence = *sequences_[row_].frames;
    values_.assign(columns, vertex_values(field, sequence));
    name_ = field.name;
    if (is_category(field)) {
      numbers_ = whole_numbers(values_.front());
      categories_ = category_colors(numbers_, sequence.triangles());
    }
  }

  static Eigen::VectorXd distance(const Positions& a, const Positions& b) {
    return (a - b).rowwise().norm();
  }

  static std::vector<int> whole_numbers(const Eigen::VectorXd& values) {
    std::vector<int> numbers;
    for (const double value : values) numbers.push_back(static_cast<int>(std::lround(value)));
    return numbers;
  }

  Eigen::VectorXd difference(int frame) const {
    const std::string name = row_name(options_, row_);
    if (row_ == 0) throw MismatchError(name + ": there is no row above to differ from");
    const Positions own = pose(sequences_[row_], frame), above = pose(sequences_[row_ - 1], frame);
    if (own.rows() != above.rows()) {
      throw MismatchError(name + ": " + std::to_string(own.rows()) +
                          " vertices, the row above has " + std::to_string(above.rows()) +
                          ", so that there is no difference");
    }
    return distance(own, above);
  }

  const std::vector<FieldSequence>& sequences_;
  const StripOptions& options_;
  std::size_t row_;
  std::vector<Eigen::VectorXd> values_;  // by column; empty for none
  std::string name_, unit_;              // name and unit of the values
  std::vector<int> numbers_;             // numbers of vertices that are names; otherwise empty
  std::vector<Color> categories_;
};

std::string time_title(double seconds) {
  return fixed(seconds, 2) + " s";
}

double turn_of(const StripOptions& options, std::size_t column) {
  if (options.layout != StripLayout::turntable) return 0;
  return 360.0 * static_cast<double>(column) / options.columns;
}

std::vector<std::string> column_titles(const std::vector<FieldSequence>& sequences,
                                       const std::vector<int>& frames,
                                       const StripOptions& options) {
  const auto longest = std::ranges::max_element(
      sequences, {}, [](const FieldSequence& fields) { return fields.frames->frames(); });
  std::vector<std::string> titles;
  if (longest->frames->frames() == 1 || options.layout == StripLayout::turntable) return titles;
  for (const int frame : frames) titles.push_back(time_title(longest->frames->times()[frame]));
  return titles;
}

}  // namespace

Sheet film_strip(const std::vector<FieldSequence>& sequences, const StripOptions& options) {
  check(sequences, options);
  const std::vector<int> frames = shown_frames(common_frames(sequences, options), options);
  Sheet sheet;
  sheet.viewpoint = options.viewpoint;
  sheet.tile_height = options.tile_height;
  sheet.letters = options.letters;
  sheet.unit = options.unit;
  sheet.edges = options.edges;
  sheet.column_titles = column_titles(sequences, frames, options);
  for (std::size_t row = 0; row < sequences.size(); ++row) {
    const RowPainter painter(sequences, options, row, frames);
    TileRow tiles;
    if (!options.titles.empty()) tiles.title = options.titles[row];
    tiles.connectivity = sequences[row].frames->shared_connectivity();
    tiles.bar = painter.bar();
    tiles.legend = painter.legend();
    for (std::size_t column = 0; column < frames.size(); ++column) {
      Tile tile;
      tile.positions = pose(sequences[row], frames[column]);
      tile.colors = painter.colors(column, tiles.bar);
      tile.crisp = painter.is_crisp();
      tile.turn = turn_of(options, column);
      // One label is enough if only the pose changes.
      if (column == 0 || options.layout == StripLayout::turntable) {
        tile.labels = painter.labels(tile.positions, view_of(options.viewpoint, tile.turn));
      }
      tiles.tiles.push_back(std::move(tile));
    }
    sheet.rows.push_back(std::move(tiles));
  }
  return sheet;
}

}  // namespace mimetra
