#pragma once

#include "samples/head/head_grid.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra::samples {

/// 12 expressions of the head, named as ARKit names them (`Left` is the head's own left). Each
/// moves a part of the face and leaves all else exactly where it is.
ShapeBasis head_expressions(const HeadGrid& grid);

/// 4 clearly different people as displacements from the mean head: a wide face, a long and narrow
/// one, one with a strong jaw, brows and nose, a child.
ShapeBasis head_identities(const Positions& mean);

}  // namespace mimetra::samples
