#include "plugins/c/context_handle.h"

#include <algorithm>
#include <limits>

namespace mimetra {

DescribedTable::DescribedTable(const std::function<void(OperationTable&)>& fill) {
  fill(table_);
  json_ = table_.json();
  for (const Operation& operation : table_.operations()) describe(operation);
  for (const mimetra_operation& operation : operations_) list_.push_back(&operation);
  list_.push_back(nullptr);
  for (const Format& format : table_.formats()) describe(format);
  for (const mimetra_format& format : formats_) format_list_.push_back(&format);
  format_list_.push_back(nullptr);
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
const mimetra_port* DescribedTable::described(const Port& port, const std::string& help,
                                              bool named) {
  mimetra_port& made = ports_.emplace_back();
  made.struct_size = sizeof made;
  made.kind = static_cast<mimetra_kind>(port.kind) + MIMETRA_SEQUENCE;
  made.name = kept(port.name);
  made.help = kept(help);
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

/// List that ends with NULL.
const mimetra_parameter* const* DescribedTable::described(const std::vector<Parameter>& all,
                                                          const std::vector<Parameter>& reading,
                                                          const std::vector<Parameter>& writing) {
  const auto is_in = [](const std::vector<Parameter>& list, const Parameter& parameter) {
    return std::ranges::find(list, parameter.name, &Parameter::name) != list.end();
  };
  std::vector<const mimetra_parameter*>& list = parameter_lists_.emplace_back();
  for (const Parameter& parameter : all) {
    std::uint32_t of_files = 0;
    if (is_in(reading, parameter)) of_files |= MIMETRA_READING;
    if (is_in(writing, parameter)) of_files |= MIMETRA_WRITING;
    list.push_back(described(parameter, of_files));
  }
  list.push_back(nullptr);
  return list.data();
}

void DescribedTable::describe(const Format& format) {
  mimetra_format& made = formats_.emplace_back();
  made.struct_size = sizeof made;
  made.kind = static_cast<mimetra_kind>(format.kind) + MIMETRA_SEQUENCE;
  made.name = kept(format.name);
  made.extensions = kept(format.extensions);
  made.parameters = described(format.options(), format.reading, format.writing);
  if (format.fields) made.flags |= MIMETRA_WITH_FIELDS;
  if (format.read) made.use |= MIMETRA_READING;
  // Operations write weights of a sequence, but the value of a sequence is its poses.
  const bool is_of_value = !format.weights || format.kind == DataKind::table;
  if (format.write && is_of_value) made.use |= MIMETRA_WRITING;
}

void DescribedTable::describe(const Operation& operation) {
  mimetra_operation& made = operations_.emplace_back();
  made.struct_size = sizeof made;
  made.name = kept(operation.name);
  made.summary = kept(operation.summary);
  std::vector<const mimetra_port*>& inputs = port_lists_.emplace_back();
  for (const Input& input : operation.inputs) {
    inputs.push_back(described(input, table_.help(input), input.named));
  }
  inputs.push_back(nullptr);
  made.inputs = inputs.data();
  std::vector<const mimetra_port*>& outputs = port_lists_.emplace_back();
  for (const Output& output : operation.outputs) {
    outputs.push_back(described(output, table_.help(output), false));
  }
  outputs.push_back(nullptr);
  made.outputs = outputs.data();
  Operation reading, writing;
  reading.inputs = operation.inputs;
  writing.outputs = operation.outputs;
  made.parameters = described(table_.parameters_of(operation), table_.parameters_of(reading),
                              table_.parameters_of(writing));
  made.examples = kept(operation.examples);
}

}  // namespace mimetra
