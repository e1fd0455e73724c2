#include "toolkit/operations/selection_parameters.h"

#include <algorithm>
#include <array>

#include "toolkit/pipeline/solution.h"

namespace mimetra {

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

void check_given_components(const Invocation& invocation) {
  const auto* components = invocation.find<Components>("components");
  const Parameters& parameters = invocation.parameters;
  // The same number comes of the line that made them, with the components instead.
  if (components && parameters.is_set("k") && parameters.integer("k") != components->count()) {
    throw UsageError("-k: has no effect on --components, which are decomposed already");
  }
}

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

RegionChoiceOptions with_most_discs(RegionChoiceOptions options, const Parameters& parameters) {
  options.discs = {};
  if (options.select == Selector::transfer && parameters.is_set("k") &&
      parameters.find("k")->kind == ParameterKind::integer) {
    options.discs = parameters.integer("k");
  }
  return options;
}

void set_usual_border(const Invocation& invocation, SolveOptions& options) {
  static constexpr std::array kNames = {"falloff", "paint", "triangles", "anchor", "curve"};
  const auto is_set = [&](const char* name) { return invocation.parameters.is_set(name); };
  const auto has_expressions = [](const NamedData& target) {
    return std::get<ModelData>(target.data).model.average().expressions().size() > 0;
  };
  const RegionData* given = invocation.find<RegionData>("regions");
  const bool has_border = given && given->regions.weights.size() > 0;
  if (std::ranges::any_of(kNames, is_set) || has_border || options.outside == Outside::identity ||
      std::ranges::any_of(invocation.inputs.at("target"), has_expressions)) {
    return;
  }
  options.falloff = SolveOptions::kBareFalloff;
}

}  // namespace mimetra
