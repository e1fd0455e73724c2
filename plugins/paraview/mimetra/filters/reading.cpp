#include "plugins/paraview/mimetra/filters/reading.h"

using namespace mimetra;

Operation reading_operation() {
  Operation operation;
  operation.name = "read";
  operation.summary = "Mesh sequence or model of any format that mimetra reads";
  operation.inputs = {{"FileName", DataKind::sequence,
                       "sequence or model, also .pvd; typed, also a pattern as in smile_%04d.obj, "
                       "or MODEL@identity=1.5"}};
  operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::sequence, "the sequence"}};
  operation.run = [](const Invocation& invocation) {
    Outcome outcome;
    outcome.outputs["out"] = invocation.inputs.at("FileName");
    return outcome;
  };
  return operation;
}
