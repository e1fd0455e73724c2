#pragma once

#include <string>

#include "plugins/c/context_handle.h"
#include "toolkit/operations/data.h"

namespace mimetra {

/// A value of a file, with the parameters of reading that kind in `settings`: "NAME=VALUE", ended
/// by NULL. Throws UsageError for a setting that is none, and what the readers throw.
NamedData loaded_data(const mimetra_context& context, DataKind kind, const std::string& text,
                      const char* const* settings);

/// Writes a value, with the parameters of writing its kind, and "force=true". Throws UsageError for
/// a setting that is none, or a path whose extension nothing writes; what the writers throw.
void write_data(const mimetra_context& context, const Data& data, const std::string& path,
                const char* const* settings);

}  // namespace mimetra
