#pragma once

#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// What operations print of a decomposition, of regions and of a transfer; docs/glossary.md has
/// more of each.
std::vector<Measure> decomposition_measures();
std::vector<Measure> region_measures();
std::vector<Measure> transfer_measures();
std::vector<Measure> evaluation_measures();

}  // namespace mimetra
