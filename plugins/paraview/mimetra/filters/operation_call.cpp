#include "plugins/paraview/mimetra/filters/operation_call.h"

#include <algorithm>

#include "plugins/c/plugins.h"
#include "plugins/paraview/mimetra/filters/filter_proxies.h"
#include "toolkit/pipeline/analysis.h"
#include "toolkit/vtk/vtk_formats.h"

using namespace mimetra;

namespace {

OperationTable table_of_host() {
  OperationTable table;
  add_toolkit(table);
  add_vtp(table);
  // Their problems were reported when ParaView loaded the plugin.
  add_plugins(table, plugin_folders());
  return table;
}

/// Hosts pass integers, numbers and text. A flag is 0 or 1, and all other kinds are text.
ParameterValue value_of(const Parameter& parameter, const ParameterValue& shown) {
  const auto* text = std::get_if<std::string>(&shown);
  if (text) return parse_value(parameter, *text);
  const auto* number = std::get_if<std::int64_t>(&shown);
  if (number && parameter.kind == ParameterKind::flag) return *number != 0;
  return shown;
}

bool same_sequence(const MeshSequence& a, const MeshSequence& b) {
  return a.frames() == b.frames() && a.vertices() == b.vertices() &&
         a.rest_is_known() == b.rest_is_known() && a.times() == b.times() && a.rest() == b.rest() &&
         a.connectivity().polygons == b.connectivity().polygons && a.positions() == b.positions();
}

bool same_model(const BlendshapeModel& a, const BlendshapeModel& b) {
  return a.vertices() == b.vertices() && a.expressions().size() == 0 &&
         b.expressions().size() == 0 && a.neutral() == b.neutral() &&
         a.connectivity().polygons == b.connectivity().polygons;
}

bool same_data(const Data& a, const Data& b) {
  if (a.index() != b.index()) return false;
  if (const auto* shown = std::get_if<FieldSequence>(&a)) {
    const auto& other = std::get<FieldSequence>(b);
    return same_sequence(shown->sequence(), other.sequence()) &&
           std::ranges::equal(shown->fields, other.fields, same_field);
  }
  const auto* model = std::get_if<ModelData>(&a);
  return model && same_model(model->model.average(), std::get<ModelData>(b).model.average());
}

const Operation& found(const OperationTable& table, const std::string& name) {
  const Operation* operation = table.find(name);
  if (operation) return *operation;
  throw std::invalid_argument("there is no operation '" + name + "'; is its plugin missing?");
}

constexpr const char* kComponents = "components";
constexpr const char* kComponentsOut = "components-out";

}  // namespace

bool same_field(const Field& a, const Field& b) {
  const auto& x = a.values.array();
  const auto& y = b.values.array();
  return a.name == b.name && a.location == b.location && a.integer == b.integer &&
         x.rows() == y.rows() && x.cols() == y.cols() && (x == y || (x.isNaN() && y.isNaN())).all();
}

OperationCall::OperationCall(const std::string& name)
    : table_(table_of_host()), operation_(found(table_, name)) {}

OperationCall::OperationCall(Operation operation)
    : table_(table_of_host()), operation_(std::move(operation)) {}

bool OperationCall::has_input(const std::string& name) const {
  return std::ranges::find(operation_.inputs, name, &Input::name) != operation_.inputs.end();
}

bool OperationCall::is_of_decomposition(const std::string& name) const {
  const auto& own = table_.find("decompose")->parameters;
  return name == "source-rest" || std::ranges::find(own, name, &Parameter::name) != own.end();
}

bool OperationCall::is_default(const std::string& name, const ParameterValue& value) const {
  const auto declared = table_.parameters_of(operation_);
  const auto parameter = std::ranges::find(declared, name, &Parameter::name);
  if (parameter == declared.end()) return to_text(value).empty();
  const auto* number = std::get_if<std::int64_t>(&value);
  if (number && parameter->kind == ParameterKind::flag) {
    return parameter->fallback == ParameterValue(*number != 0);
  }
  return to_text(value) == to_text(parameter->fallback);
}

bool OperationCall::set(const std::string& name, const ParameterValue& value) {
  const auto old = values_.find(name);
  const bool restores = to_text(value).empty() || is_default(name, value);
  if (restores ? old == values_.end() : old != values_.end() && old->second == value) return false;
  if (restores) {
    values_.erase(name);
  } else {
    values_[name] = value;
  }
  outcome_.reset();
  if (is_of_decomposition(name)) components_.reset();
  return true;
}

bool OperationCall::looks_at_fields(const std::string& input) const {
  return std::ranges::find(operation_.inputs, input, &Input::name)->fields;
}

const Data* OperationCall::given(const std::string& input) const {
  const auto found = given_.find(input);
  return found == given_.end() ? nullptr : &found->second.data;
}

bool OperationCall::give(const std::string& input, NamedData data) {
  const auto old = given_.find(input);
  if (old != given_.end() && same_data(old->second.data, data.data)) return false;
  if (std::holds_alternative<FieldSequence>(data.data)) components_.reset();
  given_[input] = std::move(data);
  outcome_.reset();
  return true;
}

void OperationCall::take_back(const std::string& input) {
  if (given_.erase(input) > 0) outcome_.reset();
}

Parameters OperationCall::parameters() const {
  Parameters parameters(table_.parameters_of(operation_));
  for (const auto& [name, value] : values_) {
    if (has_input(name)) continue;
    const Parameter* declared = parameters.find(name);
    parameters.set(name, declared ? value_of(*declared, value) : value);
  }
  return parameters;
}

bool OperationCall::set_manifest(const std::string& path) {
  if (manifest_ == path) return false;
  manifest_ = path;
  outcome_.reset();
  return true;
}

void OperationCall::check_inputs() const {
  const std::vector<std::string> meshes = mesh_inputs(operation_);
  for (const Input& input : operation_.inputs) {
    const bool has_one = given_.contains(input.name) || values_.contains(input.name);
    if (input.optional || has_one) continue;
    const std::string label = label_of(input.name);
    const bool may_be_mesh = std::ranges::find(meshes, input.name) != meshes.end();
    throw UsageError(label + ": expected " +
                     (may_be_mesh
                          ? "a mesh at the port " + label + ", or a model as " + label + " File"
                          : input.help) +
                     ", found nothing");
  }
}

Call OperationCall::loaded(const Log& log, const Context& context) const {
  check_inputs();
  CallRequest request;
  request.operation = &operation_;
  request.parameters = parameters();
  for (const auto& [name, data] : given_) request.given[name] = {data};
  for (const auto& [name, value] : values_) {
    if (has_input(name)) request.named[name] = {to_text(value)};
  }
  if (!manifest_.empty()) request.manifest = Destination{manifest_, true};
  request.log = log;
  request.context = context;
  Call call(table_, std::move(request));
  call.load();
  if (components_ && !call.invocation().inputs.contains(kComponents)) {
    call.give(kComponents, *components_);
  }
  return call;
}

const Outcome& OperationCall::run(Call call, const std::vector<std::string>& wanted) {
  const bool has_components = call.invocation().inputs.contains(kComponents);
  for (const std::string& output : wanted) {
    if (!has_components || output != kComponentsOut) call.want(output);
  }
  call.run();
  call.write();
  Outcome& outcome = call.outcome();
  for (auto& [name, values] : outcome.outputs) {
    if (!std::holds_alternative<Components>(values.front().data)) continue;
    ++decompositions_;
    if (name == kComponentsOut) components_ = std::move(values.front());
  }
  return outcome_.emplace(std::move(outcome));
}
