#pragma once

#include <functional>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

/// Calls `work(i)` once for each i in 0 .. count - 1, from the threads of the context, the calling
/// one among them. Any thread may take any i; if each i writes to its own place, the result does
/// not depend on the number of threads.
///
/// The calling thread reports progress, 1 at the end. Throws what the `work` of the lowest i threw,
/// and Cancelled; the remaining i are then not started.
void parallel_for(int count, const std::function<void(int)>& work, const Context& = {});

}  // namespace mimetra
