#include <cmath>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/bound_parameters.h"
#include "toolkit/mesh/subdivision.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

BoundParameters<SubdivideOptions> subdivide_parameters() {
  BoundParameters<SubdivideOptions> list;
  return list
      .add("scheme", SubdivideOptions::kScheme,
           "loop: on a smooth surface; midpoint: on the triangles as they are")
      .add("times", SubdivideOptions::kTimes, "how often each triangle becomes four");
}

Outcome run_subdivide(const Invocation& invocation) {
  const NamedData& input = invocation.input("sequence");
  const auto& given = std::get<FieldSequence>(input.data);
  warn_of_lost_expressions(invocation, *given.frames, KeptInScenes::no);
  const SubdivideOptions options = subdivide_parameters().read(invocation.parameters);
  const Subdivision finer = subdivide(given.frames->rest(), given.frames->connectivity(), options);
  FieldSequence made = held_like(given, subdivided(given.frames, finer), invocation.context);
  for (const Field& field : given.fields) {
    if (field.location == Field::Location::vertices && !field.integer) {
      made.fields.push_back({field.name, field.location, finer.weights * field.values});
    } else {
      invocation.warn(input.name + ": the field " + field.name +
                      " is left out: it has no values between those of the given mesh");
    }
  }
  Outcome outcome;
  outcome.report = json_text(Json{{"frames", made.frames->frames()},
                                  {"vertices", made.frames->vertices()},
                                  {"triangles", made.frames->triangles().rows()}});
  outcome.summary = std::to_string(made.frames->vertices()) + " vertices, " +
                    std::to_string(made.frames->triangles().rows()) + " triangles\n";
  outcome.outputs["out"].push_back({"", std::move(made), input.origin});
  return outcome;
}

}  // namespace

Operation subdivide_operation() {
  Operation operation;
  operation.name = "subdivide";
  operation.summary = "Make each triangle of a sequence four, the same in all frames";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to subdivide"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {
      {"out", DataKind::sequence, "the new sequence, of triangles; the given vertices come first"}};
  operation.parameters = subdivide_parameters().declared();
  operation.examples = {"subdivide take.npy -o smooth.npy",
                        "subdivide head.obj --scheme midpoint --times 2 -o fine.obj"};
  operation.run = run_subdivide;
  operation.memory = [](const Invocation& invocation) {
    // Weights, edges and faces per finer vertex, in bytes.
    constexpr double kOfVertex = 600;
    const FieldSequence& sequence = invocation.get<FieldSequence>("sequence");
    const double finer = std::pow(4.0, subdivide_parameters().read(invocation.parameters).times);
    return kOfVertex * finer * sequence.frames->vertices() +
           (sequence.is_in_memory() ? finer * frame_bytes(*sequence.frames) : 0);
  };
  return operation;
}

}  // namespace mimetra
