#include "plugins/paraview/mimetra/filters/reading.h"

#include "toolkit/mesh/text.h"
#include "toolkit/operations/formats.h"

using namespace mimetra;

Operation reading_operation() {
  Operation operation;
  operation.name = "read";
  operation.summary = "Mesh sequence or model of any format that mimetra reads";
  operation.inputs = {{"FileName", DataKind::sequence,
                       joined(sequence_files()) +
                           ", .pvd, or a model; typed, also a folder of meshes, a pattern as in "
                           "smile_%04d.obj, or MODEL@identity=1.5"}};
  operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::sequence, "the sequence"}};
  operation.run = [](const Invocation& invocation) {
    Outcome outcome;
    outcome.outputs["out"] = invocation.inputs.at("FileName");
    return outcome;
  };
  return operation;
}
