#include "plugins/c/make_data.h"

#include <algorithm>
#include <cmath>

#include "plugins/c/crossing.h"
#include "plugins/c/given_arrays.h"
#include "plugins/c/value.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/painting_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_notes.h"

namespace mimetra {

namespace {

using Names = std::set<std::string, std::less<>>;

const Names& face_names() {
  static const Names names = {"face_sizes", "corners", "triangles", "face_of_triangle"};
  return names;
}

Polygons polygons_of(GivenArrays& given) {
  Polygons polygons;
  polygons.corners = given.integers("corners", "C");
  const auto corners = static_cast<std::int64_t>(polygons.corners.size());
  std::int64_t sum = 0;
  for (const int size : given.integers("face_sizes", "P")) {
    if (size < 3) {
      throw IoError(given.subject(), "array 'face_sizes' holds " + std::to_string(size) + " at [" +
                                         std::to_string(polygons.size()) + "], expected 3 or more");
    }
    sum += size;
    polygons.offsets.push_back(static_cast<int>(std::min(sum, corners)));
  }
  if (sum == corners) return polygons;
  throw MismatchError(given.subject() + ": array 'corners' has " + std::to_string(corners) +
                      " entries, expected " + std::to_string(sum) + ", the sum of 'face_sizes'");
}

Connectivity connectivity_of(GivenArrays& given, int vertices) {
  try {
    if (given.has("face_sizes") || given.has("corners")) {
      return Connectivity::from_polygons(vertices, polygons_of(given));
    }
    const std::vector<int> corners = given.integers("triangles", "T x 3");
    return Connectivity::from_triangles(
        vertices, Eigen::Map<const Triangles>(corners.data(), given.size('T'), 3));
  } catch (const UsageError&) {
    throw;
  } catch (const MismatchError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw IoError(given.subject(), error.what());
  }
}

/// Given faces, or otherwise the faces of `base`.
std::shared_ptr<const Connectivity> faces_of(
    GivenArrays& given, int vertices, const std::shared_ptr<const Connectivity>& base = nullptr) {
  const bool has_faces = given.has("face_sizes") || given.has("corners") || given.has("triangles");
  if (!has_faces && base) {
    if (base->vertices == vertices) return base;
    throw MismatchError(given.subject() + ": " + std::to_string(vertices) + " vertices, expected " +
                        std::to_string(base->vertices) +
                        " as in what it is derived of, or faces of its own");
  }
  auto connectivity = std::make_shared<Connectivity>(connectivity_of(given, vertices));
  if (connectivity->polygons.size() == 0) throw IoError(given.subject(), "has no faces");
  return connectivity;
}

using Base = std::shared_ptr<const Connectivity>;

/// Times in seconds, ascending.
Eigen::VectorXd times_of(GivenArrays& given) {
  Eigen::VectorXd times = given.vector("times", "F");
  for (Eigen::Index f = 1; f < times.size(); ++f) {
    if (times[f] > times[f - 1]) continue;
    throw IoError(given.subject(), "array 'times' holds " + readable(times[f]) + " at [" +
                                       std::to_string(f) + "], expected more than " +
                                       readable(times[f - 1]) + " before it");
  }
  return times;
}

MeshSequence sequence_of(GivenArrays& given, const Base& base) {
  const std::vector<std::int64_t> shape = given.shape("positions");
  const bool is_one = shape.size() == 2 && shape.back() == 3;
  Frames frames = given.numbers("positions", is_one ? "N x 3" : "F x N x 3");
  if (is_one) {
    frames = Frames(Eigen::Map<const Frames>(frames.data(), 1, frames.size()));
    given.set_size('F', 1, "'positions'");
  }
  auto connectivity = faces_of(given, given.size('N'), base);
  Eigen::VectorXd times;
  if (given.has("times")) times = times_of(given);
  std::optional<Positions> rest;
  if (given.has("rest")) rest = given.positions("rest");
  return {std::move(connectivity), std::move(frames), std::move(times), std::move(rest)};
}

ShapeBasis basis_of(GivenArrays& given, const std::string& shapes, const std::string& names,
                    char letter) {
  const std::string size(1, letter);
  ShapeBasis basis{{}, Eigen::MatrixXd(3 * given.size('N'), 0)};
  if (!given.has(shapes) && !given.has(names)) return basis;
  // Column j of the basis is row j of the array.
  basis.displacements = given.numbers(shapes, size + " x N x 3").transpose();
  basis.names = given.strings(names, size);
  return basis;
}

MorphableModel shapes_of(GivenArrays& given, const Base& base) {
  Positions neutral = given.positions("neutral");
  auto connectivity = faces_of(given, given.size('N'), base);
  ShapeBasis identities = basis_of(given, "identities", "identity_names", 'I');
  ShapeBasis expressions = basis_of(given, "expressions", "expression_names", 'D');
  return {std::move(connectivity), std::move(neutral), std::move(identities),
          std::move(expressions)};
}

double scalar_of(GivenArrays& given, const std::string& name, double fallback) {
  return given.has(name) ? given.vector(name, "1")[0] : fallback;
}

Components components_of(GivenArrays& given) {
  Components components;
  components.rest = given.positions("rest");
  components.triangles = connectivity_of(given, given.size('N')).triangles;
  components.displacements = given.numbers("displacements", "K x N x 3");
  if (given.has("weights")) components.weights = given.numbers("weights", "F x K");
  components.centers = given.integers("centers", "K");
  for (const VertexIndex center : components.centers) {
    if (center >= -1 && center < components.vertices()) continue;
    throw IoError(given.subject(), "array 'centers' holds vertex " + std::to_string(center) +
                                       ", expected -1 to " +
                                       std::to_string(components.vertices() - 1));
  }
  if (given.has("support")) components.support = given.numbers("support", "K x N");
  if (given.has("energies")) {
    const Eigen::VectorXd energies = given.vector("energies", "E");
    components.energies.assign(energies.begin(), energies.end());
  }
  components.scale = scalar_of(given, "scale", components.scale);
  components.d_min = scalar_of(given, "d_min", components.d_min);
  components.d_max = scalar_of(given, "d_max", components.d_max);
  components.options.count = components.count();
  return components;
}

/// Field `weight` of regions with a soft border; null without it.
const mimetra_array* weights_among(const GivenArrays& given) {
  for (const mimetra_array& array : given.all()) {
    if (array.location == MIMETRA_ON_VERTICES && std::string_view(array.name) == "weight") {
      return &array;
    }
  }
  return nullptr;
}

RegionData regions_of(GivenArrays& given, const Base& base) {
  const std::vector<std::uint8_t> masks = given.bytes("masks", "R x N");
  const int vertices = given.size('N');
  const auto connectivity = faces_of(given, vertices, base);
  std::vector<std::vector<VertexIndex>> lists(static_cast<std::size_t>(given.size('R')));
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const auto n = static_cast<std::size_t>(vertices);
    if (masks[i]) lists[i / n].push_back(static_cast<VertexIndex>(i % n));
  }
  Regions regions = regions_from_vertices(vertices, connectivity->triangles, lists);
  if (const mimetra_array* const array = weights_among(given)) {
    const Eigen::VectorXd weights = given.numbers(*array, "N", true).reshaped();
    check_painting(given.subject() + ": array 'weight'", weights);
    regions = with_weights(std::move(regions), weights, connectivity->triangles);
  }
  return {std::move(regions), {}, connectivity};
}

Field field_of(GivenArrays& given, const mimetra_array& array) {
  Field field{array.name, Field::Location::vertices, {}, false};
  if (array.location == MIMETRA_ON_TRIANGLES) {
    field.location = Field::Location::triangles;
  }
  const std::string rows = array.location == MIMETRA_ON_TRIANGLES ? "T" : "N";
  // Each field has its own number of columns.
  const std::string columns = array.rank == 2 ? " x " + std::to_string(array.shape[1]) : "";
  if (columns == " x 0") {
    throw UsageError(given.subject() + ": array '" + field.name + "' has no columns");
  }
  field.values = given.numbers(array, rows + columns, false);
  field.integer = array.type == MIMETRA_I32 || array.type == MIMETRA_U8;
  return field;
}

FieldSequence shown_sequence_of(GivenArrays& given, const Base& base) {
  FieldSequence made(sequence_of(given, base));
  given.set_size('T', static_cast<int>(made.frames->triangles().rows()), "the faces");
  for (const mimetra_array& array : given.all()) {
    if (array.location != MIMETRA_NOWHERE) made.fields.push_back(field_of(given, array));
  }
  return made;
}

Table table_of(GivenArrays& given) {
  Table table;
  if (given.all().empty()) throw UsageError(given.subject() + ": a table needs columns");
  for (const mimetra_array& array : given.all()) {
    const Eigen::VectorXd values = given.vector(array.name, "R", false);
    table.columns.emplace_back(array.name);
    table.rows.resize(static_cast<std::size_t>(values.size()));
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const double value = values[static_cast<Eigen::Index>(row)];
      table.rows[row].push_back(std::isnan(value) ? std::nullopt : std::optional(value));
    }
  }
  return table;
}

ModelData model_of(GivenArrays& given, const Base& base) {
  ModelData made{shapes_of(given, base)};
  if (given.has("weights") || given.has("weight_names")) {
    made.performance.weights = given.numbers("weights", "F x W");
    made.performance.names = given.strings("weight_names", "W");
    if (given.has("times")) made.performance.times = times_of(given);
    note_odd_times(made.performance);
  }
  if (!given.has("landmarks")) return made;
  const std::vector<int> pairs = given.integers("landmarks", "L x 2");
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    made.landmarks.emplace_back(pairs[i], pairs[i + 1]);
    if (pairs[i + 1] >= 0 && pairs[i + 1] < made.model.vertices()) continue;
    throw IoError(given.subject(), "array 'landmarks' holds vertex " +
                                       std::to_string(pairs[i + 1]) + ", expected 0 to " +
                                       std::to_string(made.model.vertices() - 1));
  }
  return made;
}

Pictures picture_of(GivenArrays& given) {
  const std::vector<std::uint8_t> bytes = given.bytes("pixels", "H x W x 3");
  Image image(given.size('W'), given.size('H'));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]};
  }
  return Pictures::of(std::move(image));
}

LandmarkTrack landmarks_of(GivenArrays& given) {
  LandmarkTrack track;
  track.points = given.numbers("points", "F x L x 2", false);
  track.names = given.strings("names", "L");
  if (track.names.empty()) throw IoError(given.subject(), "needs a landmark or more");
  const int frames = given.size('F');
  track.times_are_known = given.has("times");
  track.times = track.times_are_known
                    ? times_of(given)
                    : Eigen::VectorXd::LinSpaced(frames, 0, (frames - 1) / kDefaultFramesPerSecond);
  if (given.has("confidence")) track.confidence = given.vector("confidence", "F");
  return track;
}

Document document_of(GivenArrays& given) {
  return {given.text("text")};
}

Data data_of(mimetra_kind kind, GivenArrays& given, const Base& base) {
  switch (kind) {
    case MIMETRA_SEQUENCE:
      return shown_sequence_of(given, base);
    case MIMETRA_MODEL:
      return model_of(given, base);
    case MIMETRA_COMPONENTS:
      return components_of(given);
    case MIMETRA_REGIONS:
      return regions_of(given, base);
    case MIMETRA_TABLE:
      return table_of(given);
    case MIMETRA_LANDMARKS:
      return landmarks_of(given);
    case MIMETRA_PICTURES:
      return picture_of(given);
    case MIMETRA_DOCUMENT:
      return document_of(given);
    default:
      throw UsageError(given.subject() + ": values of the kind '" +
                       std::string(kind_name(kind_of(kind))) + "' cannot be made of arrays");
  }
}

/// Arrays that values of a kind show but are not made from.
Names shown_only(mimetra_kind kind, const GivenArrays& given) {
  Names names;
  if (kind == MIMETRA_REGIONS) {
    names = {"centers", "radii", "energies", "energy_shares", "vertex_energy", "colors"};
    for (const mimetra_array& array : given.all()) {
      if (array.location != MIMETRA_NOWHERE) names.insert(array.name);
    }
  }
  const bool has_faces = kind != MIMETRA_TABLE && kind != MIMETRA_PICTURES;
  if (has_faces) names.insert(face_names().begin(), face_names().end());
  return names;
}

std::string subject_of(mimetra_kind kind, const std::string& name) {
  const std::string text(kind_name(kind_of(kind)));
  return name.empty() ? text : name;
}

/// Notes on a value, like the notes on a value from a file.
std::vector<std::string> notes_on(const NamedData& made, const std::string& subject) {
  std::vector<std::string> notes;
  if (const auto* sequence = std::get_if<FieldSequence>(&made.data)) {
    const std::string odd = note_on_steps(sequence->frames->known_times());
    if (!odd.empty()) notes.push_back(subject + ": " + odd);
  } else if (const auto* held = std::get_if<ModelData>(&made.data)) {
    const MorphableModel& model = held->model;
    notes = notes_on_expressions(subject, model.mean(), model.connectivity().triangles,
                                 model.expressions());
    for (const std::string& note : held->performance.notes) notes.push_back(subject + ": " + note);
  }
  return notes;
}

/// Connectivity of a value, which no array shows; null if it has none.
Base hidden_connectivity(const Data& data) {
  if (const auto* shown = std::get_if<FieldSequence>(&data)) {
    return shown->frames->shared_connectivity();
  }
  if (const auto* held = std::get_if<ModelData>(&data)) return held->model.shared_connectivity();
  if (const auto* data_of_regions = std::get_if<RegionData>(&data)) {
    const FrameSource& mesh = *data_of_regions->fields.frames;
    return mesh.frames() > 0 ? mesh.shared_connectivity() : data_of_regions->faces;
  }
  return nullptr;
}

/// Copies properties of `base` that no array shows to a value derived from it.
void keep_hidden(const NamedData& base, NamedData& made) {
  if (auto* sequence = std::get_if<FieldSequence>(&made.data)) {
    made.origin.model_driven = base.origin.model_driven;
    sequence->displacement = std::get<FieldSequence>(base.data).displacement;
  } else if (std::holds_alternative<ModelData>(made.data)) {
    // Other contents of the model's folder belong to its vertices.
    if (hidden_connectivity(made.data) == hidden_connectivity(base.data)) {
      made.origin.path = base.origin.path;
    }
  } else if (auto* components = std::get_if<Components>(&made.data)) {
    const int count = components->count();
    components->options = std::get<Components>(base.data).options;
    components->options.count = count;
  } else if (auto* track = std::get_if<LandmarkTrack>(&made.data)) {
    if (track->frames() != std::get<LandmarkTrack>(base.data).frames()) return;
    made.origin = base.origin;
  } else if (auto* regions = std::get_if<RegionData>(&made.data)) {
    const FieldSequence& shown = std::get<RegionData>(base.data).fields;
    if (regions->faces != shown.frames->shared_connectivity()) return;
    regions->fields = {shown.frames, fields_of(regions->regions), shown.displacement};
  }
}

NamedData checked(mimetra_kind kind, const std::string& name, GivenArrays& given,
                  const Base& base) {
  NamedData made{name, data_of(kind, given, base)};
  given.check_all_used(shown_only(kind, given));
  made.origin.notes = notes_on(made, given.subject());
  return made;
}

}  // namespace

DataKind kind_of(mimetra_kind kind) {
  static_assert(std::variant_size_v<Data> == MIMETRA_DOCUMENT, "mimetra.h lists all kinds");
  if (kind >= MIMETRA_SEQUENCE && kind <= MIMETRA_DOCUMENT) {
    return static_cast<DataKind>(kind - MIMETRA_SEQUENCE);
  }
  throw UsageError("the kind " + std::to_string(kind) + " is none of mimetra.h");
}

NamedData made_data(mimetra_kind kind, const std::string& name,
                    const mimetra_array* const* arrays) {
  if (!is_line(name)) throw UsageError("the value's name is no line of UTF-8");
  GivenArrays given(subject_of(kind, name), arrays);
  return checked(kind, name, given, nullptr);
}

NamedData derived_data(const NamedData& base, const mimetra_array* const* arrays) {
  const auto kind = static_cast<mimetra_kind>(base.data.index()) + MIMETRA_SEQUENCE;
  const std::string subject = subject_of(kind, base.name);
  const GivenArrays changes(subject, arrays);
  const bool new_faces =
      std::ranges::any_of(face_names(), [&](const std::string& name) { return changes.has(name); });
  const Base connectivity = new_faces ? nullptr : hidden_connectivity(base.data);

  const ShownArrays shown(base.data);
  std::vector<const mimetra_array*> all;
  for (const mimetra_array& array : shown.arrays()) {
    const bool is_face = (new_faces || connectivity) && array.location == MIMETRA_NOWHERE &&
                         face_names().contains(array.name);
    const bool is_changed = std::ranges::any_of(
        changes.all(), [&](const mimetra_array& other) { return is_same_place(array, other); });
    // Weights belong to the regions that they came with.
    const bool is_old_weight =
        kind == MIMETRA_REGIONS && changes.has("masks") && std::string_view(array.name) == "weight";
    if (!is_face && !is_changed && !is_old_weight) all.push_back(&array);
  }
  for (const mimetra_array& array : changes.all()) all.push_back(&array);
  all.push_back(nullptr);
  GivenArrays given(subject, all.data());
  NamedData made = checked(kind, base.name, given, connectivity);
  keep_hidden(base, made);
  return made;
}

}  // namespace mimetra
