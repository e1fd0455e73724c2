#include <nlohmann/json.hpp>

#include "toolkit/operations/formats.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

Operation convert_operation() {
  Operation operation;
  operation.name = "convert";
  operation.summary = "Write a sequence in another format; vertex order and faces stay as they are";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to convert"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::sequence, "the new sequence"}};
  operation.examples = {"convert takes/smile_%04d.obj -o smile.npy",
                        "convert actor@identity003=1.5 --weights take.csv --frames 0:300 -o take/"};
  operation.run = [](const Invocation& invocation) {
    const NamedData& input = invocation.input("sequence");
    const FrameSource& frames = *std::get<FieldSequence>(input.data).frames;
    Outcome outcome;
    outcome.outputs["out"].push_back({"", input.data, input.origin});
    outcome.report = json_text(Json{{"frames", frames.frames()},
                                    {"vertices", frames.vertices()},
                                    {"faces", frames.connectivity().polygons.size()}});
    outcome.summary = std::to_string(frames.frames()) + " frames of " +
                      std::to_string(frames.vertices()) + " vertices\n";
    return outcome;
  };
  return operation;
}

}  // namespace mimetra
