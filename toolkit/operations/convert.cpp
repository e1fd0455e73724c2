#include <optional>

#include <nlohmann/json.hpp>

#include "toolkit/correspondence/renumbering.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"
#include "toolkit/model/animation.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/operations/weight_tables.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

BoundParameters<UnitChange> convert_parameters() {
  BoundParameters<UnitChange> list;
  return list.add("scale", UnitChange::kScale, "multiply all positions: 0.001 makes mm to m")
      .add("up", UnitChange::kUp,
           "turn about x, so that what is up along y is up along z (y-to-z), or back (z-to-y)");
}

/// Describes a change of units: ", positions times 0.001, turned y-to-z".
std::string said(const UnitChange& change) {
  std::string text;
  if (change.scale != 1) text += ", positions times " + readable(change.scale);
  if (change.up != UpTurn::keep) text += ", turned " + std::string(choice_name(change.up));
  return text;
}

/// Parts of faces, in words, that one mesh has and the other lacks entirely.
std::vector<std::string> parts_of_faces(const Connectivity& faces, const Connectivity& others) {
  std::vector<std::string> parts;
  if (!faces.texture.coordinates.empty() && others.texture.coordinates.empty()) {
    parts.emplace_back("texture coordinates");
  }
  if (!named_faces(faces, FaceGroupKind::group).empty() &&
      named_faces(others, FaceGroupKind::group).empty()) {
    parts.emplace_back("groups");
  }
  if (!named_faces(faces, FaceGroupKind::material).empty() &&
      named_faces(others, FaceGroupKind::material).empty()) {
    parts.emplace_back("materials");
  }
  return parts;
}

/// Returns the frames on another mesh. Expressions still drive a model's frames.
std::shared_ptr<const FrameSource> on_mesh(const std::shared_ptr<const FrameSource>& frames,
                                           const std::shared_ptr<const Connectivity>& connectivity,
                                           const std::vector<VertexIndex>& vertices) {
  const auto* animation = dynamic_cast<const Animation*>(frames.get());
  if (!animation) return renumbered(frames, connectivity, vertices);
  return std::make_shared<const Animation>(animation->renumbered(connectivity, vertices));
}

/// Returns the sequence with the vertices and faces of `match`. Warns about parts that are lost.
FieldSequence matched(const Invocation& invocation, const NamedData& input,
                      const Renumbering& found) {
  const auto& given = std::get<FieldSequence>(input.data);
  const auto& reference = *invocation.get<FieldSequence>("match").frames;
  FieldSequence made =
      held_like(given, on_mesh(given.frames, reference.shared_connectivity(), found.vertices),
                invocation.context.without_ranks());
  const std::string& name = invocation.input("match").name;
  if (const auto lost = parts_of_faces(given.frames->connectivity(), reference.connectivity());
      !lost.empty()) {
    invocation.warn(input.name + ": its " + joined(lost, ", ", " and ") +
                    " are left out: the faces are those of " + name + ", which has none");
  }
  for (const Field& field : given.fields) {
    if (field.location == Field::Location::vertices) {
      made.fields.push_back(renumbered(field, found.vertices));
    } else {
      invocation.warn(input.name + ": the field " + field.name +
                      " of its triangles is left out: the faces are those of " + name);
    }
  }
  return made;
}

/// Returns how the sequence is numbered against `match`; empty without `match`. Throws
/// MismatchError for another mesh.
std::optional<Renumbering> renumbering_of(const Invocation& invocation, const NamedData& input) {
  const auto* reference = invocation.find<FieldSequence>("match");
  if (!reference) return {};
  const FrameSource& frames = *std::get<FieldSequence>(input.data).frames;
  Renumbering found =
      renumbering(TriMesh{reference->frames->rest(), reference->frames->connectivity()},
                  TriMesh{frames.rest(), frames.connectivity()});
  if (found.found()) return found;
  throw MismatchError(input.name + ": " + found.summary() + " (as in " +
                      invocation.input("match").name + ")");
}

/// Refuses options about positions and vertices if weights are written instead of poses.
void check_weights(const Invocation& invocation, const FrameSource& frames) {
  const auto paths = invocation.wanted.find("out");
  if (paths == invocation.wanted.end() || paths->second.empty()) return;
  const std::string path = paths->second.front().string();
  if (!is_weight_file(path)) return;
  for (const std::string name : {"scale", "up"}) {
    if (!invocation.parameters.is_set(name)) continue;
    throw UsageError("--" + name + ": " + path + " holds weights, which have no positions");
  }
  if (invocation.find<FieldSequence>("match")) {
    throw UsageError("--match: " + path + " holds weights, which have no vertices");
  }
  const auto* animation = dynamic_cast<const Animation*>(&frames);
  if (!animation) {
    throw UsageError(path +
                     ": holds weights, and none drive the sequence here; name a model with "
                     "--weights in a command, or another format");
  }
  check_live_link(invocation, "out", animation->model().expressions().names);
}

/// Returns frames that several processes read together; rank 0 stores and writes them.
std::shared_ptr<const FrameSource> read_by_all(std::shared_ptr<const FrameSource> frames,
                                               const Context& context) {
  if (context.ranks().rank() == 0) return stored(std::move(frames), context);
  const auto read_only = [](int, const Frames&) {};
  if (!frames->is_quick()) for_each_block(*frames, read_only, context);
  return frames;
}

Outcome run_convert(const Invocation& invocation) {
  NamedData input = invocation.input("sequence");
  check_weights(invocation, *std::get<FieldSequence>(input.data).frames);
  const std::optional<Renumbering> found = renumbering_of(invocation, input);
  if (found) input.data = matched(invocation, input, *found);
  const auto& given = std::get<FieldSequence>(input.data);
  const UnitChange change = convert_parameters().read(invocation.parameters);
  FieldSequence made = given;
  if (const auto frames = in_units(given.frames, change); frames != given.frames) {
    made = held_like(given, frames, invocation.context.without_ranks());
    made.fields = given.fields;
  }
  if (invocation.context.ranks().count() > 1) {
    made.frames = read_by_all(made.frames, invocation.context);
  }
  warn_of_lost_expressions(invocation, *made.frames, KeptInScenes::yes);
  Outcome outcome;
  Json report = Json{{"frames", made.frames->frames()},
                     {"vertices", made.frames->vertices()},
                     {"faces", made.frames->connectivity().polygons.size()},
                     {"seconds", seconds(*made.frames)},
                     {"times_known", made.frames->times_are_known()},
                     {"scale", change.scale},
                     {"up", choice_name(change.up)}};
  if (found) report["renumbered"] = found->moved();
  outcome.report = json_text(report);
  outcome.summary = counted(made.frames->frames(), "frame") + " of " +
                    counted(made.frames->vertices(), "vertex", "vertices") + ", " +
                    times_text(*made.frames) + said(change) +
                    (found ? ", " + found->summary() : "") + '\n';
  outcome.outputs["out"].push_back({"", std::move(made), input.origin});
  return outcome;
}

}  // namespace

Operation convert_operation() {
  Operation operation;
  operation.name = "convert";
  operation.summary = "Write a sequence in another format, or in another's numbering";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to convert"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.inputs.push_back({.name = "match",
                              .kind = DataKind::sequence,
                              .help = "the same mesh, whose numbering and faces are taken: found "
                                      "by its faces, refused where more than one fits",
                              .optional = true,
                              .streamed = true,
                              .shape = true});
  operation.outputs = {{"out", DataKind::sequence,
                        "the new sequence; .csv, .json and .livelink.csv hold a model's weights"}};
  operation.outputs.back().weights = true;
  operation.parameters = convert_parameters().declared();
  operation.examples = {"convert takes/smile_%04d.obj --match neutral.obj -o smile.npy",
                        "convert scan_mm/ --scale 0.001 --up z-to-y -o scan/"};
  operation.run = run_convert;
  operation.shared = true;
  operation.scratch = [](const Invocation& invocation) {
    const FrameSource& frames = *invocation.get<FieldSequence>("sequence").frames;
    const bool is_shared = invocation.context.ranks().count() > 1;
    return is_shared && !frames.is_quick() ? frame_bytes(frames) : 0;
  };
  return operation;
}

}  // namespace mimetra
