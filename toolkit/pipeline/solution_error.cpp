#include "toolkit/pipeline/solution_error.h"

#include <algorithm>

#include "toolkit/mesh/text.h"
#include "toolkit/transfer/seams.h"

namespace mimetra {

namespace {

/// Whether some vertices take more of the motion than others.
bool has_border(const Selection& selection) {
  if (selection.weights.size() > 0) {
    return selection.weights.minCoeff() < selection.weights.maxCoeff();
  }
  return std::ranges::count(selection.inside, false) > 0;
}

}  // namespace

TransferError error_of(const Solution& solution, const Source& source, const Target& target,
                       const Selection& selection, const SolveOptions& options) {
  TransferErrorOptions of_error{.edges = options.edges,
                                .pairing = target.pairing,
                                .inside = selection.inside,
                                .weights = selection.weights,
                                .threads = options.threads,
                                .progress = options.progress,
                                .ranks = options.ranks};
  if (has_border(selection)) {
    of_error.weld =
        closed_seams_of(source, target, {options.threads, part_of(options.progress, 0, 0.2)});
    of_error.progress = part_of(options.progress, 0.2, 1);
  }
  return transfer_error(*source.sequence, *solution.sequence, selection.triangles, of_error);
}

void note_crease(const TransferError& error, const Target& target, const Notes& notes) {
  if (error.crease < kVisibleCrease) return;
  note(notes,
       target.name + ": the surface folds at the regions' border by " + readable(error.crease, 2) +
           " degrees more than the source does, by " + readable(error.largest_crease, 2) +
           " where it is worst: a crease that is seen",
       Topic::visible_crease);
}

}  // namespace mimetra
