#pragma once

#include <functional>

#include "plugins/c/mimetra.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// The functions of mimetra.h. Its contexts have the toolkit's operations.
const mimetra_interface& toolkit_interface();

/// The same with contexts that `new_context` makes, for the one symbol of a library; null for
/// another version than that of mimetra.h. A program has one such function.
const mimetra_interface* library_interface(uint32_t version,
                                           decltype(mimetra_interface::new_context) new_context);

/// Makes a context with the operations that `fill` adds; what it returns goes to the log as
/// warnings.
mimetra_status make_context(const std::function<std::vector<std::string>(OperationTable&)>& fill,
                            mimetra_log log, void* user, mimetra_context** context) noexcept;

}  // namespace mimetra
