#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/correspondence/renumbering.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/rest_beyond_frames.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/whole_motion.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

namespace {

struct CheckCall {
  /// Fail if there is a warning.
  bool strict = false;

  static constexpr Option kStrict{"strict", &CheckCall::strict};
};

BoundParameters<CheckCall> check_parameters() {
  BoundParameters<CheckCall> list;
  return list.add("strict", CheckCall::kStrict, "fail where there is a warning (exit code 4)");
}

/// Adds the first of the found numbers: "3 WHAT, the first is 17".
std::string from(const std::vector<int>& found, const std::string& what) {
  return what + ", the first is " + std::to_string(found.front());
}

/// Warnings about the frames; reads all of them.
std::vector<std::string> frame_warnings(const std::shared_ptr<const FrameSource>& frames,
                                        const Context& context) {
  const FrameSource& sequence = *frames;
  const std::vector<FrameShape> shapes = frame_shapes(sequence, context);
  const OddFrames odd = odd_frames(sequence, shapes);
  std::vector<std::string> warnings;
  const double least = kLeastMotion * sequence.diameter();
  const bool moves = std::ranges::any_of(
      shapes, [least](const FrameShape& shape) { return shape.from_first > least; });
  if (sequence.frames() > 1 && !moves) {
    warnings.push_back("nothing moves: all " + std::to_string(sequence.frames()) +
                       " frames are equal to " + readable(kLeastMotion) + " of their diameter");
  }
  for (std::string& text : described(odd, shapes)) warnings.push_back(std::move(text));
  const WholeMotion whole =
      sequence.rest_is_known() ? whole_motion(sequence, context) : WholeMotion();
  if (whole.is_scaled()) {
    warnings.push_back("frames are " + readable(whole.scale, 3) +
                       " times as large as the rest pose");
  } else if (whole.moves()) {
    warnings.push_back("the whole mesh turns by up to " + readable(whole.angle, 3) +
                       " degrees and moves by up to " + readable(whole.shift, 3) +
                       " against the rest pose, " + percent(1 - whole.left_by_motion) +
                       " of all motion");
  } else if (sequence.rest_is_known()) {
    const RestBeyondFrames rest = rest_beyond_frames(frames, context);
    if (rest.is_of_other_face()) warnings.push_back(described(rest));
  }
  const double of_rest = spread(sequence.rest(), sequence.triangles());
  if (is_other_size(of_rest, odd.usual_spread)) {
    warnings.push_back("the rest pose is of another size than the frames: its vertices lie " +
                       readable(of_rest) + " from their mean (RMS), those of frames " +
                       readable(odd.usual_spread));
  }
  return warnings;
}

/// Warnings about legal meshes that are often mistakes.
std::vector<std::string> mesh_warnings(const FrameSource& sequence) {
  const MeshReport mesh = inspect(sequence.rest(), sequence.connectivity());
  std::vector<std::string> warnings;
  if (const auto& found = mesh.degenerate_triangles; !found.empty()) {
    warnings.push_back(from(found, counted(std::ssize(found), "triangle") +
                                       " without area (left out of distances and gradients)"));
  }
  if (mesh.nonmanifold_edges > 0) {
    warnings.push_back(counted(mesh.nonmanifold_edges, "edge") + " of more than two triangles");
  }
  if (mesh.almost_welded_vertices > 0) {
    warnings.push_back(described_almost_welded(mesh.almost_welded_vertices));
  }
  if (mesh.inconsistent_edges > 0) {
    warnings.push_back(counted(mesh.inconsistent_edges, "edge") +
                       " between triangles that are wound against each other: some faces are "
                       "turned, their normals point to the other side");
  }
  if (const auto& found = mesh.vertices_without_face; !found.empty()) {
    warnings.push_back(from(found, counted(std::ssize(found), "vertex", "vertices") +
                                       " without a face (in no region)"));
  }
  return warnings;
}

/// Warns if the mesh is numbered differently from `match`. Throws MismatchError for another mesh.
std::vector<std::string> numbering_warnings(const Invocation& invocation) {
  const auto* reference = invocation.find<FieldSequence>("match");
  if (!reference) return {};
  const NamedData& input = invocation.input("sequence");
  const std::string& name = invocation.input("match").name;
  const FrameSource& frames = *std::get<FieldSequence>(input.data).frames;
  if (same_faces(reference->frames->connectivity(), frames.connectivity())) return {};
  const Renumbering found =
      renumbering(TriMesh{reference->frames->rest(), reference->frames->connectivity()},
                  TriMesh{frames.rest(), frames.connectivity()});
  if (!found.found()) {
    throw MismatchError(input.name + ": " + found.summary() + " (as in " + name + ")");
  }
  return {found.summary() + " against " + name + " (convert --match writes it in its numbering)"};
}

Outcome run_check(const Invocation& invocation) {
  const NamedData& input = invocation.input("sequence");
  const std::shared_ptr<const FrameSource>& frames = std::get<FieldSequence>(input.data).frames;
  const FrameSource& sequence = *frames;
  std::vector<std::string> found = numbering_warnings(invocation);
  const std::vector<std::string> own = mesh_warnings(sequence);
  found.insert(found.end(), own.begin(), own.end());
  const std::vector<std::string> of_frames = frame_warnings(frames, invocation.context);
  found.insert(found.end(), of_frames.begin(), of_frames.end());
  // Reading has reported its notes already.
  std::vector<std::string> warnings = input.origin.notes;
  warnings.insert(warnings.end(), found.begin(), found.end());
  if (!warnings.empty() && check_parameters().read(invocation.parameters).strict) {
    throw MismatchError(
        input.name + ": " + warnings.front() +
        (warnings.size() > 1 ? "; and " + counted(std::ssize(warnings) - 1, "more warning") : ""));
  }
  for (const std::string& warning : found) invocation.warn(input.name + ": " + warning);
  return {{},
          json_text(Json{{"usable", true}, {"warnings", warnings}}),
          input.name + ": usable, " + counted(sequence.frames(), "frame") + " of " +
              counted(sequence.vertices(), "vertex", "vertices") +
              (warnings.empty() ? "" : ", " + counted(std::ssize(warnings), "warning")) + '\n'};
}

}  // namespace

Operation check_operation() {
  Operation operation;
  operation.name = "check";
  operation.summary = "Tell whether a sequence can be used, and what is odd about it";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to check"}};
  operation.inputs.front().streamed = true;
  operation.inputs.push_back({.name = "match",
                              .kind = DataKind::sequence,
                              .help = "a mesh that must be the same, and a warning where it is "
                                      "numbered differently",
                              .optional = true,
                              .streamed = true,
                              .shape = true});
  operation.parameters = check_parameters().declared();
  operation.examples = {"check takes/smile_%04d.obj --strict",
                        "check export.obj --match neutral.obj"};
  operation.run = run_check;
  return operation;
}

}  // namespace mimetra
