#include "toolkit/operations/convergence_report.h"

#include <nlohmann/json.hpp>

namespace mimetra {

void add_convergence(Json& report, const Components& components) {
  if (components.converged) report["converged"] = *components.converged;
  if (components.iteration > 0) report["iteration"] = components.iteration;
}

std::string convergence_text(const Components& components) {
  const auto ran = static_cast<int>(components.energies.size());
  std::string text = std::to_string(ran) + (ran == 1 ? " iteration, " : " iterations, ") +
                     (*components.converged ? "converged" : "not converged");
  if (components.iteration == ran) return text;
  return text + ", the best was number " + std::to_string(components.iteration);
}

}  // namespace mimetra
