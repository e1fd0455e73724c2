#pragma once

#include <string>

#include "toolkit/operations/json.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// Adds what is known of a decomposition's end: `converged`, and `iteration`, the one whose state
/// the components are.
void add_convergence(Json& report, const Components& components);

/// The same for people, as a part of a line: "30 iterations, not converged". \pre it is known
std::string convergence_text(const Components& components);

}  // namespace mimetra
