#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/io/json_text.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

/// Count with singular or plural: "1 frame", "300 frames". `several` is an irregular plural.
inline std::string counted(std::ptrdiff_t count, const std::string& one,
                           const std::string& several = "") {
  return std::to_string(count) + ' ' + (count == 1 ? one : several.empty() ? one + 's' : several);
}

/// Adds a list of `count` entries to the report and returns it as text. `text_of` returns the JSON
/// text of an entry, which needs a few times less memory than JSON values.
std::string report_with(const Json& report, const std::string& name, std::size_t count,
                        const std::function<std::string(std::size_t)>& text_of);

/// Last time minus first time.
double seconds(const FrameSource& sequence);

/// Range of the times, "0.5 to 2 s", or a text that they are unknown.
std::string times_text(const FrameSource& sequence);

/// Warns about the assumed frame rate if the option `smoothness`, a time, is on and the times of
/// the input `name` are unknown.
void warn_of_guessed_rate(const Invocation& invocation, const std::string& name,
                          bool times_are_known);

enum class KeptInScenes { no, yes };

/// Warns that an output without expressions loses a model's expressions. A model without driving
/// weights is one frame at rest. Does not warn if the output is one mesh, or a file that holds the
/// expressions (.glb) if the operation keeps them there.
void warn_of_lost_expressions(const Invocation& invocation, const FrameSource& frames,
                              KeptInScenes kept);

/// Reports on head motion.
Json json_of(const HeadMotionTaken& motion);

/// Adds `converged` and `iteration` of a decomposition if they are known. The components are the
/// state of that iteration.
void add_convergence(Json& report, const Components& components);

/// Describes convergence as a part of a line: "30 iterations, not converged". \pre it is known
std::string convergence_text(const Components& components);

/// Report on regions: keys regions, vertices, triangles, vertex_share, ...; energy_share is null if
/// it is unknown.
Json report_of(const Regions& regions);
/// Report on regions for people, one line.
std::string summary_of(const Regions& regions);
/// Report on the regions that were added for a target's expressions.
Json added_regions(const Regions& regions);

/// Quality of a correspondence, as JSON and for people.
Json json_of(const MatchReport& match);
std::string summary_of(const MatchReport& match);

/// Openings of eyes and mouth on source and target, as JSON and for people.
Json json_of(const std::vector<ComparedOpening>& openings);
std::string summary_of(const std::vector<ComparedOpening>& openings);

/// Fields on the target's triangles: the distance from the deformed source (0 if it is far away)
/// and the number of partners.
std::vector<Field> fields_of(const Correspondence& pairs);

/// Table I, a row for each of `rows`.
Table table_of(const std::vector<EvaluationRow>& rows);

/// Quantities that operations print about a decomposition, regions and a transfer. docs/glossary.md
/// explains them.
std::vector<Measure> decomposition_measures();
std::vector<Measure> region_measures();
std::vector<Measure> transfer_measures();
std::vector<Measure> evaluation_measures();

}  // namespace mimetra
