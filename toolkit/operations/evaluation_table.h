#pragma once

#include <vector>

#include "toolkit/operations/data.h"
#include "toolkit/pipeline/evaluation.h"

namespace mimetra {

/// Table I, a row for each of `rows`.
Table table_of(const std::vector<EvaluationRow>& rows);

}  // namespace mimetra
