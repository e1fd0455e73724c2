#pragma once

#include "toolkit/pipeline/solution.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {

/// RMS of TransferError::crease, in degrees, from which a crease at the regions' border is seen. On
/// drawn faces of sfm, ict-face and facecap one of 2 is hardly found, one of 4 is; the full
/// transfer has 0.1 to 1.1.
constexpr double kVisibleCrease = 3;

/// How far a solution is from what it was solved for, before head motion is given back. \pre as of
/// solve(), with the same options.
/// Throws what transfer_error() and closed_seams() throw.
TransferError error_of(const Solution& solution, const Source& source, const Target& target,
                       const Selection& selection, const SolveOptions& options = {},
                       const Context& context = {});

/// Notes, under the target's name, a crease at the regions' border that is seen
/// (Topic::visible_crease).
void note_crease(const TransferError& error, const Target& target, const Context& context);

}  // namespace mimetra
