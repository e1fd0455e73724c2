#pragma once

#include <functional>

#include "plugins/c/mimetra.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Functions of mimetra.h, with contexts that contain the toolkit's operations.
const mimetra_interface& toolkit_interface();

/// Functions of a library with its own `new_context`. Returns null if `version` is not the version
/// of mimetra.h. A program calls this with only one `new_context`.
const mimetra_interface* library_interface(uint32_t version,
                                           decltype(mimetra_interface::new_context) new_context);

/// Makes a context with the operations that `fill` adds. The lines that `fill` returns go to the
/// log as warnings.
mimetra_status make_context(const std::function<std::vector<std::string>(OperationTable&)>& fill,
                            mimetra_log log, void* user, mimetra_context** context) noexcept;

}  // namespace mimetra
