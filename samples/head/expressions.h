#pragma once

#include "samples/head/head_grid.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra::samples {

/// The head's 12 expressions, named as in ARKit (`Left` is the head's own left). Each moves a part
/// of the face and leaves all else exactly in place.
ShapeBasis head_expressions(const HeadGrid& grid);

/// Four clearly different people as displacements from the mean head. One has a wide face, one a
/// long narrow face, one a strong jaw, brows and nose; one is a child.
ShapeBasis head_identities(const Positions& mean);

}  // namespace mimetra::samples
