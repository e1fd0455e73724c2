#include "toolkit/operations/match_parameters.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/rules_file.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/heads.h"
#include "toolkit/operations/pipeline_parameters.h"

namespace mimetra {

namespace {

struct MatchCall {
  /// Of the vertices in marker files.
  int index_base = 0;

  static constexpr Option kIndexBase{
      "index_base", &MatchCall::index_base, {.minimum = 0, .maximum = 1}};
};

/// `words` stand for no file, the first as a default.
Parameter several(std::string name, std::string help, std::vector<std::string> words = {}) {
  Parameter parameter{std::move(name), ParameterKind::file, {}, std::move(help)};
  parameter.several = true;
  if (!words.empty()) parameter.fallback = words.front();
  parameter.choices = std::move(words);
  return parameter;
}

/// What stands for files of --markers and --rules.
constexpr std::string_view kAuto = "auto";
constexpr std::string_view kNone = "none";

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

/// "12 expressions, 3 groups that exclude each other and 1 pair".
std::string summary_of(const WeightRules& rules) {
  const auto counted = [](std::size_t count, const std::string& one, const std::string& more) {
    return std::to_string(count) + " " + (count == 1 ? one : more);
  };
  return counted(rules.expressions.size(), "expression", "expressions") + ", " +
         counted(rules.exclusive.size(), "group that exclude each other",
                 "groups that exclude each other") +
         " and " + counted(rules.pairs.size(), "pair", "pairs");
}

/// The rules of each target, read even where they do not act.
std::vector<WeightRules> rules_of(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  const auto files = file_of_each(parameters, "rules", targets.size());
  std::vector<WeightRules> rules(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (!files.empty()) {
      rules[t] = read_rules(files[t]);
      continue;
    }
    const BlendshapeModel& model = std::get<ModelData>(targets[t].data).model.average();
    if (parameters.text("rules") == kNone || solves_for_vertices(parameters, model)) continue;
    const auto found = rules_beside(targets[t].origin.path);
    if (!found) continue;
    rules[t] = read_rules(*found);
    invocation.warn(targets[t].name + ": takes the rules in its folder (" + summary_of(rules[t]) +
                    "); --rules none leaves them out");
  }
  return rules;
}

/// Options of weights are refused where no target has any, and said to leave out those that have
/// none.
void check_weight_options(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  std::vector<std::string> without;
  for (const NamedData& target : targets) {
    const BlendshapeModel& model = std::get<ModelData>(target.data).model.average();
    if (solves_for_vertices(parameters, model)) without.push_back(target.name);
  }
  if (without.empty()) return;
  for (const std::string name : {"ridge", "l1", "symmetry", "exclusive", "rules"}) {
    const ParameterValue& value = parameters.value(name);
    const bool is_asked_for = value != parameters.find(name)->fallback &&
                              (name != "rules" || parameters.text(name) != kNone);
    if (!is_asked_for) continue;
    const std::string verb = without.size() == 1 ? " is" : " are";
    const std::string message = "--" + name + ": " + joined(without, ", ", " and ") + verb +
                                " solved for vertices, not weights";
    if (without.size() == targets.size()) throw UsageError(message);
    invocation.warn(message + "; it does not act there");
  }
}

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
          {std::string(kAuto)}),
      several(
          "correspondence",
          "the same by pairs of triangles that an earlier run found and wrote beside its output"),
      several("rules",
              "what is known of the target's expressions, as JSON: pairs, groups that exclude each "
              "other, limits, gains and offsets; one file for all targets, or one for each between "
              "commas; auto: rules.json in a model's folder",
              {std::string(kAuto), std::string(kNone)})};
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
  std::vector<WeightRules> rules = rules_of(invocation);
  check_weight_options(invocation);
  const FrameSource& source = *invocation.get<FieldSequence>("source").frames;
  const MarkersTo markers_to(invocation);
  std::vector<Target> targets;
  for (std::size_t t = 0; t < given.size(); ++t) {
    const BlendshapeModel& model = std::get<ModelData>(given[t].data).model.average();
    targets.push_back({given[t].name, model});
    Target& target = targets.back();
    target.rules = std::move(rules[t]);
    if (!markers.empty()) {
      std::vector<Marker> read = read_markers(markers[t], parameters.integer("index-base"));
      if (same_faces(source.connectivity(), model.connectivity())) {
        invocation.warn(given[t].name + ": has the source's faces; markers are left out");
      } else {
        target.match = std::move(read);
      }
    }
    if (markers.empty() && pairs.empty()) target.match = markers_to(given[t]);
    if (!pairs.empty()) {
      target.match = read_correspondence(pairs[t], source.connectivity(), model.connectivity());
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
