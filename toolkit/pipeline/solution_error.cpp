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
                       const Selection& selection, const SolveOptions& options,
                       const Context& context) {
  TransferErrorOptions of_error{.edges = options.edges.value_or(EdgeSum::all),
                                .pairing = target.pairing,
                                .inside = selection.inside,
                                .weights = selection.weights};
  const double seams = has_border(selection) ? 0.2 : 0;
  if (seams > 0) {
    of_error.weld = closed_seams_of(source, target, context.part(0, seams).without_ranks());
  }
  return transfer_error(*source.sequence, *solution.sequence, selection.triangles, of_error,
                        context.part(seams, 1));
}

void note_crease(const TransferError& error, const Target& target, const Context& context) {
  if (error.crease < kVisibleCrease) return;
  context.note(target.name + ": the surface folds at the regions' border by " +
                   readable(error.crease, 2) + " degrees more than the source does, by " +
                   readable(error.largest_crease, 2) + " where it is worst: a crease that is seen",
               Topic::visible_crease);
}

}  // namespace mimetra
