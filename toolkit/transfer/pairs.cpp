#include "toolkit/transfer/pairs.h"

#include <string>
#include <utility>

#include "toolkit/mesh/errors.h"

namespace mimetra {

void check_sizes(const Positions& source_rest, const Positions& target_rest,
                 const Pairing* pairing) {
  const auto sizes = [](Eigen::Index source, Eigen::Index target) {
    return "the source has " + std::to_string(source) + " vertices, the target " +
           std::to_string(target);
  };
  const std::string found = sizes(source_rest.rows(), target_rest.rows());
  if (!pairing) {
    if (source_rest.rows() == target_rest.rows()) return;
    throw MismatchError(found + "; both need the same connectivity");
  }
  const std::string expected = sizes(pairing->source_vertices(), pairing->target_vertices());
  if (found != expected) throw MismatchError(found + "; in their pairing " + expected);
}

DeformationGradients gradients_between(const Positions& source_rest, const Triangles& triangles,
                                       const Pairing* pairing, std::vector<int> selected) {
  if (!pairing) return {source_rest, triangles, std::move(selected)};
  return {source_rest, pairing->source_triangles(), pairing->triangles(), std::move(selected)};
}

}  // namespace mimetra
