#include "toolkit/operations/solving.h"

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {

namespace {

/// The unknowns; automatic: weights where the target has expressions.
enum class Space { automatic, blendshape, vertex };

constexpr std::string_view choice_name(Space value) {
  switch (value) {
    case Space::automatic:
      return "auto";
    case Space::blendshape:
      return "blendshape";
    case Space::vertex:
      return "vertex";
  }
  return {};
}

enum class SourceRest { neutral, first, mean };

constexpr std::string_view choice_name(SourceRest value) {
  switch (value) {
    case SourceRest::neutral:
      return "neutral";
    case SourceRest::first:
      return "first";
    case SourceRest::mean:
      return "mean";
  }
  return {};
}

/// What stands for an anchor besides the number of a vertex.
enum class AnchorWord { source, centroid };

constexpr std::string_view choice_name(AnchorWord value) {
  switch (value) {
    case AnchorWord::source:
      return "source";
    case AnchorWord::centroid:
      return "centroid";
  }
  return {};
}

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
  options.triangle_weight = parameters.choice<TriangleWeight>("triangle-weight");
  options.outside = parameters.choice<Outside>("outside");
  options.outside_weight = parameters.number("outside-weight");
  options.outside_smoothness = parameters.number("outside-smoothness");
  if (!parameters.is_set("anchor")) return options;
  const std::string& anchor = parameters.text("anchor");
  if (const auto word = choice_of<AnchorWord>(anchor)) {
    options.anchor = *word == AnchorWord::centroid ? Anchor::centroid : Anchor::source_motion;
  } else {
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
  const auto pose = choice_of<SourceRest>(*rest);
  if (!pose) return sequence.with_rest(read_rest(*rest, sequence));
  switch (*pose) {
    case SourceRest::neutral:
      if (sequence.rest_is_known()) return sequence;
      throw MismatchError(name + ": its neutral is not known; give it with --source-rest FILE");
    case SourceRest::first:
      return sequence.with_rest(sequence.frame(0));
    case SourceRest::mean:
      break;
  }
  return sequence.with_rest(mean_pose(sequence));
}

}  // namespace

std::vector<Parameter> solving_parameters() {
  return {
      file_parameter<SourceRest>(
          "source-rest", {},
          "source's undeformed shape; default the neutral where it is known, else the first frame"),
      choice_parameter("space", Space::automatic,
                       "solve for blendshape weights or vertices; auto: weights where the target "
                       "has expressions"),
      {"ridge", ParameterKind::number, BlendshapeTransferOptions{}.ridge,
       "pull of the weights towards 0", "", 0},
      {"l1", ParameterKind::number, BlendshapeTransferOptions{}.sparsity, "sparsity of the weights",
       "", 0},
      {"smoothness", ParameterKind::number, BlendshapeTransferOptions{}.smoothness,
       "time constant of smooth weights", "s", 0},
      choice_parameter("triangle-weight", VertexTransferOptions{}.triangle_weight,
                       "vertex space: every triangle alike, or by area"),
      choice_parameter(
          "outside", VertexTransferOptions{}.outside,
          "vertex space: vertices outside the regions stay, or triangles there keep their shape"),
      {"outside-weight", ParameterKind::number, VertexTransferOptions{}.outside_weight,
       "weight of --outside identity", "", 1e-12},
      {"outside-smoothness", ParameterKind::number, VertexTransferOptions{}.outside_smoothness,
       "smoothness of --outside identity", "", 0},
      {"anchor", ParameterKind::text, "source",
       "vertex space: what holds a piece in place: source (its motion), centroid, or a vertex"},
  };
}

bool solves_for_vertices(const Parameters& parameters, const BlendshapeModel& target) {
  return parameters.choice<Space>("space") == Space::vertex || target.expressions().size() == 0;
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
  const BlendshapeModel& model = model_of(target);
  const auto space = invocation.parameters.choice<Space>("space");
  if (space == Space::blendshape && model.expressions().size() == 0) {
    throw MismatchError(target.name + ": has no expressions; use --space vertex");
  }
  return solves_for_vertices(invocation.parameters, model)
             ? solve_vertices(invocation, source, target, selection, progress)
             : solve_blendshapes(invocation, source, target, selection, progress);
}

}  // namespace mimetra
