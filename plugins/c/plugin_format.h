#pragma once

#include <memory>
#include <string>

#include "plugins/c/described_table.h"
#include "plugins/c/mimetra.h"
#include "toolkit/operations/format.h"

namespace mimetra {

/// A format of a plugin as one of the table. `toolkit` is what its functions may call. Throws
/// UsageError that says what is wrong with the description.
Format plugin_format(const mimetra_format& described, const std::string& plugin,
                     const std::shared_ptr<const DescribedTable>& toolkit);

}  // namespace mimetra
