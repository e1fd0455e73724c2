#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fitting/fit_verdict.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// What a fit is worth, in numbers and in words. Internal to fit_operation.h.
struct Judgement {
  IdentityVerdict identity;
  std::optional<NeutralDistance> halves;
  std::vector<ExpressionUse> expressions;

  /// `names` of the expressions.
  Json json(const std::vector<std::string>& names) const;
  std::string words() const;
};

/// Warns where no person is to be expected, and of expressions that are there all the time.
void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const Invocation& invocation);

}  // namespace mimetra
