#include "plugins/paraview/mimetra/filters/vtkMimetraOperation.h"

#include <algorithm>
#include <stdexcept>

#include <vtkInformation.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkTable.h>

#include "plugins/paraview/mimetra/filters/filter_proxies.h"
#include "plugins/paraview/mimetra/filters/host_output.h"
#include "plugins/paraview/mimetra/filters/operation_call.h"
#include "plugins/paraview/mimetra/filters/time_steps.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/poly_data.h"

using namespace mimetra;

using Content = ShownOutput::Content;

vtkStandardNewMacro(vtkMimetraOperation);

namespace {

const MeshSequence& sequence_of(const Data& data) {
  return std::get<FieldSequence>(data).sequence();
}

/// First value of an output. Throws std::runtime_error if there is none.
const Data& made_by(const Outcome& outcome, const std::string& output) {
  const auto made = outcome.outputs.find(output);
  if (made != outcome.outputs.end() && !made->second.empty()) return made->second.front().data;
  throw std::runtime_error("the operation made nothing for its output '" + output + "'");
}

/// Returns whether two sequences on the same faces are equal. A result without a rest pose has the
/// input's.
bool same_shape(const MeshSequence& made, const MeshSequence& given) {
  return made.frames() == given.frames() && made.times() == given.times() &&
         made.positions() == given.positions() &&
         (!made.rest_is_known() || made.rest() == given.rest());
}

}  // namespace

vtkMimetraOperation::vtkMimetraOperation() : vtkMimetraFilter("convert") {}

void vtkMimetraOperation::SetOperation(const char* name) {
  attempt([&] {
    auto call = std::make_unique<OperationCall>(name);
    if (call->operation().name == this->call().operation().name) return;
    become(std::move(call));
    SetNumberOfOutputPorts(static_cast<int>(shown_outputs(this->call().operation()).size()));
    // The port information describes the outputs of the previous operation.
    for (int port = 0; port < GetNumberOfOutputPorts(); ++port) {
      GetOutputPortInformation(port)->Clear();
    }
    Modified();
  });
}

int vtkMimetraOperation::FillOutputPortInformation(int port, vtkInformation* info) {
  info->Set(vtkDataObject::DATA_TYPE_NAME(), moves(port) ? "vtkPolyData" : "vtkTable");
  return 1;
}

bool vtkMimetraOperation::moves(int port) const {
  const auto shown = shown_outputs(call().operation());
  return shown.at(static_cast<std::size_t>(port)).content == Content::mesh;
}

std::vector<std::string> vtkMimetraOperation::wanted_outputs(const Invocation&) {
  // The command makes some of these only when asked.
  std::vector<std::string> wanted;
  for (const ShownOutput& shown : shown_outputs(call().operation())) {
    if (shown.content != Content::report) wanted.push_back(shown.output);
  }
  return wanted;
}

void vtkMimetraOperation::prepare(const Outcome& outcome, vtkPolyData& input) {
  const ShownOutput first = shown_outputs(call().operation()).front();
  if (first.content == Content::mesh) prepare_mesh(outcome, input);
  if (first.content == Content::report) vtkOutputWindowDisplayText(outcome.summary.c_str());
}

void vtkMimetraOperation::show(const Outcome& outcome, vtkPolyData& input, double time,
                               vtkInformationVector* outputs) {
  int port = 0;
  for (const ShownOutput& shown : shown_outputs(call().operation())) {
    switch (shown.content) {
      case Content::mesh:
        show_made(outcome, input, time, *vtkPolyData::GetData(outputs, port));
        break;
      case Content::table:
        fill(*vtkTable::GetData(outputs, port), std::get<Table>(made_by(outcome, shown.output)));
        break;
      case Content::report:
        fill(*vtkTable::GetData(outputs, port), outcome.report);
        break;
    }
    ++port;
  }
}

void vtkMimetraOperation::prepare_mesh(const Outcome& outcome, vtkPolyData& input) {
  const Data& made = made_by(outcome, shown_outputs(call().operation()).front().output);
  const MeshSequence& sequence = sequence_of(made);
  std::vector<Field> fields = std::get<FieldSequence>(made).fields;
  if (!same_faces(sequence.connectivity(), connectivity_of(input, "the mesh"))) {
    shown_ = Shown::as_a_mesh_of_its_own;
    make_mesh(*shared_, sequence, fields);
    return;
  }
  const Data& given = *call().given(piped());
  const bool same = same_shape(sequence, sequence_of(given));
  shown_ = same ? Shown::on_the_input : Shown::in_another_shape;
  // Fields that the operation passed on belong to the input, where they may change over time.
  std::erase_if(fields, [&own = std::get<FieldSequence>(given).fields](const Field& field) {
    return std::ranges::any_of(own, [&](const Field& each) { return same_field(each, field); });
  });
  make_fields(*shared_, input, fields, sequence.connectivity());
}

void vtkMimetraOperation::show_made(const Outcome& outcome, vtkPolyData& input, double time,
                                    vtkPolyData& output) {
  const std::string name = shown_outputs(call().operation()).front().output;
  const MeshSequence& sequence = sequence_of(made_by(outcome, name));
  const int frame = frame_at(sequence, time);
  switch (shown_) {
    case Shown::on_the_input:
      output.ShallowCopy(&input);
      break;
    case Shown::in_another_shape:
      show_frame(output, input, sequence, frame);
      break;
    case Shown::as_a_mesh_of_its_own:
      show_mesh(output, *shared_, sequence, frame);
      return;
  }
  share_fields(*shared_, output);
}
