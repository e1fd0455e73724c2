#include "plugins/c/described_table.h"

#include <algorithm>
#include <limits>

namespace mimetra {

DescribedTable::DescribedTable(const std::function<void(OperationTable&)>& fill) {
  fill(table_);
  json_ = table_.json();
  for (const Operation& operation : table_.operations()) describe(operation);
  for (const mimetra_operation& operation : operations_) list_.push_back(&operation);
  list_.push_back(nullptr);
}

const mimetra_operation* DescribedTable::find(const std::string& name) const {
  const auto found = std::ranges::find_if(
      operations_, [&name](const mimetra_operation& operation) { return name == operation.name; });
  return found == operations_.end() ? nullptr : &*found;
}

const char* DescribedTable::kept(const std::string& text) {
  return texts_.emplace_back(text).c_str();
}

const char* const* DescribedTable::kept(const std::vector<std::string>& texts) {
  std::vector<const char*>& list = text_lists_.emplace_back();
  for (const std::string& text : texts) list.push_back(kept(text));
  list.push_back(nullptr);
  return list.data();
}

template <typename Port>
const mimetra_port* DescribedTable::described(const Port& port, bool named) {
  mimetra_port& made = ports_.emplace_back();
  made.struct_size = sizeof made;
  made.kind = static_cast<mimetra_kind>(port.kind) + MIMETRA_SEQUENCE;
  made.name = kept(port.name);
  made.help = kept(port.help);
  if (port.optional) made.flags |= MIMETRA_OPTIONAL;
  if (port.repeated) made.flags |= MIMETRA_REPEATED;
  if (port.fields) made.flags |= MIMETRA_WITH_FIELDS;
  if (named) made.flags |= MIMETRA_NAMED;
  return &made;
}

const mimetra_parameter* DescribedTable::described(const Parameter& parameter,
                                                   std::uint32_t of_files) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  mimetra_parameter& made = parameters_.emplace_back();
  made.struct_size = sizeof made;
  made.kind = static_cast<mimetra_parameter_kind>(parameter.kind) + MIMETRA_FLAG;
  made.name = kept(parameter.name);
  made.help = kept(parameter.help);
  if (!std::holds_alternative<std::monostate>(parameter.fallback)) {
    made.fallback = kept(to_text(parameter.fallback));
  }
  if (!parameter.unit.empty()) made.unit = kept(parameter.unit);
  made.minimum = parameter.minimum.value_or(-kOpen);
  made.maximum = parameter.maximum.value_or(kOpen);
  if (!parameter.choices.empty()) made.choices = kept(parameter.choices);
  made.of_files = of_files;
  return &made;
}

void DescribedTable::describe(const Operation& operation) {
  mimetra_operation& made = operations_.emplace_back();
  made.struct_size = sizeof made;
  made.name = kept(operation.name);
  made.summary = kept(operation.summary);
  std::vector<const mimetra_port*>& inputs = port_lists_.emplace_back();
  for (const Input& input : operation.inputs) inputs.push_back(described(input, input.named));
  inputs.push_back(nullptr);
  made.inputs = inputs.data();
  std::vector<const mimetra_port*>& outputs = port_lists_.emplace_back();
  for (const Output& output : operation.outputs) outputs.push_back(described(output, false));
  outputs.push_back(nullptr);
  made.outputs = outputs.data();
  std::vector<const mimetra_parameter*>& parameters = parameter_lists_.emplace_back();
  Operation reading, writing;
  reading.inputs = operation.inputs;
  writing.outputs = operation.outputs;
  const Parameters of_reading(table_.parameters_of(reading));
  const Parameters of_writing(table_.parameters_of(writing));
  for (const Parameter& parameter : table_.parameters_of(operation)) {
    std::uint32_t of_files = 0;
    if (of_reading.find(parameter.name)) of_files |= MIMETRA_READING;
    if (of_writing.find(parameter.name)) of_files |= MIMETRA_WRITING;
    parameters.push_back(described(parameter, of_files));
  }
  parameters.push_back(nullptr);
  made.parameters = parameters.data();
  made.examples = kept(operation.examples);
}

}  // namespace mimetra
