#pragma once

#include <vector>

#include "toolkit/io/format.h"

namespace mimetra {

/// glTF and VRM, as sequences and as models.
std::vector<Format> gltf_formats();

}  // namespace mimetra
