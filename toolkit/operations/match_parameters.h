#pragma once

#include <vector>

#include "toolkit/operations/json.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/opening_comparison.h"
#include "toolkit/pipeline/solution.h"

namespace mimetra {

/// --markers, --index-base, --ignore-files and --correspondence, of operations that pair a source
/// with a target.
std::vector<Parameter> pairing_parameters();
/// The same and --rules, of those that solve for a target's weights.
std::vector<Parameter> match_parameters();
/// Exclusions among the options of pairing.
std::vector<Exclusion> pairing_exclusions();

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

/// What a correspondence is worth, for reports and for people.
Json json_of(const MatchReport& match);
std::string summary_of(const MatchReport& match);

/// How far eyes and mouth are open on source and target, for reports and for people.
Json json_of(const std::vector<ComparedOpening>& openings);
std::string summary_of(const std::vector<ComparedOpening>& openings);

/// Of the target's triangles: the distance from the deformed source (0 where it is nowhere near)
/// and the number of partners.
std::vector<Field> fields_of(const Correspondence& pairs);

}  // namespace mimetra
