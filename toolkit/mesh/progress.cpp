#include "toolkit/mesh/progress.h"

#include "toolkit/mesh/errors.h"

namespace mimetra {

void report_progress(const Progress& progress, double share) {
  if (progress && !progress(share)) throw Cancelled();
}

Progress part_of(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share) { return progress(from + share * (to - from)); };
}

}  // namespace mimetra
