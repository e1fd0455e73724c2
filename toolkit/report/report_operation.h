#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

/// Adds the format .html of pages, and the operation `report`, which shows a run as a page.
void add_report(OperationTable& table);

}  // namespace mimetra
