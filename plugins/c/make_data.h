#pragma once

#include "plugins/c/mimetra.h"
#include "toolkit/io/data.h"

namespace mimetra {

/// Converts a kind of mimetra.h. Throws UsageError for an unknown kind.
DataKind kind_of(mimetra_kind kind);

/// Makes a value from named arrays, which mimetra.h lists for each kind. Throws UsageError for
/// unknown arrays or wrong shapes, MismatchError if arrays contradict each other, and IoError for
/// impossible values. Notes in the origin describe oddities.
NamedData made_data(mimetra_kind kind, const std::string& name, const mimetra_array* const* arrays);

/// Copies `base` and replaces some of its arrays. Throws as made_data().
NamedData derived_data(const NamedData& base, const mimetra_array* const* arrays);

}  // namespace mimetra
