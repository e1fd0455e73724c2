#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// `rig`: the full set of a model's expressions for another character.
Operation rig_operation();

}  // namespace mimetra
