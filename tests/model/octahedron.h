#pragma once

#include <memory>

#include "tests/shapes.h"

namespace mimetra::test {

inline std::shared_ptr<const Connectivity> octahedron_connectivity() {
  return std::make_shared<Connectivity>(mesh_of(octahedron()).connectivity);
}

}  // namespace mimetra::test
