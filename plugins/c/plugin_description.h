#pragma once

#include <memory>
#include <string>

#include "plugins/c/context_handle.h"
#include "toolkit/io/format.h"
#include "toolkit/operations/operation.h"

/// Converts descriptions of operations and formats by plugins.
namespace mimetra {

/// Makes an operation from a plugin's description. `toolkit` has the operations that its runs may
/// call. Errors of the plugin end its run with an exception that names the operation, and have no
/// other effect. Throws UsageError if the description is wrong.
Operation plugin_operation(const mimetra_operation& described, const std::string& plugin,
                           std::shared_ptr<const DescribedTable> toolkit);

/// Makes a format from a plugin's description. `toolkit` has the operations that its functions may
/// call. Throws UsageError if the description is wrong.
Format plugin_format(const mimetra_format& described, const std::string& plugin,
                     const std::shared_ptr<const DescribedTable>& toolkit);

}  // namespace mimetra
