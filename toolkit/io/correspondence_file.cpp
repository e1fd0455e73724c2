#include "toolkit/io/correspondence_file.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

constexpr const char* kCorrespondenceForm =
    R"({"source": {..}, "target": {..}, "partners": [[triangle, weight, ..], ..]})";

/// Allowed difference between 1 and the sum of a triangle's weights, for files written by hand with
/// a few digits.
constexpr double kWeightTolerance = 1e-3;

/// Returns a hash of the number of vertices and the corners of all triangles, as hexadecimal digits
/// (FNV-1a, 64 bits). It is the same on every machine.
std::string faces_hash(const Connectivity& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&hash](int number) {
    for (int byte = 0; byte < 4; ++byte) {
      hash = (hash ^ ((static_cast<std::uint32_t>(number) >> (8 * byte)) & 0xff)) * 0x100000001b3U;
    }
  };
  add(mesh.vertices);
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) add(mesh.triangles.data()[i]);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(hash >> shift) & 15];
  return text;
}

Json mesh_json(const Connectivity& mesh) {
  return {{"vertices", mesh.vertices},
          {"triangles", mesh.triangles.rows()},
          {"faces", faces_hash(mesh)}};
}

void check_made_for(const std::string& path, const Json& json, const char* name,
                    const Connectivity& mesh) {
  const Json& stated = json.at(name);
  if (stated.at("faces") == faces_hash(mesh)) return;
  throw MismatchError(path + ": made for a " + name + " of " + short_text(stated.at("vertices")) +
                      " vertices and " + short_text(stated.at("triangles")) +
                      " triangles with other faces than this one, of " +
                      std::to_string(mesh.vertices) + " and " +
                      std::to_string(mesh.triangles.rows()));
}

Correspondence::Part part_of_json(const std::string& path, const Json& triangle, const Json& weight,
                                  int source_triangles) {
  if (!triangle.is_number_integer() || !weight.is_number()) {
    throw IoError(path, "expected a triangle and its weight, found " + short_text(triangle) +
                            " and " + short_text(weight));
  }
  const auto number = triangle.get<long long>();
  if (number < 0 || number >= source_triangles) {
    throw IoError(path, "triangle " + std::to_string(number) + "; the source has triangles 0 to " +
                            std::to_string(source_triangles - 1));
  }
  const auto share = weight.get<double>();
  if (!(share > 0) || share > 1 + kWeightTolerance) {
    throw IoError(path, "weight " + short_text(weight) + ", expected one above 0 and up to 1");
  }
  return {static_cast<int>(number), share};
}

void add_partners(const std::string& path, const Json& partners, Correspondence& pairs) {
  if (!partners.is_array() || partners.size() % 2 != 0) {
    throw IoError(path, "expected a list of triangles and weights, found " + short_text(partners));
  }
  double sum = 0;
  for (std::size_t i = 0; i < partners.size(); i += 2) {
    const auto part = part_of_json(path, partners[i], partners[i + 1], pairs.source_triangles);
    if (i > 0 && part.triangle <= pairs.parts.back().triangle) {
      throw IoError(path, "triangle " + std::to_string(part.triangle) + " comes after " +
                              std::to_string(pairs.parts.back().triangle) +
                              ", expected ascending ones");
    }
    pairs.parts.push_back(part);
    sum += part.weight;
  }
  if (!partners.empty() && std::abs(sum - 1) > kWeightTolerance) {
    throw IoError(path, "the weights of target triangle " +
                            std::to_string(pairs.target_triangles()) + " add up to " +
                            short_text(Json(sum)) + ", expected 1");
  }
  pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
}

double residual_of(const std::string& path, const Json& value) {
  if (value.is_null()) return std::numeric_limits<double>::infinity();
  if (value.is_number() && value.get<double>() >= 0) return value.get<double>();
  throw IoError(path,
                "expected a distance, or null where there is none, found " + short_text(value));
}

}  // namespace

std::string correspondence_json(const Correspondence& pairs, const Connectivity& source,
                                const Connectivity& target) {
  Json partners = Json::array(), residuals = Json::array();
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    Json of_triangle = Json::array();
    for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
      of_triangle.push_back(pairs.parts[p].triangle);
      of_triangle.push_back(pairs.parts[p].weight);
    }
    partners.push_back(std::move(of_triangle));
    // JSON has no infinity.
    residuals.push_back(std::isfinite(pairs.residuals[t]) ? Json(pairs.residuals[t]) : Json());
  }
  return json_text(Json{{"source", mesh_json(source)},
                        {"target", mesh_json(target)},
                        {"partners", std::move(partners)},
                        {"residuals", std::move(residuals)}}) +
         '\n';
}

Correspondence read_correspondence(const std::filesystem::path& path, const Connectivity& source,
                                   const Connectivity& target) {
  const std::string name = path.string();
  try {
    const Json json = read_json(path, kCorrespondenceForm);
    check_made_for(name, json, "source", source);
    check_made_for(name, json, "target", target);
    const Json &partners = json.at("partners"), &residuals = json.at("residuals");
    const auto triangles = static_cast<std::size_t>(target.triangles.rows());
    if (partners.size() != triangles || residuals.size() != triangles) {
      throw IoError(name, std::to_string(partners.size()) + " partners and " +
                              std::to_string(residuals.size()) + " residuals, expected " +
                              std::to_string(triangles));
    }
    Correspondence pairs;
    pairs.source_triangles = static_cast<int>(source.triangles.rows());
    pairs.residuals.resize(static_cast<Eigen::Index>(triangles));
    for (std::size_t t = 0; t < triangles; ++t) {
      add_partners(name, partners.at(t), pairs);
      pairs.residuals[static_cast<Eigen::Index>(t)] = residual_of(name, residuals.at(t));
    }
    return pairs;
  } catch (const Json::exception& error) {
    throw IoError(name, std::string("expected ") + kCorrespondenceForm + ": " + json_reason(error));
  }
}

}  // namespace mimetra
