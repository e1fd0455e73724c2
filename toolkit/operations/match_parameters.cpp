#include "toolkit/operations/match_parameters.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/heads.h"

namespace mimetra {

namespace {

struct MatchCall {
  /// Of the vertices in marker files.
  int index_base = 0;

  static constexpr Option kIndexBase{
      "index_base", &MatchCall::index_base, {.minimum = 0, .maximum = 1}};
};

/// `word` stands for no file, as a default.
Parameter several(std::string name, std::string help, const std::string& word = "") {
  Parameter parameter{std::move(name), ParameterKind::file, {}, std::move(help)};
  parameter.several = true;
  if (!word.empty()) {
    parameter.choices = {word};
    parameter.fallback = word;
  }
  return parameter;
}

/// The file of each target; none where none is named.
std::vector<std::string> file_of_each(const Parameters& parameters, const std::string& name,
                                      std::size_t targets) {
  std::vector<std::string> files = parameters.paths(name);
  if (files.size() == 1) files.resize(targets, files.front());
  if (files.empty() || files.size() == targets) return files;
  throw UsageError("--" + name + ": " + std::to_string(files.size()) +
                   " files, expected one for all targets or one for each of " +
                   std::to_string(targets) + ", between commas");
}

/// Of a sequence or a model.
const Connectivity& faces_of(const Data& data) {
  if (const auto* sequence = std::get_if<FieldSequence>(&data)) {
    return sequence->frames->connectivity();
  }
  return std::get<ModelData>(data).model.connectivity();
}

/// Looks for markers from a call's source to its targets; the source's face is looked for once.
class MarkersTo {
 public:
  explicit MarkersTo(const Invocation& invocation) : invocation_(invocation) {}

  MarkersBetween operator()(const NamedData& target) const {
    return [search = search_, &target, &invocation = invocation_](const TriMesh& source) {
      if (!*search) {
        Head head = head_of(invocation.input("source"), invocation.log);
        head.mesh = source;
        search->emplace(std::move(head), invocation.landmark_finder,
                        FaceSearchOptions{.threads = invocation.threads});
      }
      return (**search)(head_of(target, invocation.log));
    };
  }

 private:
  const Invocation& invocation_;
  std::shared_ptr<std::optional<MarkerSearch>> search_ =
      std::make_shared<std::optional<MarkerSearch>>();
};

}  // namespace

std::vector<Parameter> match_parameters() {
  BoundParameters<MatchCall> list;
  list.add("index-base", MatchCall::kIndexBase, "the first vertex in --markers is called 0 or 1");
  std::vector<Parameter> parameters = {
      several(
          "markers",
          "for a target of other faces: pairs of vertices, source and target, that are the same "
          "point of a face; one file for all targets, or one for each between commas; auto: "
          "landmarks that are found in drawings of both, or that a landmarks68.txt beside both "
          "names",
          "auto"),
      several(
          "correspondence",
          "the same by pairs of triangles that an earlier run found and wrote beside its output")};
  const std::vector<Parameter> more = list.declared();
  parameters.insert(parameters.begin() + 1, more.begin(), more.end());
  return parameters;
}

std::vector<Target> targets_of(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& given = invocation.inputs.at("target");
  const auto markers = file_of_each(parameters, "markers", given.size());
  const auto pairs = file_of_each(parameters, "correspondence", given.size());
  if (!markers.empty() && !pairs.empty()) {
    throw UsageError(
        "--markers and --correspondence: only one of them tells what belongs together");
  }
  if (markers.empty() && parameters.is_set("index-base")) {
    throw UsageError("--index-base: there are no vertices to count without --markers");
  }
  const Connectivity& source = faces_of(invocation.input("source").data);
  const MarkersTo markers_to(invocation);
  std::vector<Target> targets;
  for (std::size_t t = 0; t < given.size(); ++t) {
    const BlendshapeModel& model = std::get<ModelData>(given[t].data).model.average();
    Target& target = targets.emplace_back(given[t].name, model);
    if (!markers.empty()) {
      std::vector<Marker> read = read_markers(markers[t], parameters.integer("index-base"));
      if (same_faces(source, model.connectivity())) {
        invocation.warn(given[t].name + ": has the source's faces; markers are left out");
      } else {
        target.match = std::move(read);
      }
    }
    if (markers.empty() && pairs.empty()) target.match = markers_to(given[t]);
    if (!pairs.empty()) {
      target.match = read_correspondence(pairs[t], source, model.connectivity());
    }
  }
  return targets;
}

Json json_of(const MatchReport& match) {
  const CorrespondenceQuality& quality = match.quality;
  Json json = {{"verdict", quality.verdict()},
               {"without_partner", quality.without_partner},
               {"mean_residual", quality.mean_residual},
               {"largest_residual", quality.largest_residual},
               {"seconds", match.seconds}};
  if (match.markers > 0) {
    json["markers"] = match.markers;
    json["markers_found"] = match.found.has_value();
    json["folded"] = quality.folded;
  }
  return json;
}

Json json_of(const std::vector<ComparedOpening>& openings) {
  Json list = Json::array();
  for (const ComparedOpening& opening : openings) {
    list.push_back({{"name", opening.name},
                    {"source", {opening.source_least, opening.source_most}},
                    {"target", {opening.target_least, opening.target_most}},
                    {"mean_difference", opening.difference}});
  }
  return list;
}

std::string summary_of(const std::vector<ComparedOpening>& openings) {
  std::vector<std::string> parts;
  for (const ComparedOpening& opening : openings) {
    parts.push_back(std::string(opening.name) + ' ' + percent(opening.source_least) + " to " +
                    percent(opening.source_most) + " on the source, " +
                    percent(opening.target_least) + " to " + percent(opening.target_most) +
                    " here");
  }
  return parts.empty() ? "" : "  open, of their width: " + joined(parts, "; ", "; ") + '\n';
}

std::string summary_of(const MatchReport& match) {
  const std::string verdict = match.quality.verdict();
  return (match.found ? std::to_string(match.markers) + " markers found, " : "") +
         "correspondence " + verdict.substr(0, verdict.find(':')) + ", " +
         percent(1 - match.quality.without_partner) + " of the triangles paired, " +
         readable(match.seconds) + " s";
}

std::vector<Field> fields_of(const Correspondence& pairs) {
  const int triangles = pairs.target_triangles();
  Field residual{"match_residual", Field::Location::triangles, Eigen::MatrixXd(triangles, 1)};
  Field partners{"match_partners", Field::Location::triangles, Eigen::MatrixXd(triangles, 1), true};
  for (int t = 0; t < triangles; ++t) {
    residual.values(t, 0) = std::isfinite(pairs.residuals[t]) ? pairs.residuals[t] : 0;
    partners.values(t, 0) = pairs.offsets[t + 1] - pairs.offsets[t];
  }
  return {residual, partners};
}

}  // namespace mimetra
