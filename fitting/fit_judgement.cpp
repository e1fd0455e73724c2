#include "fitting/fit_judgement.h"

#include <nlohmann/json.hpp>

#include "toolkit/mesh/text.h"

namespace mimetra {

Json Judgement::json(const std::vector<std::string>& names) const {
  Json uses = Json::array();
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    const ExpressionUse& use = expressions[j];
    uses.push_back(
        {{"name", names[j]}, {"mean", use.mean}, {"at_zero", use.at_zero}, {"at_one", use.at_one}});
  }
  return {{"alpha_rms", identity.alpha_rms},
          {"alpha_max", identity.alpha_max},
          {"flipped", identity.flipped},
          {"halves_mean", halves ? Json(halves->mean) : Json(nullptr)},
          {"halves_largest", halves ? Json(halves->largest) : Json(nullptr)},
          {"expressions", uses}};
}

std::string Judgement::words() const {
  std::string text = "identity: " + readable(identity.alpha_rms) +
                     " standard deviations (RMS), at most " + readable(identity.alpha_max) + ", " +
                     std::to_string(identity.flipped) + " flipped triangles";
  if (halves) {
    text += "; the neutrals of the clip's halves are " + readable(100 * halves->mean) +
            " % of the longest side apart (at most " + readable(100 * halves->largest) + " %)";
  }
  double at_bounds = 0;
  for (const ExpressionUse& use : expressions) {
    at_bounds += (use.at_zero + use.at_one) / double(expressions.size());
  }
  if (at_bounds > 0) {
    text += "; expressions are at a bound in " + readable(100 * at_bounds) + " % of the frames";
  }
  return text + '\n';
}

void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const Invocation& invocation) {
  const IdentityVerdict& identity = judgement.identity;
  if (identity.is_doubtful()) {
    invocation.warn("the fitted identity is hardly a person: its largest coefficient is " +
                    readable(identity.alpha_max) + " standard deviations, and " +
                    std::to_string(identity.flipped) +
                    " triangles are flipped; use more frames in which the head turns, --camera "
                    "orthographic, a --repeated nearer to 1 or a larger --sigma");
  }
  std::string constant;
  for (std::size_t j = 0; j < names.size(); ++j) {
    if (!judgement.expressions[j].is_constant()) continue;
    constant += (constant.empty() ? "" : ", ") + names[j] + " (" +
                readable(judgement.expressions[j].mean) + ")";
  }
  if (!constant.empty() && judgement.halves) {
    invocation.warn("expressions that are there all the time, as parts of the face are: " +
                    constant + "; --ridge 1 makes them smaller");
  }
}

}  // namespace mimetra
