#include "samples/head/sample_operation.h"

#include <nlohmann/json.hpp>

#include "samples/head/head.h"
#include "toolkit/io/json_text.h"

namespace mimetra::samples {

namespace {

Outcome run(const Invocation&) {
  ModelData sample{parametric_head(), parametric_performance(), head_landmarks()};
  const MorphableModel& model = sample.model;
  Outcome outcome;
  outcome.report = json_text(Json{{"vertices", model.vertices()},
                                  {"expressions", model.expressions().names},
                                  {"identities", model.identities().names},
                                  {"frames", sample.performance.weights.rows()}});
  outcome.summary = "a head of " + std::to_string(model.vertices()) + " vertices with " +
                    std::to_string(model.expressions().size()) + " expressions and " +
                    std::to_string(model.identities().size()) +
                    " identities; performance.csv has " +
                    std::to_string(sample.performance.weights.rows()) + " frames\n";
  outcome.outputs["out"].push_back({"", std::move(sample)});
  return outcome;
}

}  // namespace

void add_sample(OperationTable& table) {
  Operation operation;
  operation.name = "sample";
  operation.summary = "Write the built-in sample: a head and a performance of 120 frames";
  operation.outputs = {{"out", DataKind::model, "folder of the model"}};
  operation.outputs.front().extensions = {""};  // a folder, which the identities need
  operation.examples = {
      "sample -o head/",
      "transfer head@identity001=1 head@identity002=1 --weights head/performance.csv -o out/"};
  operation.run = run;
  table.add(std::move(operation));
}

}  // namespace mimetra::samples
