#pragma once

#include <vector>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/solve.h"

namespace mimetra {

/// --markers, --index-base, --ignore-files and --correspondence, for operations that pair a source
/// with a target.
std::vector<Parameter> pairing_parameters();
/// The pairing parameters and --rules, for operations that solve for a target's weights.
std::vector<Parameter> match_parameters();
/// Exclusions among the options of pairing.
std::vector<Exclusion> pairing_exclusions();

/// Returns a sequence's rest pose or a model's neutral as a head. Landmarks come from a file
/// landmarks68.txt or ibug_to_*.txt beside it; landmarks68.txt has priority. `ignore_files` skips
/// these files.
///
/// Warns about a file that names vertices beyond the mesh, and ignores it. Throws IoError for a
/// file that is not a mapping.
Head head_of(const NamedData& value, const Log& log, bool ignore_files = false);

/// Returns the call's targets, with their pairing and rules. By default markers are searched for if
/// faces differ. Rules come from --rules, or from the model's folder with a warning. `source` is
/// the input with which targets are paired.
///
/// Throws UsageError if options exclude each other, or if the number of files is neither one nor
/// the number of targets. Throws UsageError for an option of weights if no target is solved for
/// weights. Throws what read_marker_file(), read_correspondence() and read_rules() throw.
std::vector<Target> targets_of(const Invocation& invocation, const std::string& source = "source");

/// Throws and warns as a run does before anything is fitted to the targets. Checks faces, rules,
/// given markers and correspondences. Does not search for markers in drawings.
void check_targets(const Invocation& invocation, const std::vector<Target>& targets,
                   const FrameSource& source, const SolveOptions& options);

}  // namespace mimetra
