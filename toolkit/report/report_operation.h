#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds .html of pages, and the operation `report`: a page that shows a run.
void add_report(OperationTable& table);

}  // namespace mimetra
