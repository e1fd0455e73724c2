#pragma once

#include "toolkit/operations/operation.h"

namespace mimetra {

// Bytes that operations take at their peak, besides what they were given. Counted are the arrays
// that grow with the sequence or the number of components.

/// The sequence without its head motion; 0 where --align takes none out.
double alignment_bytes(const Invocation& invocation, const SequenceRead& read);

/// A decomposition of `read` into `count` components, alignment included; 0 for components that are
/// given.
double analysis_bytes(const Invocation& invocation, const SequenceRead& read, int count);

/// Set-up and result of a transfer of `read` to `target`.
double solution_bytes(const Invocation& invocation, const SequenceRead& read,
                      const BlendshapeModel& target);

}  // namespace mimetra
