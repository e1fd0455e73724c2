#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/io/json_text.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

/// "1 frame", "300 frames"; what is not made plural by an s says how it is.
inline std::string counted(std::ptrdiff_t count, const std::string& one,
                           const std::string& several = "") {
  return std::to_string(count) + ' ' + (count == 1 ? one : several.empty() ? one + 's' : several);
}

/// The report with a list of `count` entries, of which `text_of` gives the JSON: the text is a few
/// times smaller than the values would be.
std::string report_with(const Json& report, const std::string& name, std::size_t count,
                        const std::function<std::string(std::size_t)>& text_of);

/// The last time minus the first.
double seconds(const FrameSource& sequence);

/// "0.5 to 2 s"; or that nobody knows.
std::string times_text(const FrameSource& sequence);

/// Where the option `smoothness`, a time, is on and the input `name` says nothing of time, warns of
/// the rate that is taken for its.
void warn_of_guessed_rate(const Invocation& invocation, const std::string& name,
                          bool times_are_known);

enum class KeptInScenes { no, yes };

/// A model that nothing drives is one frame at rest, and what is made of it has no expressions.
/// Warns of that, unless one mesh is what is asked for, or a file that holds them (.glb)
/// where the operation keeps them there.
void warn_of_lost_expressions(const Invocation& invocation, const FrameSource& frames,
                              KeptInScenes kept);

/// What was done about head motion, for reports.
Json json_of(const HeadMotionTaken& motion);

/// Adds what is known of a decomposition's end: `converged`, and `iteration`, the one whose state
/// the components are.
void add_convergence(Json& report, const Components& components);

/// The same for people, as a part of a line: "30 iterations, not converged". \pre it is known
std::string convergence_text(const Components& components);

/// What operations report about regions: keys regions, vertices, triangles, vertex_share, ...;
/// energy_share is null where it is not known.
Json report_of(const Regions& regions);
/// The same for people, one line.
std::string summary_of(const Regions& regions);
/// Those of the regions that were added for a target's expressions.
Json added_regions(const Regions& regions);

/// What a correspondence is worth, for reports and for people.
Json json_of(const MatchReport& match);
std::string summary_of(const MatchReport& match);

/// How far eyes and mouth are open on source and target, for reports and for people.
Json json_of(const std::vector<ComparedOpening>& openings);
std::string summary_of(const std::vector<ComparedOpening>& openings);

/// Of the target's triangles: the distance from the deformed source (0 where it is nowhere near)
/// and the number of partners.
std::vector<Field> fields_of(const Correspondence& pairs);

/// Table I, a row for each of `rows`.
Table table_of(const std::vector<EvaluationRow>& rows);

/// What operations print of a decomposition, of regions and of a transfer; docs/glossary.md has
/// more of each.
std::vector<Measure> decomposition_measures();
std::vector<Measure> region_measures();
std::vector<Measure> transfer_measures();
std::vector<Measure> evaluation_measures();

}  // namespace mimetra
