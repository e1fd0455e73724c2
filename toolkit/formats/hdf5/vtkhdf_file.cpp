#include "toolkit/formats/hdf5/vtkhdf_file.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "toolkit/formats/hdf5/hdf5_image.h"
#include "toolkit/io/point_cache.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

const std::string kTop = "VTKHDF", kSteps = kTop + "/Steps";
const std::string kPoints = kTop + "/Points";

using Integers = std::vector<std::int64_t>;

Hdf5Array array_of(const Integers& values) {
  return Hdf5Array::of(std::span<const std::int64_t>(values), {values.size()});
}

Hdf5Array number(std::int64_t value) {
  return Hdf5Array::of(std::span<const std::int64_t>(&value, 1), {});
}

/// Name of an HDF5 link, in which '/' would separate paths.
std::string link_name(std::string name) {
  std::ranges::replace(name, '/', '_');
  return name == "." ? "_" : name;
}

/// Adds the cells of one of PolyData's four kinds.
void add_cells(Hdf5Image& image, const std::string& kind, const Integers& offsets,
               const Integers& corners) {
  const std::string group = kTop + "/" + kind + "/";
  image.add(group + "NumberOfCells", array_of({static_cast<std::int64_t>(offsets.size()) - 1}));
  image.add(group + "NumberOfConnectivityIds",
            array_of({static_cast<std::int64_t>(corners.size())}));
  image.add(group + "Offsets", array_of(offsets));
  image.add(group + "Connectivity", array_of(corners));
}

/// Row at which each step's part of a dataset starts: `rows` later for each step, or always 0.
Hdf5Array places(int steps, std::int64_t rows, std::size_t columns = 1) {
  Integers places(static_cast<std::size_t>(steps) * columns);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = rows * static_cast<std::int64_t>(i / columns);
  }
  std::vector<std::uint64_t> shape = {static_cast<std::uint64_t>(steps)};
  if (columns > 1) shape.push_back(columns);
  return Hdf5Array::of(std::span<const std::int64_t>(places), std::move(shape));
}

void add_steps(Hdf5Image& image, const FrameSource& frames) {
  const int steps = frames.frames();
  const Eigen::VectorXd& times = frames.times();
  image.add_attribute(kSteps, "NSteps", number(steps));
  image.add(kSteps + "/Values",
            Hdf5Array::of(std::span(times.data(), static_cast<std::size_t>(steps))));
  image.add(kSteps + "/PartOffsets", places(steps, 0));
  image.add(kSteps + "/NumberOfParts", array_of(Integers(static_cast<std::size_t>(steps), 1)));
  image.add(kSteps + "/PointOffsets", places(steps, frames.vertices()));
  // Columns: vertices, lines, polygons and strips.
  image.add(kSteps + "/CellOffsets", places(steps, 0, 4));
  image.add(kSteps + "/ConnectivityIdOffsets", places(steps, 0, 4));
}

void add_field(Hdf5Image& image, const Field& field, const FrameSource& frames) {
  const bool of_points = field.location == Field::Location::vertices;
  const Eigen::Index expected = of_points ? frames.vertices() : frames.triangles().rows();
  if (field.values.rows() != expected || field.values.cols() == 0) {
    throw std::invalid_argument("field '" + field.name +
                                "': " + std::to_string(field.values.rows()) + " values, expected " +
                                std::to_string(expected));
  }
  const Hdf5Array::Rows<double> values =
      of_points ? field.values : on_polygons(field.values, frames.connectivity());
  const std::string kind = of_points ? "Point" : "Cell", name = link_name(field.name);
  const bool is_integer = field.integer && all_are_held_by<int>(values);
  Hdf5Array array =
      is_integer ? Hdf5Array::of(Hdf5Array::Rows<int>(values.cast<int>())) : Hdf5Array::of(values);
  if (values.cols() == 1) array.shape.pop_back();
  image.add(kTop + "/" + kind + "Data/" + name, std::move(array));
  image.add(kSteps + "/" + kind + "DataOffsets/" + name, places(frames.frames(), 0));
}

void check_names(const FieldSequence& sequence) {
  std::set<std::pair<Field::Location, std::string>> names;
  if (sequence.displacement) {
    names.insert({Field::Location::vertices, kDisplacement});
    names.insert({Field::Location::vertices, kDisplacementLength});
  }
  for (const Field& field : sequence.fields) {
    if (names.insert({field.location, link_name(field.name)}).second) continue;
    throw std::invalid_argument("field '" + field.name +
                                "' occurs twice; give each field its own name");
  }
}

/// Place in the file of the values of all steps.
struct StepValues {
  StoredFloats stored;
  std::size_t of_step;

  void write(const OutputFile& file, int first, const Frames& values) const {
    stored.write(file, of_step * static_cast<std::size_t>(first),
                 {values.data(), static_cast<std::size_t>(values.size())});
  }
};

/// File without positions and displacements, and their places in it.
struct Layout {
  Hdf5Image image;
  std::size_t number_bytes;

  /// Reserves a dataset with `columns` numbers for each vertex in each step.
  void reserve(const std::string& path, const FrameSource& frames, std::uint64_t columns) {
    std::vector<std::uint64_t> shape = {static_cast<std::uint64_t>(frames.frames()) *
                                        static_cast<std::uint64_t>(frames.vertices())};
    if (columns > 1) shape.push_back(columns);
    image.reserve(
        path, number_bytes == sizeof(float) ? Hdf5Array::Type::float32 : Hdf5Array::Type::float64,
        std::move(shape));
  }

  StepValues values_of(const std::string& path, std::size_t of_step) const {
    return {{image.place_of(path), number_bytes, std::endian::little}, of_step};
  }
};

Layout layout_of(const FieldSequence& sequence, const WriteOptions& options) {
  const FrameSource& frames = *sequence.frames;
  const PositionsView rest(frames.rest().data(), frames.vertices(), 3);
  const bool twice = options.double_precision || needs_double(rest, extent(rest));
  Layout layout{{}, twice ? sizeof(double) : sizeof(float)};
  Hdf5Image& image = layout.image;
  image.add_attribute(kTop, "Version", array_of({2, 0}));
  image.add_attribute(kTop, "Type", Hdf5Array::of(std::string_view("PolyData")));
  image.add(kTop + "/NumberOfPoints", array_of({frames.vertices()}));
  layout.reserve(kPoints, frames, 3);
  for (const char* kind : {"Vertices", "Lines", "Strips"}) add_cells(image, kind, {0}, {});
  const Polygons& polygons = frames.connectivity().polygons;
  add_cells(image, "Polygons", {polygons.offsets.begin(), polygons.offsets.end()},
            {polygons.corners.begin(), polygons.corners.end()});
  add_steps(image, frames);
  for (const Field& field : sequence.fields) add_field(image, field, frames);
  if (!sequence.displacement) return layout;
  for (const auto& [name, columns] : {std::pair(kDisplacement, 3), {kDisplacementLength, 1}}) {
    layout.reserve(kTop + "/PointData/" + name, frames, static_cast<std::uint64_t>(columns));
    image.add(kSteps + "/PointDataOffsets/" + name, places(frames.frames(), frames.vertices()));
  }
  return layout;
}

void write_steps(const FieldSequence& sequence, const Layout& layout, const OutputFile& file,
                 const fs::path& target, const Context& context) {
  const FrameSource& frames = *sequence.frames;
  const auto vertices = static_cast<std::size_t>(frames.vertices());
  const StepValues points = layout.values_of(kPoints, 3 * vertices);
  const auto write_displacements = [&](int first, Frames poses) {
    const Positions& rest = frames.rest();
    poses.rowwise() -= Eigen::Map<const Eigen::RowVectorXd>(rest.data(), rest.size());
    const PositionsView ways(poses.data(), poses.size() / 3, 3);
    const Frames lengths = ways.rowwise().norm().reshaped<Eigen::RowMajor>(
        poses.rows(), static_cast<Eigen::Index>(vertices));
    layout.values_of(kTop + "/PointData/" + kDisplacement, 3 * vertices).write(file, first, poses);
    layout.values_of(kTop + "/PointData/" + kDisplacementLength, vertices)
        .write(file, first, lengths);
  };
  const auto write = [&](int first, const Frames& poses) {
    if (layout.number_bytes == sizeof(float)) check_single_range(target, first, poses);
    points.write(file, first, poses);
    if (sequence.displacement) write_displacements(first, poses);
  };
  for_each_block(frames, write, context.without_ranks());
}

}  // namespace

std::vector<fs::path> write_vtkhdf(const FieldSequence& sequence, const fs::path& target,
                                   const WriteOptions& options, const Context& context) {
  check_options(options);
  check_names(sequence);
  if (sequence.frames->frames() == 0) throw std::invalid_argument("the sequence has no frames");
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  OutputFile file(outputs.add(target, PendingOutput::Kind::file));
  Layout layout = layout_of(sequence, options);
  context.report(0);
  file.write({layout.image.image()});
  write_steps(sequence, layout, file, target, context);
  file.close();
  std::vector<fs::path> files = {target};
  add_extra_beside(outputs, target, options.extra, files);
  context.report(1);
  outputs.commit();
  return files;
}

}  // namespace mimetra
