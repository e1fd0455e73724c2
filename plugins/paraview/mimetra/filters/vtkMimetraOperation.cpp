#include "plugins/paraview/mimetra/filters/vtkMimetraOperation.h"

#include <algorithm>
#include <stdexcept>

#include <vtkObjectFactory.h>

#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

vtkStandardNewMacro(vtkMimetraOperation);

namespace {

constexpr const char* kOut = "out";

const MeshSequence& sequence_of(const Data& data) {
  const auto* fields = std::get_if<FieldSequence>(&data);
  return fields ? fields->sequence : std::get<SequenceRead>(data).sequence;
}

/// Throws std::runtime_error where nothing was made.
const Data& made_by(const Outcome& outcome) {
  const auto made = outcome.outputs.find(kOut);
  if (made != outcome.outputs.end() && !made->second.empty()) return made->second.front().data;
  throw std::runtime_error("the operation made nothing for its output 'out'");
}

std::vector<Field> fields_in(const Data& data) {
  const auto* with_fields = std::get_if<FieldSequence>(&data);
  return with_fields ? with_fields->fields : std::vector<Field>();
}

/// On the same faces. What knows no rest pose has the other's.
bool same_shape(const MeshSequence& made, const MeshSequence& given) {
  return made.frames() == given.frames() && made.times() == given.times() &&
         made.positions() == given.positions() &&
         (!made.rest_is_known() || made.rest() == given.rest());
}

}  // namespace

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

std::vector<std::string> vtkMimetraOperation::wanted_outputs(const Invocation&) {
  // It may be one that the command only makes when asked.
  return {kOut};
}

void vtkMimetraOperation::prepare(const Outcome& outcome, vtkPolyData& input) {
  const Data& made = made_by(outcome);
  const MeshSequence& sequence = sequence_of(made);
  std::vector<Field> fields = fields_in(made);
  if (!same_faces(sequence.connectivity(), connectivity_of(input, "the mesh"))) {
    shown_ = Shown::as_a_mesh_of_its_own;
    make_mesh(*shared_, sequence, fields);
    return;
  }
  const Data& given = *call().given(call().operation().inputs.front().name);
  const bool same = same_shape(sequence, sequence_of(given));
  shown_ = same ? Shown::on_the_input : Shown::in_another_shape;
  // What was only handed on is the input's own, which may change over time.
  std::erase_if(fields, [own = fields_in(given)](const Field& field) {
    return std::ranges::any_of(own, [&](const Field& each) { return same_field(each, field); });
  });
  make_fields(*shared_, input, fields, sequence.connectivity());
}

void vtkMimetraOperation::show(const Outcome& outcome, vtkPolyData& input, double time,
                               vtkInformationVector* outputs) {
  const MeshSequence& sequence = sequence_of(made_by(outcome));
  const int frame = frame_at(sequence, time);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  switch (shown_) {
    case Shown::on_the_input:
      output->ShallowCopy(&input);
      break;
    case Shown::in_another_shape:
      show_frame(*output, input, sequence, frame);
      break;
    case Shown::as_a_mesh_of_its_own:
      show_mesh(*output, *shared_, sequence, frame);
      return;
  }
  share_fields(*shared_, *output);
}
