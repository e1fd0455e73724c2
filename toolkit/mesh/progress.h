#pragma once

#include <functional>

namespace mimetra {

/// Called now and then with the share of the work done, in [0, 1]. Returning false stops the
/// computation, which then throws Cancelled.
using Progress = std::function<bool(double)>;

/// Calls `progress` if there is one. Throws Cancelled when it returns false.
void report_progress(const Progress& progress, double share);

/// The part [from, to] of `progress`: a caller's 0 becomes `from` and its 1 `to`.
Progress part_of(const Progress& progress, double from, double to);

}  // namespace mimetra
