#include "toolkit/operations/selection_parameters.h"

#include <algorithm>
#include <array>

#include "toolkit/pipeline/solution.h"

namespace mimetra {

const std::vector<std::string>& options_of_energy() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"region",           "coverage", "drop-rims",
                                    "component-fields", "complete", "complete-limit"};
    all.insert(all.end(), options_of_decomposition().begin(), options_of_decomposition().end());
    return all;
  }();
  return names;
}

const std::vector<std::string>& options_of_decomposition() {
  static const std::vector<std::string> names = {
      "d-min",           "d-max",     "sparsity", "rho",       "iterations",
      "admm-iterations", "tolerance", "signed",   "precision", "basis-tolerance"};
  return names;
}

void check_given_components(const Invocation& invocation) {
  const auto* components = invocation.find<Components>("components");
  if (!components) return;
  const std::string reason = "has no effect on --components, which are decomposed already";
  const Parameters& parameters = invocation.parameters;
  // The line that made them, with the components instead.
  if (parameters.is_set("k") && parameters.integer("k") != components->count()) {
    refuse_options(parameters, {"k"}, reason);
  }
  refuse_options(invocation.parameters, options_of_decomposition(), reason);
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
  const auto is_set = [&](const std::string& name) {
    return invocation.parameters.find(name) && invocation.parameters.is_set(name);
  };
  const auto has_expressions = [](const NamedData& target) {
    return std::get<ModelData>(target.data).model.average().expressions().size() > 0;
  };
  const RegionData* given = invocation.find<RegionData>("regions");
  const bool has_border = given && given->regions.weights.size() > 0;
  if (std::ranges::any_of(kNames, is_set) || has_border ||
      options.vertex.outside == Outside::identity ||
      std::ranges::any_of(invocation.inputs.at("target"), has_expressions)) {
    return;
  }
  options.falloff = SolveOptions::kBareFalloff;
}

void refuse_options(const Parameters& parameters, const std::vector<std::string>& names,
                    const std::string& reason) {
  for (const std::string& name : names) {
    if (parameters.find(name) && parameters.is_set(name)) {
      throw UsageError(parameters.find(name)->option() + ": " + reason);
    }
  }
}

void check_selection(const Invocation& invocation) {
  const Parameters& parameters = invocation.parameters;
  if (parameters.choice<Selector>("select") != Selector::transfer) return;
  refuse_options(parameters, options_of_energy(),
                 "has no effect with --select transfer, which needs no decomposition");
  // The rest pose of the decomposition, where the source's has a name of its own.
  if (parameters.find("source-rest")) {
    refuse_options(parameters, {"rest"},
                   "has no effect with --select transfer, which needs no decomposition; the "
                   "source's undeformed shape is --source-rest");
  }
  if (parameters.choice<Compatibility>("compat") == Compatibility::splocs2013) {
    throw UsageError(
        "--compat splocs2013: has no effect with --select transfer, which needs no "
        "decomposition");
  }
  if (invocation.find<Components>("components") || invocation.wants("components-out")) {
    throw UsageError(
        "--components, --components-out: there are no components with --select "
        "transfer");
  }
  if (parameters.find("space") && parameters.choice<Space>("space") == Space::vertex) {
    throw UsageError(
        "--select transfer: regions are chosen by what they tell of expressions, "
        "which --space vertex does not solve for; use --select energy");
  }
}

}  // namespace mimetra
