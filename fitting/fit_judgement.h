#pragma once

#include <string>
#include <vector>

#include "fitting/clip_fit.h"
#include "fitting/fit_verdict.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// What a fit is worth, in numbers and in words. Internal to fit_operation.h.
struct Judgement {
  IdentityVerdict identity;
  FitResiduals residuals;
  double stretch = 1;
  /// Without identities, cameras take what the person's proportions are.
  bool has_identities = true;
  ClipPeople people;
  std::vector<ExpressionUse> expressions;

  /// `names` of the expressions.
  Json json(const std::vector<std::string>& names) const;
  std::string words() const;
};

/// Warns where landmarks are far from the fitted face, as in the wrong order, in all frames or
/// some; where a clip's images are stretched, or its parts show two people; where no person is to
/// be expected; and of expressions that are there all the time, by their `names`.
void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const MappedLandmarks& mapped, const FitOptions& options,
             const Invocation& invocation);

}  // namespace mimetra
