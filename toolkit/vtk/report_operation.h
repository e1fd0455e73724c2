#pragma once

#include <mimetra/operations/operation.h>

namespace mimetra {

/// `report`: a page that shows a run.
Operation report_operation();

}  // namespace mimetra
