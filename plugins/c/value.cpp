#include "plugins/c/value.h"

#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "toolkit/io/file_parameters.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/operations/call.h"
#include "toolkit/operations/colors.h"

namespace mimetra {

namespace {

/// Values of a matrix, row after row.
std::vector<double> by_rows(const Eigen::MatrixXd& matrix) {
  std::vector<double> values(static_cast<std::size_t>(matrix.size()));
  Eigen::Map<Frames>(values.data(), matrix.rows(), matrix.cols()) = matrix;
  return values;
}

template <typename Value>
std::vector<double> of_regions(const Regions& regions, Value value) {
  std::vector<double> values;
  for (const Region& region : regions.regions) values.push_back(value(region));
  return values;
}

}  // namespace

ShownArrays::ShownArrays(const Data& data) {
  std::visit([this](const auto& value) { show(value); }, data);
  for (const mimetra_array& array : arrays_) list_.push_back(&array);
  list_.push_back(nullptr);
}

const mimetra_array* ShownArrays::find(const std::string& name) const {
  const auto found =
      std::ranges::find_if(arrays_, [&](const mimetra_array& array) { return name == array.name; });
  return found == arrays_.end() ? nullptr : &*found;
}

void ShownArrays::add(const char* name, int type, Shape shape, const void* values, int location) {
  // Empty arrays have an address as well, because many languages do not accept a null pointer.
  static const double nothing = 0;
  mimetra_array array{};
  array.struct_size = sizeof array;
  array.type = type;
  array.rank = static_cast<std::int32_t>(shape.size());
  array.location = location;
  std::ranges::copy(shape, array.shape);
  array.name = name;
  array.values = values ? values : &nothing;
  arrays_.push_back(array);
}

void ShownArrays::add_numbers(const char* name, Shape shape, std::vector<double> values,
                              int location) {
  add(name, MIMETRA_F64, shape, numbers_.emplace_back(std::move(values)).data(), location);
}

void ShownArrays::add_integers(const char* name, Shape shape, std::vector<std::int32_t> values,
                               int location) {
  add(name, MIMETRA_I32, shape, integers_.emplace_back(std::move(values)).data(), location);
}

void ShownArrays::add_bytes(const char* name, Shape shape, std::vector<std::uint8_t> values) {
  add(name, MIMETRA_U8, shape, bytes_.emplace_back(std::move(values)).data());
}

void ShownArrays::add_strings(const char* name, const std::vector<std::string>& texts) {
  std::vector<const char*>& pointers = strings_.emplace_back();
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  add(name, MIMETRA_STRING, {static_cast<Eigen::Index>(texts.size())}, pointers.data());
}

void ShownArrays::add_vector(const char* name, const Eigen::VectorXd& values) {
  if (values.size() > 0) add(name, MIMETRA_F64, {values.size()}, values.data());
}

void ShownArrays::show(const Connectivity& faces) {
  const Polygons& polygons = faces.polygons;
  std::vector<std::int32_t> sizes;
  for (int i = 0; i < polygons.size(); ++i) {
    const auto face = static_cast<std::size_t>(i);
    sizes.push_back(polygons.offsets[face + 1] - polygons.offsets[face]);
  }
  add_integers("face_sizes", {polygons.size()}, std::move(sizes));
  add("corners", MIMETRA_I32, {static_cast<Eigen::Index>(polygons.corners.size())},
      polygons.corners.data());
  show_triangles(faces.triangles);
  add("face_of_triangle", MIMETRA_I32,
      {static_cast<Eigen::Index>(faces.polygon_of_triangle.size())},
      faces.polygon_of_triangle.data());
}

void ShownArrays::show_triangles(const Triangles& triangles) {
  add("triangles", MIMETRA_I32, {triangles.rows(), 3}, triangles.data());
}

void ShownArrays::show(const MeshSequence& sequence) {
  const Eigen::Index vertices = sequence.vertices();
  add("positions", MIMETRA_F64, {sequence.frames(), vertices, 3}, sequence.positions().data());
  add_vector("times", sequence.times());
  if (sequence.rest_is_known()) {
    add("rest", MIMETRA_F64, {vertices, 3}, sequence.rest().data());
  }
  show(sequence.connectivity());
}

void ShownArrays::show_basis(const ShapeBasis& basis, const char* shapes, const char* names) {
  if (basis.size() == 0) return;
  // The matrix is stored by columns, and each column is a shape.
  add(shapes, MIMETRA_F64, {basis.size(), basis.displacements.rows() / 3, 3},
      basis.displacements.data());
  add_strings(names, basis.names);
}

void ShownArrays::show(const ModelData& data) {
  const MorphableModel& model = data.model;
  add("neutral", MIMETRA_F64, {model.vertices(), 3}, model.mean().data());
  show(model.connectivity());
  show_basis(model.expressions(), "expressions", "expression_names");
  show_basis(model.identities(), "identities", "identity_names");
  const WeightTrack& track = data.performance;
  if (!track.names.empty()) {
    add_numbers("weights", {track.weights.rows(), track.weights.cols()}, by_rows(track.weights));
    add_strings("weight_names", track.names);
    add_vector("times", track.times);
  }
  if (data.landmarks.empty()) return;
  std::vector<std::int32_t> pairs;
  for (const auto& [landmark, vertex] : data.landmarks) {
    pairs.push_back(landmark);
    pairs.push_back(vertex);
  }
  add_integers("landmarks", {static_cast<Eigen::Index>(data.landmarks.size()), 2},
               std::move(pairs));
}

void ShownArrays::show(const Components& components) {
  const Eigen::Index count = components.count();
  const Eigen::Index vertices = components.vertices();
  add("rest", MIMETRA_F64, {vertices, 3}, components.rest.data());
  show_triangles(components.triangles);
  add("displacements", MIMETRA_F64, {count, vertices, 3}, components.displacements.data());
  if (components.weights.size() > 0) {
    add_numbers("weights", {components.weights.rows(), count}, by_rows(components.weights));
  }
  add("centers", MIMETRA_I32, {count}, components.centers.data());
  if (components.support.size() > 0) {
    add_numbers("support", {count, vertices}, by_rows(components.support));
  }
  add("energies", MIMETRA_F64, {static_cast<Eigen::Index>(components.energies.size())},
      components.energies.data());
  add("scale", MIMETRA_F64, {1}, &components.scale);
  add("d_min", MIMETRA_F64, {1}, &components.d_min);
  add("d_max", MIMETRA_F64, {1}, &components.d_max);
}

void ShownArrays::show(const RegionData& data) {
  const Regions& regions = data.regions;
  const auto count = static_cast<Eigen::Index>(regions.regions.size());
  const auto vertices = static_cast<std::size_t>(regions.vertices);
  std::vector<std::uint8_t> masks(regions.regions.size() * vertices);
  std::vector<std::int32_t> centers;
  for (std::size_t r = 0; r < regions.regions.size(); ++r) {
    for (const VertexIndex vertex : regions.regions[r].vertices) {
      masks[r * vertices + static_cast<std::size_t>(vertex)] = 1;
    }
    centers.push_back(regions.regions[r].center);
  }
  add_bytes("masks", {count, regions.vertices}, std::move(masks));
  add_integers("centers", {count}, std::move(centers));
  add_numbers("radii", {count}, of_regions(regions, [](const Region& r) { return r.radius; }));
  add_numbers("energies", {count}, of_regions(regions, [](const Region& r) { return r.energy; }));
  add_numbers("energy_shares", {count},
              of_regions(regions, [](const Region& r) { return r.energy_share; }));
  add_vector("vertex_energy", regions.vertex_energy);
  const bool has_mesh = data.fields.frames->vertices() > 0;
  if (has_mesh) {
    show(data.fields.frames->connectivity());
  } else if (data.faces) {
    show_triangles(data.faces->triangles);
  }
  const std::vector<Field> own = has_mesh ? std::vector<Field>() : fields_of(regions);
  const std::vector<Field>& fields = has_mesh ? data.fields.fields : own;
  const auto strongest = std::ranges::find(fields, "region", &Field::name);
  if (strongest != fields.end() && (has_mesh || data.faces)) {
    show_colors(*strongest, regions,
                has_mesh ? data.fields.frames->triangles() : data.faces->triangles);
  }
  for (const Field& field : fields) show(field);
}

void ShownArrays::show_colors(const Field& strongest, const Regions& regions,
                              const Triangles& triangles) {
  if (strongest.values.rows() != regions.vertices) return;
  const Eigen::VectorXi region = strongest.values.col(0).cast<int>();
  std::vector<std::uint8_t> colors;
  for (const Color& color :
       colors_by_category({region.begin(), region.end()}, triangles, regions.regions.size())) {
    colors.insert(colors.end(), {color.red, color.green, color.blue});
  }
  add_bytes("colors", {static_cast<Eigen::Index>(regions.regions.size()), 3}, std::move(colors));
}

void ShownArrays::show(const Field& field) {
  const int location =
      field.location == Field::Location::vertices ? MIMETRA_ON_VERTICES : MIMETRA_ON_TRIANGLES;
  const char* name = names_.emplace_back(field.name).c_str();
  const Eigen::Index rows = field.values.rows(), columns = field.values.cols();
  std::vector<double> values = by_rows(field.values);
  if (!field.integer || !all_are_held_by<std::int32_t>(field.values)) {
    if (columns == 1) return add_numbers(name, {rows}, std::move(values), location);
    return add_numbers(name, {rows, columns}, std::move(values), location);
  }
  std::vector<std::int32_t> integers(values.begin(), values.end());
  if (columns == 1) return add_integers(name, {rows}, std::move(integers), location);
  add_integers(name, {rows, columns}, std::move(integers), location);
}

void ShownArrays::show(const FieldSequence& fields) {
  show(fields.sequence());
  for (const Field& field : fields.fields) show(field);
}

void ShownArrays::show(const Table& table) {
  const auto rows = static_cast<Eigen::Index>(table.rows.size());
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    std::vector<double> values;
    for (const auto& row : table.rows) {
      values.push_back(row[column].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    add_numbers(table.columns[column].c_str(), {rows}, std::move(values));
  }
  if (!table.word_column.empty()) add_strings(table.word_column.c_str(), table.words);
}

void ShownArrays::show(const Pictures& pictures) {
  static_assert(sizeof(Color) == 3);
  for (int i = 0; i < pictures.count; ++i) {
    const Image& image = images_.emplace_back(pictures.draw(i));
    const std::string name = pictures.count == 1 ? "pixels" : "pixels_" + std::to_string(i);
    add(names_.emplace_back(name).c_str(), MIMETRA_U8, {image.height, image.width, 3},
        image.pixels.data());
  }
}

void ShownArrays::show(const Document& document) {
  add_strings("text", texts_.emplace_back(1, document.text));
}

void ShownArrays::show(const LandmarkTrack& track) {
  add("points", MIMETRA_F64, {track.frames(), track.landmarks(), 2}, track.points.data());
  add_strings("names", track.names);
  add_vector("times", track.times);
  add_vector("confidence", track.confidence);
}

void ShownArrays::show(const FittedCoefficients& fit) {
  add_numbers("alpha", {fit.alpha.rows(), fit.alpha.cols()}, by_rows(fit.alpha));
  add_numbers("beta", {fit.beta.rows(), fit.beta.cols()}, by_rows(fit.beta));
  add_strings("identity_names", fit.identities);
  add_strings("expression_names", fit.expressions);
  add_vector("times", fit.times);
  std::vector<double> cameras;
  for (const auto& camera : fit.cameras) {
    for (const double value : camera.reshaped<Eigen::RowMajor>()) cameras.push_back(value);
  }
  add_numbers("cameras", {static_cast<Eigen::Index>(fit.cameras.size()), 2, 4}, std::move(cameras));
  add_vector("rms", fit.rms);
}

namespace {

std::string json_of(const Value& value) {
  const Data& data = value.named().data;
  if (const auto* regions = std::get_if<RegionData>(&data)) return regions_json(regions->regions);
  if (const auto* table = std::get_if<Table>(&data)) return table->json();
  if (const auto* fit = std::get_if<FittedCoefficients>(&data)) return fit_json(*fit);
  Json json = {
      {"name", value.named().name}, {"kind", kind_name(kind_of(data))}, {"arrays", Json::array()}};
  for (const mimetra_array& array : value.arrays().arrays()) {
    const std::vector<std::int64_t> shape(array.shape, array.shape + array.rank);
    json["arrays"].push_back({{"name", array.name}, {"shape", shape}});
  }
  return json_text(json);
}

}  // namespace

const ShownArrays& Value::arrays() const {
  const std::lock_guard lock(mutex_);
  if (!arrays_) arrays_.emplace(named_.data);
  return *arrays_;
}

const std::string& Value::json() const {
  {
    const std::lock_guard lock(mutex_);
    if (json_) return *json_;
  }
  // json_of() locks the mutex when it asks for the arrays.
  std::string text = json_of(*this);
  const std::lock_guard lock(mutex_);
  if (!json_) json_ = std::move(text);
  return *json_;
}

namespace {

/// Option to replace existing files. It is not a parameter of any operation.
const Parameter kForce = {"force", ParameterKind::flag, false, "replace what an earlier run wrote"};

Parameters parameters_of(std::vector<Parameter> declared, const char* const* settings) {
  Parameters parameters(std::move(declared));
  for (; settings && *settings; ++settings) {
    const std::string text = *settings;
    const auto end = text.find('=');
    const Parameter* parameter =
        end == std::string::npos ? nullptr : parameters.find(text.substr(0, end));
    if (!parameter) {
      std::string known;
      for (const Parameter& each : parameters.declared()) {
        known += (known.empty() ? "" : ", ") + each.name;
      }
      throw UsageError("setting '" + text + "': expected NAME=VALUE with one of " + known);
    }
    parameters.set(parameter->name, parse_value(*parameter, text.substr(end + 1)));
  }
  return parameters;
}

}  // namespace

NamedData loaded_data(const mimetra_context& context, DataKind kind, const std::string& text,
                      const char* const* settings) {
  if (kind == DataKind::regions) {
    throw UsageError(text + ": regions speak of a mesh; read them as an input of a call");
  }
  const OperationTable& table = context.table->operations();
  Operation reading;
  reading.inputs = {{"input", kind, ""}};
  reading.inputs.front().fields = reading.inputs.front().identities = true;
  const Parameters parameters = parameters_of(table.reader(kind, text).reading, settings);
  LoadedInputs loaded = load_inputs(table, reading, parameters, {{"input", {text}}}, context.log,
                                    {}, false, context.context);
  return std::move(loaded.data.at("input").front());
}

void write_data(const mimetra_context& context, const Data& data, const std::string& path,
                const char* const* settings) {
  const OperationTable& table = context.table->operations();
  Output output{"output", kind_of(data), ""};
  output.weights = output.kind == DataKind::table;
  const Format& format = table.writer(output, path);
  std::vector<Parameter> declared = format.writing;
  declared.push_back(kForce);
  const Parameters parameters = parameters_of(std::move(declared), settings);
  WriteOptions options = write_options(format.writing, parameters);
  options.overwrite = parameters.flag("force");
  for (const std::string& note : notes_on_losses(format, data, path, options)) {
    if (context.log) context.log(LogLevel::warning, note);
  }
  format.write(data, path, options, context.context);
}

}  // namespace mimetra
