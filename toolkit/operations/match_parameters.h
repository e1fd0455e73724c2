#pragma once

#include <vector>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/solve.h"

namespace mimetra {

/// --markers, --index-base, --ignore-files and --correspondence, of operations that pair a source
/// with a target.
std::vector<Parameter> pairing_parameters();
/// The same and --rules, of those that solve for a target's weights.
std::vector<Parameter> match_parameters();
/// Exclusions among the options of pairing.
std::vector<Exclusion> pairing_exclusions();

/// A sequence's rest pose or a model's neutral as a head, with the landmarks that a file
/// landmarks68.txt or ibug_to_*.txt beside it names (the first where there is a landmarks68.txt;
/// not with `ignore_files`). A file that names vertices which the mesh has not is of another mesh:
/// that is said, and it is left out. Throws IoError for a file that is no mapping.
Head head_of(const NamedData& value, const Log& log, bool ignore_files = false);

/// The call's targets and how they are paired with its source: where nothing is named, by markers
/// that are looked for if faces differ. Rules of expressions are those named, or in a model's
/// folder, which is said. Throws UsageError where options exclude each other or name another number
/// of files than one or one for each target, and where no target is solved for the weights that one
/// is about; what read_markers(), read_correspondence() and read_rules() throw.
///
/// `source` is the input that they are paired with.
std::vector<Target> targets_of(const Invocation& invocation, const std::string& source = "source");

/// Throws and warns as a run does of the call's targets before anything is fitted to them: faces,
/// rules, given markers and correspondences. Markers that would be looked for in drawings are not.
void check_targets(const Invocation& invocation, const std::vector<Target>& targets,
                   const FrameSource& source, const SolveOptions& options);

}  // namespace mimetra
