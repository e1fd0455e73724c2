#include "toolkit/io/regions_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/painting_file.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

using Lists = std::vector<std::vector<VertexIndex>>;

constexpr const char* kJsonForm =
    R"({"regions": [{"vertices": [...]}]}, beside them "weights": [...] of a soft border)";

/// Checks a vertex index of a mesh of `vertices` before narrowing it, so that 2^32 is not vertex 0.
VertexIndex vertex_of(const std::string& path, long long number, int vertices) {
  if (number >= 0 && number < vertices) return static_cast<VertexIndex>(number);
  throw MismatchError(path + ": vertex " + std::to_string(number) +
                      "; the mesh has vertices 0 to " + std::to_string(vertices - 1));
}

std::vector<VertexIndex> vertices_of(const std::string& path, const Json& entry, int vertices) {
  const Json& list = entry.is_object() ? entry.at("vertices") : entry;
  if (!list.is_array())
    throw IoError(path, "expected a list of vertices, found " + short_text(list));
  std::vector<VertexIndex> result;
  for (const Json& number : list) {
    if (!number.is_number_integer()) {
      throw IoError(path, "expected a vertex index, found " + short_text(number));
    }
    result.push_back(vertex_of(path, number.get<long long>(), vertices));
  }
  return result;
}

/// Radius of a region. JSON has no infinity, so null is the radius of a region with unreachable
/// vertices.
double radius_of(const Json& entry) {
  if (!entry.contains("radius")) return 0;
  const Json& radius = entry.at("radius");
  return radius.is_null() ? std::numeric_limits<double>::infinity() : radius.get<double>();
}

/// Share of the motion energy. Unknown shares are null in the file and 0 here.
double share_of(const Json& entry) {
  const Json share = entry.value("energy_share", Json(nullptr));
  return share.is_null() ? 0 : share.get<double>();
}

/// Integer member. Throws IoError for fractions and other numbers that are not integers.
long long integer_of(const std::string& path, const Json& entry, const char* key,
                     long long fallback) {
  const Json value = entry.value(key, Json(fallback));
  if (value.is_number_integer()) return value.get<long long>();
  throw IoError(path,
                std::string("\"") + key + "\": expected an integer, found " + short_text(value));
}

void read_details(const std::string& path, const Json& entry, int vertices, Region& region) {
  if (!entry.is_object()) return;
  const long long center = integer_of(path, entry, "center", -1);
  if (center != -1) region.center = vertex_of(path, center, vertices);
  const long long component = integer_of(path, entry, "component", region.component);
  if (std::in_range<int>(component)) region.component = static_cast<int>(component);
  region.radius = radius_of(entry);
  region.energy = entry.value("energy", region.energy);
  region.energy_share = share_of(entry);
  region.added_for = entry.value("added_for", region.added_for);
}

/// Throws MismatchError for regions of another mesh, whose indices could fit by chance.
void check_mesh(const std::string& path, const Json& json, int vertices) {
  const long long stated = integer_of(path, json, "mesh_vertices", vertices);
  if (stated == vertices) return;
  throw MismatchError(path + ": regions of a mesh of " + std::to_string(stated) +
                      " vertices, expected " + std::to_string(vertices));
}

Eigen::VectorXd weights_of(const std::string& path, const Json& list, int vertices) {
  const std::string place = path + ": \"weights\"";
  if (!list.is_array()) {
    throw IoError(place, "expected a number for each vertex, found " + short_text(list));
  }
  if (list.size() != static_cast<std::size_t>(vertices)) {
    throw MismatchError(place + " of " + std::to_string(list.size()) + " vertices, expected " +
                        std::to_string(vertices));
  }
  Eigen::VectorXd weights(vertices);
  for (int v = 0; v < vertices; ++v) {
    const Json& weight = list[static_cast<std::size_t>(v)];
    if (!weight.is_number()) {
      throw IoError(place, "vertex " + std::to_string(v) + ": expected a number, found " +
                               short_text(weight));
    }
    weights[v] = weight.get<double>();
  }
  check_painting(place, weights);
  return weights;
}

Regions regions_of_json(const std::string& path, const std::string& text, int vertices,
                        const Triangles& triangles) {
  try {
    const Json json = parse_json(path, text, kJsonForm);
    if (json.is_object()) check_mesh(path, json, vertices);
    const Json& entries = json.is_object() ? json.at("regions") : json;
    if (!entries.is_array()) throw IoError(path, "expected a list of regions");
    Lists lists;
    for (const Json& entry : entries) lists.push_back(vertices_of(path, entry, vertices));
    if (lists.empty()) throw IoError(path, "holds no region");
    Regions regions = regions_from_vertices(vertices, triangles, lists);
    for (std::size_t k = 0; k < lists.size(); ++k) {
      read_details(path, entries[k], vertices, regions.regions[k]);
    }
    if (json.contains("weights")) {
      const Eigen::VectorXd weights = weights_of(path, json.at("weights"), vertices);
      regions = with_weights(std::move(regions), weights, triangles);
    }
    if (json.is_object()) regions.energy_share = share_of(json);
    return regions;
  } catch (const Json::exception& error) {
    throw IoError(path, std::string("expected ") + kJsonForm + ": " + json_reason(error));
  }
}

Lists read_csv(const std::string& path, std::string text, int vertices) {
  std::ranges::replace(text, ',', ' ');
  TextCursor cursor(path, without_byte_order_mark(text), {.comments = true});
  if (cursor.word() != "vertex" || cursor.word() != "region" || !cursor.word().empty()) {
    cursor.fail("expected the columns vertex,region");
  }
  std::map<long long, std::vector<VertexIndex>> lists;
  for (auto word = cursor.word_anywhere(); !word.empty(); word = cursor.word_anywhere()) {
    const auto vertex = cursor.integer(word, "a vertex");
    const auto region = cursor.integer(cursor.word(), "a region");
    if (region < 0) cursor.fail("regions are numbered from 0, found " + std::to_string(region));
    if (!cursor.word().empty()) cursor.fail("expected two columns, vertex,region");
    lists[region].push_back(vertex_of(path, vertex, vertices));
  }
  if (lists.empty()) throw IoError(path, "holds no region");
  Lists result;
  for (auto& [region, list] : lists) result.push_back(std::move(list));
  return result;
}

bool is_mask(const std::vector<long long>& numbers) {
  // A list of vertices has 0 and 1 at most once each.
  return numbers.size() > 2 &&
         std::ranges::all_of(numbers, [](long long value) { return value == 0 || value == 1; });
}

/// Reads one vertex a line, or a mask of N zeros and ones.
Lists read_list(const std::string& path, const std::string& text, int vertices) {
  TextCursor cursor(path, without_byte_order_mark(text), {.comments = true});
  std::vector<long long> numbers;
  for (auto word = cursor.word_anywhere(); !word.empty(); word = cursor.word_anywhere()) {
    numbers.push_back(cursor.integer(word, "a vertex"));
  }
  if (numbers.empty()) throw IoError(path, "holds no vertex");
  std::vector<VertexIndex> list;
  if (!is_mask(numbers)) {
    for (const long long number : numbers) list.push_back(vertex_of(path, number, vertices));
    return {list};
  }
  if (numbers.size() != static_cast<std::size_t>(vertices)) {
    throw MismatchError(path + ": a mask of " + std::to_string(numbers.size()) +
                        " vertices, expected " + std::to_string(vertices));
  }
  for (int v = 0; v < vertices; ++v) {
    if (numbers[static_cast<std::size_t>(v)] == 1) list.push_back(v);
  }
  return {list};
}

Regions regions_of_om(const std::filesystem::path& path, int vertices, const Triangles& triangles) {
  const FieldsRead read = read_om_fields(path, read_mesh(path).connectivity);
  std::map<std::string, Eigen::MatrixXd> on_vertices;
  std::vector<std::string> known;
  for (const Field& field : read.fields) {
    if (field.location != Field::Location::vertices) continue;
    on_vertices.emplace(field.name, field.values);
    known.push_back(field.name);
  }
  const auto roi = on_vertices.find("roi"), weight = on_vertices.find("weight");
  if (roi == on_vertices.end()) {
    known.insert(known.end(), read.left_out.begin(), read.left_out.end());
    throw IoError(path.string(), "no field 'roi' of numbers on the vertices; it has " +
                                     (known.empty() ? "no properties" : joined(known)));
  }
  return region_of_mask(path.string(), roi->second,
                        weight == on_vertices.end() ? std::nullopt : std::optional(weight->second),
                        vertices, triangles);
}

}  // namespace

Regions region_of_mask(const std::string& name, const Eigen::MatrixXd& roi,
                       const std::optional<Eigen::MatrixXd>& weight, int vertices,
                       const Triangles& triangles) {
  const auto check_single = [&name](const std::string& field, const Eigen::MatrixXd& values) {
    if (values.cols() == 1) return;
    throw MismatchError(name + ": field '" + field + "' holds " + std::to_string(values.cols()) +
                        " numbers for each vertex, expected one");
  };
  check_single("roi", roi);
  if (roi.rows() != vertices) {
    throw MismatchError(name + ": " + std::to_string(roi.rows()) + " vertices, expected " +
                        std::to_string(vertices) + " as in the source");
  }
  std::vector<VertexIndex> inside;
  for (int v = 0; v < vertices; ++v) {
    if (!std::isfinite(roi(v, 0))) {
      throw IoError(name, "the field 'roi' of vertex " + std::to_string(v) + " is " +
                              std::to_string(roi(v, 0)) + ", expected 0 or 1");
    }
    if (roi(v, 0) != 0) inside.push_back(v);
  }
  Regions regions = regions_from_vertices(vertices, triangles, {inside});
  if (!weight) return regions;
  check_single("weight", *weight);
  check_painting(name + ": field 'weight'", weight->col(0));
  return with_weights(std::move(regions), weight->col(0), triangles);
}

Regions read_regions(const std::filesystem::path& path, int vertices, const Triangles& triangles) {
  const std::string name = path.string(), extension = lower_extension(path);
  if (extension == ".om") return regions_of_om(path, vertices, triangles);
  const std::string text = read_file(path);
  if (extension == ".json") return regions_of_json(name, text, vertices, triangles);
  if (extension == ".csv")
    return regions_from_vertices(vertices, triangles, read_csv(name, text, vertices));
  if (extension == ".txt") {
    return regions_from_vertices(vertices, triangles, read_list(name, text, vertices));
  }
  throw IoError(name, "expected a region set in .json, .csv, .txt or .om");
}

std::string regions_json(const Regions& regions) {
  const auto known = [&regions](double share) {
    return regions.energy_is_known() ? Json(share) : Json(nullptr);
  };
  Json list = Json::array();
  for (const Region& region : regions.regions) {
    list.push_back({{"component", region.component},
                    {"center", region.center},
                    {"radius", region.radius},
                    {"energy", region.energy},
                    {"energy_share", known(region.energy_share)}});
    if (!region.added_for.empty()) list.back()["added_for"] = region.added_for;
    list.back()["vertices"] = region.vertices;
  }
  Json json = {{"regions", list},
               {"mesh_vertices", regions.vertices},
               {"vertices", regions.vertex_count()},
               {"triangles", regions.triangles},
               {"vertex_share", regions.vertex_share()},
               {"triangle_share", regions.triangle_share()},
               {"energy_share", known(regions.energy_share)}};
  if (regions.weights.size() > 0) {
    json["weights"] = std::vector<double>(regions.weights.begin(), regions.weights.end());
  }
  return json_text(json, 1) + '\n';
}

std::string regions_csv(const Regions& regions) {
  std::string text = "vertex,region\n";
  for (std::size_t k = 0; k < regions.regions.size(); ++k) {
    for (const VertexIndex vertex : regions.regions[k].vertices) {
      text += std::to_string(vertex) + ',' + std::to_string(k) + '\n';
    }
  }
  return text;
}

}  // namespace mimetra
