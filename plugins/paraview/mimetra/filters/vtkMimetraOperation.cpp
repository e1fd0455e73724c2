#include "vtkMimetraOperation.h"

#include <algorithm>

#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include <mimetra/operations/operation.h>
#include <mimetra/vtk/poly_data.h>

#include "host_output.h"
#include "operation_call.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraOperation);

vtkMimetraOperation::vtkMimetraOperation() : vtkMimetraFilter("convert", "sequence") {}

void vtkMimetraOperation::SetOperation(const char* name) {
  attempt([&] {
    auto call = std::make_unique<OperationCall>(name);
    if (call->operation().name == this->call().operation().name) return;
    const std::string input = call->operation().inputs.front().name;
    become(std::move(call), input);
    Modified();
  });
}

void vtkMimetraOperation::show(const Outcome& outcome, vtkPolyData& input, int frame,
                               vtkInformationVector* outputs) {
  const Data& made = outcome.outputs.at("out").front().data;
  const auto* fields = std::get_if<FieldSequence>(&made);
  const MeshSequence& sequence = fields ? fields->sequence : std::get<SequenceRead>(made).sequence;
  if (sequence.vertices() != input.GetNumberOfPoints()) {
    throw MismatchError("made " + std::to_string(sequence.vertices()) + " vertices, expected " +
                        std::to_string(input.GetNumberOfPoints()) +
                        " as in the input; use the command");
  }
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  show_shape(*output, input, sequence.frame(std::min(frame, sequence.frames() - 1)));
  if (!fields) return;
  for (const Field& field : fields->fields) add_field(*output, field, sequence.connectivity());
}
