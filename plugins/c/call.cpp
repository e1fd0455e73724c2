#include "plugins/c/call.h"

#include <algorithm>

#include "toolkit/mesh/progress.h"
#include "toolkit/operations/loading.h"

using namespace mimetra;

namespace {

/// Reading files as a share of the progress.
constexpr double kReading = 0.3;

const Operation& operation_named(const OperationTable& table, const std::string& name) {
  const Operation* operation = table.find(name);
  if (operation) return *operation;
  std::string known;
  for (const Operation& each : table.operations()) known += (known.empty() ? "" : ", ") + each.name;
  throw UsageError("there is no operation '" + name + "'; there are " + known);
}

/// A sequence where it can stand for what is asked for: fields that are none, and the other way
/// round; otherwise the value itself.
NamedData as_kind(DataKind kind, const NamedData& value) {
  const auto* sequence = std::get_if<SequenceRead>(&value.data);
  if (sequence && kind == DataKind::fields) {
    return {value.name, FieldSequence{sequence->sequence, {}}};
  }
  const auto* fields = std::get_if<FieldSequence>(&value.data);
  if (fields && kind == DataKind::sequence) {
    return {value.name, SequenceRead{fields->sequence, false, {}, {}}};
  }
  return value;
}

bool serves_as(DataKind kind, const Data& data) {
  const auto found = static_cast<DataKind>(data.index());
  const auto has_frames = [](DataKind each) {
    return each == DataKind::sequence || each == DataKind::fields;
  };
  return found == kind || (has_frames(found) && has_frames(kind));
}

/// Throws UsageError for a value of a parameter of files where the inputs `read` are
/// none that it applies to: it would be ignored.
void check_parameters_of_files(const OperationTable& table, const Operation& operation,
                               const std::map<std::string, std::vector<std::string>>& read,
                               const std::map<std::string, ParameterValue>& values) {
  Operation reading;
  reading.parameters = operation.parameters;
  for (const Input& input : operation.inputs) {
    if (read.contains(input.name)) reading.inputs.push_back(input);
  }
  const Parameters used(table.parameters_of(reading));
  for (const auto& [name, value] : values) {
    if (used.find(name)) continue;
    throw UsageError("parameter '" + name +
                     "' speaks of files, and no input is read from one that it applies to; leave "
                     "it out");
  }
}

}  // namespace

mimetra_call::mimetra_call(mimetra_context& owner, const std::string& operation)
    : context_(owner),
      operation_(operation_named(owner.table->operations(), operation)),
      declared_(owner.table->operations().parameters_of(operation_)) {}

const Input& mimetra_call::input(const std::string& name) const {
  const auto found = std::ranges::find(operation_.inputs, name, &Input::name);
  if (found != operation_.inputs.end()) return *found;
  throw UsageError("operation '" + operation_.name + "' has no input '" + name + "'");
}

void mimetra_call::set(const std::string& parameter, const char* text) {
  const Parameter* declared = declared_.find(parameter);
  if (!declared) {
    throw UsageError("operation '" + operation_.name + "' has no parameter '" + parameter + "'");
  }
  if (text) {
    values_[parameter] = parse_value(*declared, text);
  } else {
    values_.erase(parameter);
  }
}

void mimetra_call::give(const std::string& name, std::shared_ptr<const Value> value) {
  const Input& declared = input(name);
  if (!serves_as(declared.kind, value->named().data)) {
    throw UsageError("input '" + name + "' of '" + operation_.name + "': expected the kind '" +
                     std::string(kind_name(declared.kind)) + "', found '" +
                     std::string(kind_name(static_cast<DataKind>(value->named().data.index()))) +
                     "'");
  }
  if (!declared.repeated) {
    given_[name].clear();
    read_.erase(name);
  }
  given_[name].push_back(std::move(value));
}

void mimetra_call::read(const std::string& name, const std::string& text) {
  if (!input(name).repeated) {
    given_.erase(name);
    read_[name].clear();
  }
  read_[name].push_back(text);
}

void mimetra_call::want(const std::string& name) {
  const auto& outputs = operation_.outputs;
  if (std::ranges::find(outputs, name, &Output::name) == outputs.end()) {
    throw UsageError("operation '" + operation_.name + "' has no output '" + name + "'");
  }
  wanted_[name];
}

void mimetra_call::check_inputs() const {
  for (const Input& declared : operation_.inputs) {
    const bool has_one = given_.contains(declared.name) || read_.contains(declared.name);
    if (has_one || declared.optional) continue;
    throw UsageError("operation '" + operation_.name + "' needs its input '" + declared.name +
                     "': " + declared.help);
  }
}

std::map<std::string, std::vector<NamedData>> mimetra_call::given() const {
  std::map<std::string, std::vector<NamedData>> copies;
  for (const auto& [name, values] : given_) {
    for (const auto& value : values) {
      copies[name].push_back(as_kind(input(name).kind, value->named()));
    }
  }
  return copies;
}

Invocation mimetra_call::invocation() const {
  check_inputs();
  check_parameters_of_files(context_.table->operations(), operation_, read_, values_);
  Invocation invocation;
  invocation.parameters = declared_;
  for (const auto& [name, value] : values_) invocation.parameters.set(name, value);
  const double read = read_.empty() ? 0 : kReading;
  invocation.inputs =
      load_inputs(context_.table->operations(), operation_, invocation.parameters, read_,
                  part_of(context_.progress, 0, read), context_.log, context_.threads, given())
          .data;
  invocation.wanted = wanted_;
  for (const Output& output : operation_.outputs) {
    if (!output.optional) invocation.wanted[output.name];
  }
  invocation.progress = part_of(context_.progress, read, 1);
  invocation.log = context_.log;
  invocation.threads = context_.threads;
  return invocation;
}

void mimetra_call::run() {
  outputs_.clear();
  report_.clear();
  summary_.clear();
  const Invocation asked = invocation();
  Outcome outcome = operation_.run(asked);
  for (auto& [name, values] : outcome.outputs) {
    if (!asked.wants(name)) continue;
    for (NamedData& value : values) {
      outputs_[name].push_back(std::make_shared<const Value>(std::move(value)));
    }
  }
  report_ = std::move(outcome.report);
  summary_ = std::move(outcome.summary);
}

const std::vector<std::shared_ptr<const Value>>& mimetra_call::output(
    const std::string& name) const {
  static const std::vector<std::shared_ptr<const Value>> none;
  const auto found = outputs_.find(name);
  return found == outputs_.end() ? none : found->second;
}
