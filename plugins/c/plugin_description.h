#pragma once

#include <memory>
#include <string>

#include "plugins/c/context_handle.h"
#include "toolkit/operations/format.h"
#include "toolkit/operations/operation.h"

/// Operations and formats of plugins, from their descriptions.
namespace mimetra {

/// An operation of a plugin as one of the table, under its name. What it does wrong ends its run
/// with an exception that names it, and changes nothing else. `toolkit` is what its runs may call.
/// Throws UsageError that says what is wrong with the description.
Operation plugin_operation(const mimetra_operation& described, const std::string& plugin,
                           std::shared_ptr<const DescribedTable> toolkit);

/// A format of a plugin as one of the table. `toolkit` is what its functions may call. Throws
/// UsageError that says what is wrong with the description.
Format plugin_format(const mimetra_format& described, const std::string& plugin,
                     const std::shared_ptr<const DescribedTable>& toolkit);

}  // namespace mimetra
