#include "toolkit/operations/match_parameters.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "toolkit/formats/model_file.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/landmark_vertices.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/rules_file.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// Path from which a value was read; empty for a value that was made.
fs::path place_of(const NamedData& value) {
  if (!value.origin.path.empty()) return value.origin.path;
  std::error_code unreadable;
  return fs::exists(value.name, unreadable) ? fs::path(value.name) : fs::path();
}

LandmarkVertices landmarks_beside(const fs::path& place, int vertices, const Log& log) {
  std::vector<fs::path> files = landmark_mappings(place);
  // landmarks68.txt has priority over other files.
  std::stable_partition(files.begin(), files.end(),
                        [](const fs::path& file) { return file.filename() == "landmarks68.txt"; });
  if (files.empty()) return {};
  LandmarkVertices landmarks = ibug_landmarks(read_landmark_mapping(files.front()));
  const auto is_beyond = [vertices](const auto& each) { return each.second >= vertices; };
  const auto beyond = std::ranges::find_if(landmarks, is_beyond);
  if (beyond == landmarks.end()) return landmarks;
  if (log) {
    log(LogLevel::warning, files.front().string() + ": names vertex " +
                               std::to_string(beyond->second) + ", " + place.string() + " has " +
                               std::to_string(vertices) + "; it is of another mesh, and left out");
  }
  return {};
}

/// Rest pose of a sequence, or neutral of a model.
TriMesh rest_mesh(const NamedData& value) {
  if (const auto* sequence = std::get_if<FieldSequence>(&value.data)) {
    return {sequence->frames->rest(), sequence->frames->connectivity()};
  }
  const BlendshapeModel& model = person_of(value);
  return {model.neutral(), model.connectivity()};
}

}  // namespace

Head head_of(const NamedData& value, const Log& log, bool ignore_files) {
  Head head{value.name, rest_mesh(value)};
  const fs::path place = place_of(value);
  if (!ignore_files && !place.empty()) {
    head.known = landmarks_beside(place, static_cast<int>(head.mesh.positions.rows()), log);
  }
  return head;
}

namespace {

struct MatchCall {
  /// Number of the first vertex in marker files.
  int index_base = 0;
  /// Search for landmarks even if files beside both meshes name their vertices.
  bool ignore_files = false;

  static constexpr Option kIndexBase{
      "index_base", &MatchCall::index_base, {.minimum = 0, .maximum = 1}};
  static constexpr Option kIgnoreFiles{"ignore_files", &MatchCall::ignore_files};
};

/// Declares a parameter of several files. `words` may replace a file; the first is the default.
Parameter several(std::string name, std::string help, std::vector<std::string> words = {}) {
  Parameter parameter{std::move(name), ParameterKind::file, {}, std::move(help)};
  parameter.several = true;
  if (!words.empty()) parameter.fallback = words.front();
  parameter.choices = std::move(words);
  return parameter;
}

/// Words that replace files of --markers and --rules.
constexpr std::string_view kAuto = "auto";
constexpr std::string_view kNone = "none";

/// Returns a file or a word for each target. The first word is the default; the list is empty if
/// there are neither files nor words.
std::vector<std::string> named_for_each(const Parameters& parameters, const std::string& name,
                                        std::size_t targets) {
  const std::vector<std::string>& words = parameters.find(name)->choices;
  std::vector<std::string> named = parameters.listed(name);
  if (named.empty() && !words.empty()) named = {words.front()};
  if (named.size() == 1) named.resize(targets, named.front());
  if (named.empty() || named.size() == targets) return named;
  throw UsageError("--" + name + ": " + std::to_string(named.size()) + " files" +
                   (words.empty() ? "" : " or words (" + joined(words, ", ", " or ") + ")") +
                   ", expected one for all targets or one for each of " + std::to_string(targets) +
                   ", between commas");
}

/// Searches for markers from a call's source to its targets; searches the source's face only once.
class MarkersTo {
 public:
  MarkersTo(const Invocation& invocation, std::string source)
      : invocation_(invocation), source_(std::move(source)) {}

  MarkersBetween operator()(const NamedData& target) const {
    return [search = search_, &target, &invocation = invocation_, name = source_,
            ignore_files = ignore_files_](const TriMesh& source, const Context& context) {
      if (!*search) {
        Head head = head_of(invocation.input(name), invocation.log, ignore_files);
        head.mesh = source;
        search->emplace(std::move(head), invocation.landmark_finder);
      }
      return (**search)(head_of(target, invocation.log, ignore_files), context);
    };
  }

 private:
  const Invocation& invocation_;
  bool ignore_files_ = invocation_.parameters.flag("ignore-files");
  std::string source_;
  std::shared_ptr<std::optional<MarkerSearch>> search_ =
      std::make_shared<std::optional<MarkerSearch>>();
};

/// Describes rules: "12 expressions, 3 groups of some that exclude each other and 1 pair".
std::string summary_of(const WeightRules& rules) {
  return counted(std::ssize(rules.expressions), "expression") + ", " +
         counted(std::ssize(rules.exclusive), "group") + " of some that exclude each other and " +
         counted(std::ssize(rules.pairs), "pair");
}

/// Whether a target is solved without weights. Operations without the option --space solve for
/// weights if there are expressions.
bool has_no_weights(const Parameters& parameters, const BlendshapeModel& model) {
  if (parameters.find("space")) return solves_for_vertices(parameters, model);
  return model.expressions().size() == 0;
}

/// Reads the rules beside a target; empty if they would have no effect.
WeightRules found_rules(const Invocation& invocation, const NamedData& target) {
  const Parameters& parameters = invocation.parameters;
  if (has_no_weights(parameters, person_of(target))) return {};
  const auto found = rules_beside(target.origin.path);
  if (!found) return {};
  if (parameters.find("per-region") && parameters.flag("per-region")) {
    invocation.warn(target.name + ": weights of each region do not follow the rules in its folder");
    return {};
  }
  WeightRules rules = read_rules(*found);
  invocation.warn(target.name + ": takes the rules in its folder (" + summary_of(rules) +
                  "); --rules none leaves them out");
  return rules;
}

/// Reads the rules of each target, even if they have no effect.
std::vector<WeightRules> rules_of(const Invocation& invocation) {
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  const auto named = named_for_each(invocation.parameters, "rules", targets.size());
  std::vector<WeightRules> rules;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (named[t] == kNone) {
      rules.emplace_back();
    } else {
      rules.push_back(named[t] == kAuto ? found_rules(invocation, targets[t])
                                        : read_rules(named[t]));
    }
  }
  return rules;
}

/// Number of targets for which an option of weights is set, and the targets on which it has no
/// effect.
struct WeightOptionTargets {
  std::size_t asked = 0;
  std::vector<std::string> without = {};
};

WeightOptionTargets targets_with(const Invocation& invocation, const std::string& option) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& targets = invocation.inputs.at("target");
  const bool is_set = parameters.value(option) != parameters.find(option)->fallback;
  const auto rules = named_for_each(parameters, "rules", targets.size());
  WeightOptionTargets found;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const bool has_file = rules[t] != kAuto && rules[t] != kNone;
    if (option == "rules" ? !has_file : !is_set) continue;
    ++found.asked;
    if (has_no_weights(parameters, person_of(targets[t]))) found.without.push_back(targets[t].name);
  }
  return found;
}

/// Refuses an option of weights if none of its targets has weights. Warns if some targets have
/// none.
void check_weight_options(const Invocation& invocation) {
  for (const std::string name : {"ridge", "l1", "symmetry", "exclusive", "rules"}) {
    const auto [asked, without] = targets_with(invocation, name);
    if (without.empty()) continue;
    const std::string verb = without.size() == 1 ? " is" : " are";
    const std::string message = "--" + name + ": " + joined(without, ", ", " and ") + verb +
                                " solved for vertices, not weights";
    if (without.size() == asked) throw UsageError(message);
    invocation.warn(message + "; it does not act there");
  }
}

/// Pairs one target with the source by the markers of a file.
void take_markers(const Invocation& invocation, const TriMesh& source, const std::string& file,
                  Target& target) {
  MarkerFile read = read_marker_file(file, invocation.parameters.integer("index-base"));
  if (has_faces_of(source, target.model)) {
    invocation.warn(target.name + ": has the source's faces; markers are left out");
    return;
  }
  for (const int line : read.lines) {
    target.marker_places.push_back(file + ", line " + std::to_string(line));
  }
  target.match = std::move(read.markers);
}

}  // namespace

std::vector<Parameter> pairing_parameters() {
  BoundParameters<MatchCall> list;
  list.add("index-base", MatchCall::kIndexBase, "the first vertex in --markers is called 0 or 1")
      .add("ignore-files", MatchCall::kIgnoreFiles,
           "--markers auto: look for landmarks also where files landmarks68.txt beside both meshes "
           "name them");
  std::vector<Parameter> parameters = {
      several(
          "markers",
          "for a target of other faces: pairs of vertices, source and target, that are the same "
          "point of a face; one file for all targets, or one for each between commas; auto, also "
          "between these: landmarks that are found in drawings of both, or that a landmarks68.txt "
          "beside both names",
          {std::string(kAuto)}),
      several(
          "correspondence",
          "the same by pairs of triangles that an earlier run found and wrote beside its output")};
  const std::vector<Parameter> more = list.declared();
  parameters.insert(parameters.begin() + 1, more.begin(), more.end());
  for (Parameter& parameter : parameters) parameter.group = "Targets of other faces";
  parameters.front().brief = "pairs of vertices that are the same point of a face";
  return parameters;
}

std::vector<Parameter> match_parameters() {
  std::vector<Parameter> parameters = pairing_parameters();
  parameters.push_back(
      several("rules",
              "what is known of the target's expressions, as JSON: pairs, groups that exclude each "
              "other, limits, gains and offsets; one file for all targets, or one for each between "
              "commas, also auto (rules.json in a model's folder) or none",
              {std::string(kAuto), std::string(kNone)}));
  parameters.back().group = kSolvingGroup;
  return parameters;
}

std::vector<Exclusion> pairing_exclusions() {
  return {{{"markers"},
           {"correspondence"},
           "--correspondence tells what belongs together, too; leave one of them out"},
          {{"index-base"}, {"!markers"}, "there are no vertices to count without --markers"}};
}

std::vector<Target> targets_of(const Invocation& invocation, const std::string& source_name) {
  const Parameters& parameters = invocation.parameters;
  const std::vector<NamedData>& given = invocation.inputs.at("target");
  const auto markers = named_for_each(parameters, "markers", given.size());
  const auto pairs = named_for_each(parameters, "correspondence", given.size());
  std::vector<WeightRules> rules(given.size());
  if (parameters.find("rules")) {
    rules = rules_of(invocation);
    check_weight_options(invocation);
  }
  const bool looks = pairs.empty() && std::ranges::find(markers, kAuto) != markers.end();
  if (parameters.flag("ignore-files") && !looks) {
    throw UsageError("--ignore-files: nothing is looked for with --markers or --correspondence");
  }
  const TriMesh source = rest_mesh(invocation.input(source_name));
  const MarkersTo markers_to(invocation, source_name);
  std::vector<Target> targets;
  for (std::size_t t = 0; t < given.size(); ++t) {
    const BlendshapeModel& model = person_of(given[t]);
    targets.push_back({given[t].name, model});
    Target& target = targets.back();
    target.rules = std::move(rules[t]);
    if (!pairs.empty()) {
      target.match = read_correspondence(pairs[t], source.connectivity, model.connectivity());
    } else if (markers[t] == kAuto) {
      target.match = markers_to(given[t]);
    } else {
      take_markers(invocation, source, markers[t], target);
    }
  }
  return targets;
}

void check_targets(const Invocation& invocation, const std::vector<Target>& targets,
                   const FrameSource& source, const SolveOptions& options) {
  const TriMesh from{source.rest(), source.connectivity()};
  const Context context = invocation.context.part(0, 0).without_ranks();
  in_command_terms(invocation.parameters, [&] {
    for (const Target& target : targets) {
      check_rules(target, options);
      const BlendshapeModel& model = target.model;
      const TriMesh to{model.neutral(), model.connectivity()};
      if (const auto* markers = std::get_if<std::vector<Marker>>(&target.match)) {
        check_given_markers(*markers, target.marker_places, from, to, target.name, context);
        continue;
      }
      const bool is_drawn = std::holds_alternative<MarkersBetween>(target.match) &&
                            invocation.landmark_finder && is_to_be_paired(source, target);
      if (!is_drawn) {
        MatchedTarget(source, target, {}, context);
      } else {
        invocation.info(target.name + ": has other faces; markers will be looked for");
      }
    }
  });
}

}  // namespace mimetra
