#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

// One function per operation of the toolkit, each in a file of its own name.
Operation info_operation();
Operation check_operation();
Operation align_operation();
Operation geodesic_operation();
Operation decompose_operation();
Operation regions_operation();
Operation transfer_operation();
Operation evaluate_operation();
Operation rig_operation();
Operation convert_operation();
Operation simplify_operation();
Operation subdivide_operation();
Operation retarget_operation();

}  // namespace mimetra
