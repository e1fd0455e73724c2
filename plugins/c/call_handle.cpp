#include "plugins/c/call_handle.h"

#include <algorithm>

#include "toolkit/operations/call.h"

using namespace mimetra;

namespace {

const Operation& operation_named(const OperationTable& table, const std::string& name) {
  const Operation* operation = table.find(name);
  if (operation) return *operation;
  std::string known;
  for (const Operation& each : table.operations()) known += (known.empty() ? "" : ", ") + each.name;
  throw UsageError("there is no operation '" + name + "'; there are " + known);
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
  check_kind(operation_, declared, value->named().data);
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

const Output& mimetra_call::declared_output(const std::string& name) const {
  const auto found = std::ranges::find(operation_.outputs, name, &Output::name);
  if (found != operation_.outputs.end()) return *found;
  throw UsageError("operation '" + operation_.name + "' has no output '" + name + "'");
}

void mimetra_call::want(const std::string& name) {
  wanted_.insert(declared_output(name).name);
}

void mimetra_call::write(const std::string& name, const std::string& path, bool overwrite) {
  want(name);
  destinations_[name] = {path, overwrite};
}

void mimetra_call::write_manifest(const std::string& path, bool overwrite) {
  manifest_ = Destination{path, overwrite};
}

CallRequest mimetra_call::request() const {
  CallRequest request;
  request.operation = &operation_;
  request.parameters = declared_;
  for (const auto& [name, value] : values_) request.parameters.set(name, value);
  for (const auto& [name, values] : given_) {
    for (const auto& value : values) request.given[name].push_back(value->named());
  }
  request.named = read_;
  request.wanted = wanted_;
  request.destinations = destinations_;
  request.manifest = manifest_;
  request.context = context_.context;
  request.log = context_.log;
  return request;
}

void mimetra_call::run() {
  outputs_.clear();
  report_.clear();
  summary_.clear();
  Call call(context_.table->operations(), request());
  call.load();
  call.run();
  call.write();
  Outcome& outcome = call.outcome();
  for (auto& [name, values] : outcome.outputs) {
    if (!call.invocation().wants(name)) continue;
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
