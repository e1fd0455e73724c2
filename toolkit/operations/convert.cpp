#include <nlohmann/json.hpp>

#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"
#include "toolkit/operations/bound_parameters.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/times_text.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

BoundParameters<UnitChange> convert_parameters() {
  BoundParameters<UnitChange> list;
  return list.add("scale", UnitChange::kScale, "multiply all positions: 0.001 makes mm to m")
      .add("up", UnitChange::kUp,
           "turn about x, so that what is up along y is up along z (y-to-z), or back (z-to-y)");
}

/// ", times 0.001, turned y-to-z".
std::string said(const UnitChange& change) {
  std::string text;
  if (change.scale != 1) text += ", positions times " + readable(change.scale);
  if (change.up != UpTurn::keep) text += ", turned " + std::string(choice_name(change.up));
  return text;
}

Outcome run_convert(const Invocation& invocation) {
  const NamedData& input = invocation.input("sequence");
  const auto& given = std::get<FieldSequence>(input.data);
  const UnitChange change = convert_parameters().read(invocation.parameters);
  FieldSequence made = given;
  if (const auto frames = in_units(given.frames, change); frames != given.frames) {
    made =
        held_like(given, frames, {.threads = invocation.threads, .progress = invocation.progress});
    made.fields = given.fields;
  }
  Outcome outcome;
  outcome.report = json_text(Json{{"frames", made.frames->frames()},
                                  {"vertices", made.frames->vertices()},
                                  {"faces", made.frames->connectivity().polygons.size()},
                                  {"seconds", seconds(*made.frames)},
                                  {"times_known", made.frames->times_are_known()},
                                  {"scale", change.scale},
                                  {"up", choice_name(change.up)}});
  outcome.summary = std::to_string(made.frames->frames()) + " frames of " +
                    std::to_string(made.frames->vertices()) + " vertices, " +
                    times_text(*made.frames) + said(change) + '\n';
  outcome.outputs["out"].push_back({"", std::move(made), input.origin});
  return outcome;
}

}  // namespace

Operation convert_operation() {
  Operation operation;
  operation.name = "convert";
  operation.summary = "Write a sequence in another format; vertex order and faces stay as they are";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to convert"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::sequence, "the new sequence"}};
  operation.parameters = convert_parameters().declared();
  operation.examples = {"convert takes/smile_%04d.obj -o smile.npy",
                        "convert scan_mm/ --scale 0.001 --up z-to-y -o scan/"};
  operation.run = run_convert;
  return operation;
}

}  // namespace mimetra
