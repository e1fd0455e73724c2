#pragma once

#include <functional>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

/// Calls `work(i)` once for each i in 0 .. count - 1, from the threads of the context, including
/// the calling thread. Any thread may take any i. If each i writes to its own place, the result
/// does not depend on the number of threads.
///
/// The calling thread reports progress, and 1 at the end. If `work` throws or progress is
/// cancelled, no further i is started. Rethrows the exception of the lowest i, or Cancelled.
void parallel_for(int count, const std::function<void(int)>& work, const Context& = {});

}  // namespace mimetra
