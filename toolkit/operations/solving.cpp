#include "toolkit/operations/solving.h"

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/stopwatch.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {

namespace {

const BlendshapeModel& model_of(const NamedData& target) {
  return std::get<BlendshapeModel>(target.data);
}

/// Beyond this the weights are hardly determined by the regions.
constexpr double kPoorCondition = 1e5;

void warn_of(const Invocation& invocation, const std::string& name,
             const BlendshapeConditions& conditions) {
  const std::string start = name + ": ";
  if (!conditions.unseen.empty()) {
    invocation.warn(
        start + std::to_string(conditions.unseen.size()) +
        " expressions do not move in the regions and stay 0: " + listed(conditions.unseen));
  }
  if (!conditions.weakly_seen.empty()) {
    invocation.warn(
        start + std::to_string(conditions.weakly_seen.size()) +
        " expressions are weakly seen in the regions: " + listed(conditions.weakly_seen));
  }
  if (conditions.condition > kPoorCondition) {
    invocation.warn(start + "the regions hardly tell the expressions apart (condition number " +
                    readable(conditions.condition, 2) +
                    "); take more regions (-k, --radius) or --full");
  }
}

void warn_of_degenerate(const Invocation& invocation, const std::string& name,
                        const Solution& solution) {
  const int source = solution.degenerate_source_triangles;
  const int target = solution.degenerate_target_triangles;
  if (source > 0) {
    invocation.warn(name + ": " + std::to_string(source) +
                    " degenerate triangles of the source take their neighbours' deformation");
  }
  if (target > 0) {
    invocation.warn(name + ": " + std::to_string(target) + " degenerate triangles of the target");
  }
}

Solution solve_blendshapes(const Invocation& invocation, const Alignment& source,
                           const NamedData& target, const Selection& selection,
                           const Progress& progress) {
  const Stopwatch stopwatch;
  const Parameters& parameters = invocation.parameters;
  const BlendshapeModel& model = model_of(target);
  const BlendshapeTransfer transfer(source.sequence.rest(), model, selection.triangles,
                                    {.ridge = parameters.number("ridge"),
                                     .sparsity = parameters.number("l1"),
                                     .smoothness = parameters.number("smoothness"),
                                     .threads = invocation.threads,
                                     .progress = progress});
  Solution solution;
  solution.weights = transfer.weights(source.sequence);
  solution.sequence = model.animate(solution.weights, source.sequence.times());
  solution.seconds = stopwatch.seconds();
  solution.conditions = transfer.conditions();
  warn_of(invocation, target.name, solution.conditions);
  solution.degenerate_source_triangles = solution.conditions.degenerate_source_triangles;
  solution.degenerate_target_triangles = solution.conditions.degenerate_target_triangles;
  warn_of_degenerate(invocation, target.name, solution);
  if (transfer.rest_looks_unneutral(source.sequence, solution.weights)) {
    invocation.warn(target.name +
                    ": many expressions want to be negative, so the source's rest pose is likely "
                    "not its neutral; give it with --source-rest FILE");
  }
  return solution;
}

VertexTransferOptions vertex_options(const Parameters& parameters, int vertices) {
  VertexTransferOptions options;
  options.triangle_weight =
      parameters.text("triangle-weight") == "area" ? TriangleWeight::area : TriangleWeight::unit;
  options.outside = parameters.text("outside") == "fixed" ? Outside::fixed : Outside::identity;
  options.outside_weight = parameters.number("outside-weight");
  options.outside_smoothness = parameters.number("outside-smoothness");
  const std::string& anchor = parameters.text("anchor");
  if (anchor == "centroid") options.anchor = Anchor::centroid;
  if (anchor != "centroid" && anchor != "source") {
    const Parameter vertex{"anchor", ParameterKind::integer, {}, "", "", 0};
    const auto number = std::get<std::int64_t>(parse_value(vertex, anchor));
    if (number >= vertices) {
      throw MismatchError("--anchor: vertex " + anchor + ", the mesh has " +
                          std::to_string(vertices) + " (0-based)");
    }
    options.anchor = Anchor::vertex;
    options.anchor_vertex = static_cast<VertexIndex>(number);
  }
  return options;
}

Solution solve_vertices(const Invocation& invocation, const Alignment& source,
                        const NamedData& target, const Selection& selection,
                        const Progress& progress) {
  const Stopwatch stopwatch;
  const BlendshapeModel& model = model_of(target);
  VertexTransferOptions options = vertex_options(invocation.parameters, model.vertices());
  options.inside = selection.inside;
  options.threads = invocation.threads;
  options.progress = progress;
  const bool all = selection.triangles.size() == static_cast<std::size_t>(model.triangles().rows());
  if (invocation.parameters.is_set("anchor") && options.outside == Outside::fixed && !all) {
    throw UsageError(
        "--anchor: vertices outside the regions are fixed already; use --outside identity or "
        "--full");
  }
  const VertexTransfer transfer(source.sequence.rest(), model.neutral(), model.triangles(),
                                selection.triangles, options);
  Solution solution;
  solution.sequence = MeshSequence(model.shared_connectivity(), transfer.frames(source.sequence),
                                   source.sequence.times(), model.neutral());
  solution.seconds = stopwatch.seconds();
  solution.degenerate_source_triangles = transfer.degenerate_source_triangles();
  solution.degenerate_target_triangles = transfer.degenerate_target_triangles();
  warn_of_degenerate(invocation, target.name, solution);
  return solution;
}

MeshSequence with_source_rest(const Invocation& invocation, const MeshSequence& sequence) {
  const std::string& name = invocation.inputs.at("source").front().name;
  const auto rest = invocation.parameters.optional_text("source-rest");
  if (!rest && sequence.rest_is_known()) return sequence;
  if (!rest) {
    invocation.warn(name +
                    ": its neutral is not known, the first frame stands in for it; give it with "
                    "--source-rest FILE");
    return sequence;
  }
  if (*rest == "neutral") {
    if (sequence.rest_is_known()) return sequence;
    throw MismatchError(name + ": its neutral is not known; give it with --source-rest FILE");
  }
  if (*rest == "first") return sequence.with_rest(sequence.frame(0));
  if (*rest == "mean") return sequence.with_rest(mean_pose(sequence));
  return sequence.with_rest(read_rest(*rest, sequence));
}

}  // namespace

std::vector<Parameter> solving_parameters() {
  return {
      {"source-rest",
       ParameterKind::file,
       {},
       "source's undeformed shape; default the neutral where it is known, else the first frame",
       "",
       {},
       {},
       {"neutral", "first", "mean"}},
      {"space",
       ParameterKind::choice,
       "auto",
       "solve for blendshape weights or vertices; auto: weights where the target has expressions",
       "",
       {},
       {},
       {"auto", "blendshape", "vertex"}},
      {"ridge", ParameterKind::number, 0.0, "pull of the weights towards 0", "", 0},
      {"l1", ParameterKind::number, 0.0, "sparsity of the weights", "", 0},
      {"smoothness", ParameterKind::number, 0.0, "time constant of smooth weights", "s", 0},
      {"triangle-weight",
       ParameterKind::choice,
       "unit",
       "vertex space: every triangle alike, or by area",
       "",
       {},
       {},
       {"unit", "area"}},
      {"outside",
       ParameterKind::choice,
       "fixed",
       "vertex space: vertices outside the regions stay, or triangles there keep their shape",
       "",
       {},
       {},
       {"fixed", "identity"}},
      {"outside-weight", ParameterKind::number, 0.1, "weight of --outside identity", "", 1e-12},
      {"outside-smoothness", ParameterKind::number, 0.0, "smoothness of --outside identity", "", 0},
      {"anchor", ParameterKind::text, "source",
       "vertex space: what holds a piece in place: source (its motion), centroid, or a vertex"},
  };
}

Alignment prepare_source(const Invocation& invocation) {
  const SequenceRead& read = invocation.get<SequenceRead>("source");
  return without_motion(invocation, read, with_source_rest(invocation, read.sequence));
}

void check_target(const MeshSequence& source, const NamedData& target) {
  const BlendshapeModel& model = model_of(target);
  if (model.vertices() != source.vertices()) {
    throw MismatchError(target.name + ": " + std::to_string(model.vertices()) +
                        " vertices, expected " + std::to_string(source.vertices()) +
                        " as in the source");
  }
  const int face = first_different_face(source.connectivity(), model.connectivity());
  if (face >= 0) {
    throw MismatchError(target.name + ": face " + std::to_string(face) +
                        " is not the source's; source and target need the same faces");
  }
}

Solution solve(const Invocation& invocation, const Alignment& source, const NamedData& target,
               const Selection& selection, const Progress& progress) {
  const std::string& space = invocation.parameters.text("space");
  const bool has_expressions = model_of(target).expressions().size() > 0;
  if (space == "blendshape" && !has_expressions) {
    throw MismatchError(target.name + ": has no expressions; use --space vertex");
  }
  return space == "vertex" || !has_expressions
             ? solve_vertices(invocation, source, target, selection, progress)
             : solve_blendshapes(invocation, source, target, selection, progress);
}

}  // namespace mimetra
