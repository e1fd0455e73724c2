#include "toolkit/operations/pipeline_parameters.h"

#include <algorithm>
#include <array>

#include "toolkit/operations/option_words.h"
#include "toolkit/operations/parameter_files.h"
#include "toolkit/operations/this_process.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

constexpr const char* kDecompositionGroup = "Decomposition";
constexpr const char* kSourceGroup = "Rest pose and head motion";

/// Words that replace the number of an anchor vertex.
enum class AnchorWord { source, centroid };

constexpr std::string_view choice_name(AnchorWord value) {
  switch (value) {
    case AnchorWord::source:
      return "source";
    case AnchorWord::centroid:
      return "centroid";
  }
  return {};
}

/// Sets an anchor only if the user gives one. If fixed vertices hold the mesh, the default has no
/// effect, but a given anchor is refused.
void apply_anchor(const Parameters& parameters, SolveOptions& options) {
  if (!parameters.is_set("anchor")) return;
  const std::string& text = parameters.text("anchor");
  if (const auto word = choice_of<AnchorWord>(text)) {
    switch (*word) {
      case AnchorWord::source:
        options.anchor = Anchor::source_motion;
        return;
      case AnchorWord::centroid:
        options.anchor = Anchor::centroid;
        return;
    }
  }
  const Parameter vertex{"anchor", ParameterKind::integer, {}, "", "", 0};
  options.anchor = Anchor::vertex;
  options.anchor_vertex =
      static_cast<VertexIndex>(std::get<std::int64_t>(parse_value(vertex, text)));
}

Positions rest_in(const std::string& path, const FieldSequence* sequence) {
  return sequence ? read_rest(path, *sequence->frames) : Positions();
}

std::vector<RigidTransform> motion_in(const std::string& path, const FieldSequence* sequence) {
  if (!sequence) return {};
  return read_motion(path, sequence->frames->frames()).transforms;
}

BoundParameters<SourceOptions> rest_named(const std::string& name, const std::string& what) {
  BoundParameters<SourceOptions> list;
  list.add_word_or_file<SourceRest, Positions>(
      name, SourceOptions::kRest,
      what + "; default the neutral where it is known, else the first frame", rest_in);
  return list.under(kSourceGroup);
}

BoundParameters<AnalysisOptions> decomposition_parameters() {
  using Options = AnalysisOptions;
  BoundParameters<Options> list;
  list.add("sparsity", Options::kSparsity, "weight lambda of the sparsity term")
      .add("rho", Options::kRho, "penalty of ADMM")
      .add("iterations", Options::kIterations,
           "outer iterations at most; default " +
               std::to_string(DecompositionOptions::kUsualIterations) + ", with --compat " +
               std::to_string(DecompositionOptions::kReferenceIterations))
      .add("admm-iterations", Options::kAdmmIterations, "ADMM steps in each")
      .add("tolerance", Options::kTolerance,
           "stop when the energy changes by at most this share three times in a row; 0 runs all "
           "iterations")
      .add_opposite("signed", Options::kNonnegative, "allow negative weights")
      .add("precision", Options::kPrecision,
           "of the iterations; single moves components by about 1e-6 of themselves")
      .add("basis-tolerance", Options::kBasisTolerance,
           "iterate on as few poses over time as leave out this share of the motion, 1e-6 or "
           "more; 0 on all");
  return list;
}

Parameter memory_parameter() {
  return {"memory",
          ParameterKind::text,
          {},
          "memory that the run may take, such as 4G or 500M: motion that is larger is kept in a "
          "file while the run lasts, or read again; the result is the same; default what the "
          "machine has left"};
}

/// --only and --without, the vertices on which regions may lie.
BoundParameters<AnalysisOptions> place_parameters() {
  const auto bound = [](const std::string& name, bool wanted) {
    return [name, wanted](const Parameters& parameters, AnalysisOptions& options,
                          const FieldSequence* sequence) {
      const auto text = parameters.optional_text(name);
      if (!sequence || !text) return;
      const std::vector<bool> named = named_vertices(*text, *sequence);
      if (options.inside.empty()) options.inside.assign(named.size(), true);
      for (std::size_t v = 0; v < named.size(); ++v) {
        if (named[v] != wanted) options.inside[v] = false;
      }
    };
  };
  BoundParameters<AnalysisOptions> list;
  list.add(vertex_set_parameter(
               "only",
               "where components and regions may lie: connected components by size (0 is the "
               "largest, info lists them), OBJ groups or materials, vertices where a field is not "
               "zero (all: several between commas), or a vertex list"),
           bound("only", true))
      .brief("where regions may lie: component:0, group:NAME, FILE")
      .add(vertex_set_parameter("without", "where none may lie, named as for --only"),
           bound("without", false));
  return list.under(kRegionGroup);
}

/// --per-region and its options.
BoundParameters<SolveOptions> regional_parameters() {
  BoundParameters<SolveOptions> list;
  return list
      .add("per-region", SolveOptions::kPerRegion,
           "give each region blendshape weights of its own, found together on all triangles")
      .add("falloff", SolveOptions::kFalloff,
           "distance from the rim of the regions, or of what is painted 1, over which the motion "
           "that vertices take fades out; default none, " +
               to_text(SolveOptions::kBareFalloff) +
               " around regions of meshes without expressions; with --per-region a region's "
               "weights do, default " +
               to_text(SolveOptions::kUsualFalloff))
      .add("region-ridge", SolveOptions::kRegionRidge,
           "per region: pull of a region's weights towards those of the whole face");
}

BoundParameters<SolveOptions> vertex_parameters() {
  using Options = SolveOptions;
  auto list = triangle_weight_parameters<Options>();
  return list
      .add("outside", Options::kOutside,
           "outside the regions, vertex space: vertices stay, or triangles keep their shape; "
           "blendshape space: expressions move the whole face. Where the border is soft, vertices "
           "of "
           "weight 0 stay in both")
      .add("outside-weight", Options::kOutsideWeight,
           "weight of triangles that keep their shape: those of --outside identity, and those of a "
           "target of other faces that have no partner")
      .add("outside-smoothness", Options::kOutsideSmoothness, "smoothness of --outside identity")
      .add({"anchor", ParameterKind::text, std::string(choice_name(AnchorWord::source)),
            "vertex space: what holds a piece in place: source (its motion), centroid, or a "
            "vertex"},
           apply_anchor);
}

}  // namespace

BoundParameters<SourceOptions> alignment_parameters() {
  BoundParameters<SourceOptions> list;
  list.add_word_or_file<HeadMotion, std::vector<RigidTransform>>(
      "align", SourceOptions::kHeadMotion,
      "head motion to take out first: fitted on what moves least, on all vertices, together with a "
      "target's expressions, none, or as an align run's manifest tells; default none where the "
      "neutral is known, else stable, or joint where no vertex is still and that predicts better",
      motion_in);
  return list.brief("head motion to take out {stable,all,joint,none,FILE}").under(kSourceGroup);
}

BoundParameters<SourceOptions> source_rest_parameters() {
  return rest_named("source-rest", "source's undeformed shape")
      .brief("source's undeformed shape {neutral,first,mean,FILE}");
}

BoundParameters<SourceOptions> rest_parameters() {
  return rest_named("rest", "rest pose");
}

BoundParameters<AnalysisOptions> analysis_rest_parameters() {
  BoundParameters<AnalysisOptions> list;
  list.add_word_or_file<RestPose, Positions>(
      "rest", AnalysisOptions::kRest,
      "rest pose of the decomposition: a frame, the mean, or a mesh; default that of the source",
      rest_in);
  return list.under(kDecompositionGroup);
}

BoundParameters<DistanceOptions> distance_parameters() {
  BoundParameters<DistanceOptions> list;
  list.add("geodesics", DistanceOptions::kMethod, "how distances are computed")
      .add("weld", DistanceOptions::kWelding,
           "treat vertices at one place as one for distances (UV seams)");
  return list;
}

BoundParameters<AnalysisOptions> count_parameters(const AnalysisOptions& defaults) {
  BoundParameters<AnalysisOptions> list(defaults);
  return list.add("k", AnalysisOptions::kCount, "number of components")
      .brief("number of components")
      .under(kDecompositionGroup);
}

BoundParameters<AnalysisOptions> analysis_parameters() {
  BoundParameters<AnalysisOptions> list;
  list.add("d-min", AnalysisOptions::kMinimum,
           "geodesic distance up to which sparsity costs nothing")
      .add("d-max", AnalysisOptions::kMaximum, "geodesic distance from which it costs all")
      .add(decomposition_parameters())
      .add("compat", AnalysisOptions::kCompatibility,
           "splocs2013: follow the reference implementation to the letter; paper: also sum eq. 10 "
           "and 12 over two edges of each triangle")
      .add(&AnalysisOptions::distances, distance_parameters())
      .add(place_parameters())
      // Only checks the amount of memory; within_memory() reads it.
      .add(memory_parameter(),
           [](const Parameters& parameters, AnalysisOptions&) { parameters.bytes("memory"); });
  return list.under(kDecompositionGroup);
}

RegionChoiceOptions with_most_discs(RegionChoiceOptions options, const Parameters& parameters) {
  options.discs = {};
  if (options.select == Selector::transfer && parameters.is_set("k") &&
      parameters.find("k")->kind == ParameterKind::integer) {
    options.discs = parameters.integer("k");
  }
  return options;
}

namespace {

/// --select, --triangles and --drop-rims.
BoundParameters<RegionChoiceOptions> selection_parameters() {
  using Options = RegionChoiceOptions;
  BoundParameters<Options> list;
  return list
      .add("select", Options::kSelect,
           "what regions are chosen by: energy, where the source moves most; transfer, what they "
           "tell of the target's expressions (discs of a third of --radius, of which -k are the "
           "most, without a decomposition)")
      .add("triangles", Options::kTriangles,
           "share of the triangles that the regions may hold; default any, with --select transfer "
           "and without -k " +
               to_text(ParameterValue(Options::kUsualShare)))
      .add("drop-rims", Options::kDropRims,
           "make no regions by energy on the rim of the surface, where a scan ends");
}

}  // namespace

BoundParameters<RegionChoiceOptions> region_parameters() {
  using Options = RegionChoiceOptions;
  BoundParameters<Options> list;
  return list.add(selection_parameters())
      .add("radius", Options::kRadius, "geodesic radius of a region")
      .brief("geodesic radius of a region")
      .add("region", Options::kShape,
           "disc: within the radius; support: vertices with 95 % of the component's energy")
      .add("coverage", Options::kCoverage,
           "take the strongest regions until they hold this share of the motion energy")
      .brief("take regions until they hold this share of the motion")
      .under(kRegionGroup);
}

BoundParameters<RegionChoiceOptions> completion_parameters() {
  using Options = RegionChoiceOptions;
  BoundParameters<Options> list;
  return list
      .add("complete", Options::kComplete,
           "add discs to the regions until this share of each expression's motion is in them; 0 "
           "adds none")
      .add("complete-limit", Options::kCompleteLimit,
           "share of the triangles that --complete may add")
      .under(kRegionGroup);
}

BoundParameters<SolveOptions> solving_parameters() {
  BoundParameters<SolveOptions> list;
  list.add("space", SolveOptions::kSpace,
           "solve for blendshape weights or vertices; auto: weights where the target has "
           "expressions")
      .brief("solve for")
      .add(axes_parameters<SolveOptions>())
      .add("smoothness", SolveOptions::kSmoothness,
           "time constant of smooth weights, or in vertex space of smooth motion; 0 smooths "
           "nothing")
      .brief("time constant of smooth motion")
      .add(blendshape_parameters<SolveOptions>())
      .add(regional_parameters())
      .add(vertex_parameters());
  return list.under(kSolvingGroup);
}

const std::vector<std::string>& options_of_energy() {
  static const std::vector<std::string> names = concatenated<std::string>(
      {{"region", "coverage", "drop-rims", "component-fields", "complete", "complete-limit"},
       options_of_decomposition()});
  return names;
}

const std::vector<std::string>& options_of_decomposition() {
  static const std::vector<std::string> names = {
      "d-min",           "d-max",     "sparsity", "rho",       "iterations",
      "admm-iterations", "tolerance", "signed",   "precision", "basis-tolerance"};
  return names;
}

std::vector<Exclusion> selection_exclusions() {
  return {
      {options_of_decomposition(),
       {"components"},
       "has no effect on --components, which are decomposed already"},
      {concatenated<std::string>({options_of_energy(), {"compat=splocs2013"}}),
       {"select=transfer"},
       "has no effect with --select transfer, which needs no decomposition"},
      {{"components", "components-out"},
       {"select=transfer"},
       "there are no components with --select transfer"},
      {{"select=transfer"},
       {"space=vertex"},
       "regions are chosen by what they tell of expressions, which --space vertex does not solve "
       "for; use --select energy"}};
}

std::vector<Exclusion> solving_exclusions() {
  return {{{"outside-smoothness"}, {"!outside=identity"}, "is about --outside identity"},
          {{"triangles"},
           {"falloff !per-region"},
           "bounds the regions without the border that --falloff adds; leave one of them out"},
          {{"select=transfer"},
           {"falloff !per-region"},
           "chooses regions by which expressions move the whole face; with --falloff they move the "
           "regions only; use --select energy"},
          {{"region-ridge"}, {"!per-region"}, "is about weights of each region, --per-region"},
          {{"!smoothness=0"},
           {"per-region"},
           "with --per-region weights are found frame by frame; leave one of them out"},
          {{"symmetry", "exclusive", "rules"},
           {"per-region"},
           "weights of each region, --per-region, follow no rules of expressions"},
          {{"complete", "complete-limit"},
           {"per-region"},
           "with --per-region all triangles are looked at, and no discs are added"},
          {{"rest"},
           {"select=transfer"},
           "has no effect with --select transfer, which needs no decomposition; the source's "
           "undeformed shape is --source-rest"}};
}

void check_given_components(const Invocation& invocation) {
  const auto* components = invocation.find<Components>("components");
  const Parameters& parameters = invocation.parameters;
  // The number of the line that made the components is allowed, with the components added.
  if (components && parameters.is_set("k") && parameters.integer("k") != components->count()) {
    throw UsageError("-k: has no effect on --components, which are decomposed already");
  }
}

namespace {

/// Whether triangles of a target may lack a partner in the source.
bool pairs_targets(const Invocation& invocation) {
  if (!invocation.parameters.paths("correspondence").empty()) return true;
  const FrameSource& frames = *invocation.get<FieldSequence>("source").frames;
  const TriMesh source{frames.rest(), frames.connectivity()};
  return std::ranges::any_of(invocation.inputs.at("target"), [&source](const NamedData& target) {
    return !has_faces_of(source, person_of(target));
  });
}

}  // namespace

void check_solving(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  if (parameters.is_set("outside-weight") &&
      parameters.choice<Outside>("outside") != Outside::identity && !pairs_targets(invocation)) {
    throw UsageError(
        "--outside-weight: is about --outside identity, or targets of other faces than the "
        "source's");
  }
  if (!parameters.flag("per-region")) return;
  for (const NamedData& target : invocation.inputs.at("target")) {
    if (!solves_for_vertices(parameters, person_of(target))) continue;
    throw UsageError("--per-region: " + target.name + " is solved for vertices, not weights");
  }
}

void check_border(const Invocation& invocation, const GivenRegions* given,
                  const SolveOptions& options) {
  in_command_terms(invocation.parameters, [&] {
    for (const NamedData& target : invocation.inputs.at("target")) {
      check_border(given, Target{target.name, person_of(target)}, options);
    }
  });
}

void set_usual_border(const Invocation& invocation, SolveOptions& options) {
  static constexpr std::array kNames = {"falloff", "paint", "triangles", "anchor", "curve"};
  const auto is_set = [&](const char* name) { return invocation.parameters.is_set(name); };
  const auto has_expressions = [](const NamedData& target) {
    return person_of(target).expressions().size() > 0;
  };
  const RegionData* given = invocation.find<RegionData>("regions");
  const bool has_border = given && given->regions.weights.size() > 0;
  if (std::ranges::any_of(kNames, is_set) || has_border || options.outside == Outside::identity ||
      std::ranges::any_of(invocation.inputs.at("target"), has_expressions)) {
    return;
  }
  options.falloff = SolveOptions::kBareFalloff;
}

SourceOptions described(SourceOptions options, const NamedData& input) {
  options.name = input.name;
  options.model_driven = input.origin.model_driven;
  return options;
}

std::optional<GivenComponents> given_components(const Invocation& invocation) {
  const Components* components = invocation.find<Components>("components");
  if (!components) return {};
  return GivenComponents{invocation.input("components").name, *components};
}

Output components_output() {
  return {"components-out", DataKind::components,
          "the components, for later runs with --components", true};
}

bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target) {
  return solves_for_vertices(target, parameters.choice<Space>("space"));
}

Context within_memory(const Invocation& invocation) {
  const auto allowed = invocation.parameters.bytes("memory");
  // May be negative if the process already has more memory. Messages then give the total shortage.
  return invocation.context.with_memory(allowed ? *allowed - MemoryUse::of_this_process().now
                                                : available_memory());
}

DecompositionPlan analysis_plan(const Invocation& invocation, const FrameSource& source,
                                const AnalysisOptions& options) {
  if (invocation.find<Components>("components")) return {};
  DecompositionPlan plan = analysis_plan(source, options, within_memory(invocation));
  plan.bytes += stored_bytes(source);
  if (!source.is_quick()) plan.scratch_bytes += frame_bytes(source) - stored_bytes(source);
  return plan;
}

}  // namespace mimetra
