#pragma once

#include <functional>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {

/// Calls `work(i)` once for each i in 0 .. count - 1, from up to `threads` threads (0: as many as
/// the machine has), the calling one among them. Which thread takes which i is open, so that `work`
/// must write to places of its own; then the result is the same for every number of threads.
///
/// `progress` is called from the calling thread, last with 1. Throws what the `work` of the lowest
/// i threw, and Cancelled; what has not begun by then is not done.
void parallel_for(int count, int threads, const std::function<void(int)>& work,
                  const Progress& progress = {});

}  // namespace mimetra
