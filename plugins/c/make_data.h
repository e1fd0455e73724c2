#pragma once

#include "plugins/c/mimetra.h"
#include "toolkit/operations/data.h"

namespace mimetra {

/// A kind of the header. Throws UsageError for what is none.
DataKind kind_of(mimetra_kind kind);

/// A value of named arrays, as mimetra.h lists them by kind. Throws UsageError for arrays of
/// another shape, or that the kind does not know; MismatchError where they contradict each other;
/// IoError for values that cannot be. What is odd about it is in its origin's notes.
NamedData made_data(mimetra_kind kind, const std::string& name, const mimetra_array* const* arrays);

/// `base` with these arrays in place of its own. Throws as made_data.
NamedData derived_data(const NamedData& base, const mimetra_array* const* arrays);

}  // namespace mimetra
