#include <nlohmann/json.hpp>

#include "toolkit/correspondence/renumbering.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/simplification.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

BoundParameters<SimplifyOptions> simplify_parameters() {
  BoundParameters<SimplifyOptions> list;
  return list.add("share", SimplifyOptions::kShare, "of the vertices that are kept");
}

/// Progress at which the vertices are chosen; writing the frames takes the rest.
constexpr double kChoosing = 0.8;

/// Share of the surface at rest that is lost.
double lost_area(const Simplification& made, const FrameSource& given) {
  const double before = vertex_areas(given.rest(), given.triangles()).sum();
  const Positions kept = given.rest()(made.vertices, Eigen::all);
  return before > 0 ? 1 - vertex_areas(kept, made.connectivity->triangles).sum() / before : 0;
}

/// Warns about results that differ from the request.
void warn_of(const Simplification& made, const FieldSequence& given, double share,
             const Invocation& invocation) {
  const std::string& name = invocation.input("sequence").name;
  const double reached = static_cast<double>(made.vertices.size()) / given.frames->vertices();
  // Allows for rounding up, and for the last vertex that could not be removed.
  if (reached > 1.05 * share + 1e-3) {
    invocation.warn(name + ": " + percent(reached) + " of the vertices are left, expected " +
                    percent(share) + ": no more can go without a fold" +
                    (made.locked > 0 ? "; " + std::to_string(made.locked) +
                                           " are kept as they are on texture seams, at one place "
                                           "with others, or where the mesh is no manifold"
                                     : ""));
  }
  if (made.folded > 0) {
    invocation.warn(name + ": " + std::to_string(made.folded) +
                    " triangles are turned over in some frame; keep a larger share");
  }
  // Wrinkles and rounding lose less.
  constexpr double kLost = 0.05;
  if (const double lost = lost_area(made, *given.frames); lost > kLost) {
    invocation.warn(name + ": " + percent(lost) +
                    " of the surface is gone, since so few vertices cannot hold its shape; look at "
                    "it, and keep a larger share");
  }
  for (const Field& field : given.fields) {
    if (field.location == Field::Location::vertices) continue;
    invocation.warn(name + ": the field " + field.name +
                    " of its triangles is left out: they are others");
  }
}

Outcome run_simplify(const Invocation& invocation) {
  const NamedData& input = invocation.input("sequence");
  const auto& given = std::get<FieldSequence>(input.data);
  warn_of_lost_expressions(invocation, *given.frames, KeptInScenes::no);
  const SimplifyOptions options = simplify_parameters().read(invocation.parameters);
  const Simplification made =
      simplify(*given.frames, options, invocation.context.part(0, kChoosing));
  warn_of(made, given, options.share, invocation);
  FieldSequence simplified =
      held_like(given, renumbered(given.frames, made.connectivity, made.vertices),
                invocation.context.part(kChoosing, 1));
  for (const Field& field : given.fields) {
    if (field.location != Field::Location::vertices) continue;
    simplified.fields.push_back(renumbered(field, made.vertices));
  }
  Outcome outcome;
  const Json report = {{"frames", given.frames->frames()},
                       {"vertices", made.vertices.size()},
                       {"given_vertices", given.frames->vertices()},
                       {"triangles", made.connectivity->triangles.rows()},
                       {"locked_vertices", made.locked},
                       {"folded_triangles", made.folded}};
  outcome.report = report_with(report, "kept", made.vertices.size(),
                               [&made](std::size_t i) { return std::to_string(made.vertices[i]); });
  outcome.summary = std::to_string(made.vertices.size()) + " of " +
                    std::to_string(given.frames->vertices()) + " vertices, " +
                    std::to_string(made.connectivity->triangles.rows()) + " of " +
                    std::to_string(given.frames->triangles().rows()) + " triangles\n";
  outcome.outputs["out"].push_back({"", std::move(simplified), input.origin});
  return outcome;
}

}  // namespace

Operation simplify_operation() {
  Operation operation;
  operation.name = "simplify";
  operation.summary = "Keep some of a sequence's vertices, the same in all frames";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to simplify"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::sequence,
                        "the new sequence, of triangles; its manifest lists the vertices kept"}};
  operation.parameters = simplify_parameters().declared();
  operation.examples = {"simplify scan/ --share 0.25 -o small.npy",
                        "simplify take.pvd --share 0.1 -o preview.glb"};
  operation.run = run_simplify;
  operation.memory = [](const Invocation& invocation) {
    const FieldSequence& sequence = invocation.get<FieldSequence>("sequence");
    return simplify_bytes(*sequence.frames) +
           (sequence.is_in_memory() ? frame_bytes(*sequence.frames) : 0);
  };
  return operation;
}

}  // namespace mimetra
