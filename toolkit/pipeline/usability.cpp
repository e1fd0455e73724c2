#include "toolkit/pipeline/usability.h"

#include "toolkit/mesh/text.h"

namespace mimetra {

std::string unusable_by(const TransferError& error) {
  std::string wrong;
  if (missed_share(error) > kUnusableMissedShare) {
    wrong = percent(missed_share(error)) + " of the deformation is missing";
  }
  if (flipped_share(error) > kUnusableFlippedShare) {
    wrong += (wrong.empty() ? "" : ", and ") +
             readable(error.flipped / double(error.per_frame.size()), 2) +
             " triangles a frame are flipped";
  }
  return wrong;
}

std::vector<std::string> holding_options(const Target& target, const SolveOptions& options) {
  std::vector<std::string> names;
  const auto add = [&names](bool is_on, const std::string& name) {
    if (is_on) names.push_back("option '" + name + "'");
  };
  add(options.smoothness > 0, "smoothness");
  if (solves_for_vertices(target.model, options.space)) return names;
  add(options.ridge > 0, "ridge");
  add(options.sparsity > 0, "l1");
  add(options.symmetry > 0, "symmetry");
  add(options.exclusive != Exclusive::none, "exclusive");
  add(!target.rules.empty(), "rules");
  return names;
}

Target without_holds(Target target) {
  target.rules = {};
  return target;
}

SolveOptions without_holds(SolveOptions options) {
  options.smoothness = options.ridge = options.sparsity = options.symmetry = 0;
  options.exclusive = Exclusive::none;
  return options;
}

}  // namespace mimetra
