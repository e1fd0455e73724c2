#include "plugins/c/job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"

using namespace mimetra;

namespace {

/// Sequence of a value; null for values of other kinds.
const MeshSequence* sequence_of(const Data& data) {
  const auto* shown = std::get_if<FieldSequence>(&data);
  return shown ? &shown->sequence() : nullptr;
}

/// Diameter of the rest pose; empty for values without one.
std::optional<double> diameter_of(const Data& data) {
  if (const MeshSequence* sequence = sequence_of(data)) return sequence->diameter();
  if (const auto* components = std::get_if<Components>(&data)) {
    return diameter(components->rest, components->triangles);
  }
  if (const auto* held = std::get_if<ModelData>(&data)) {
    return diameter(held->model.mean(), held->model.connectivity().triangles);
  }
  return {};
}

}  // namespace

mimetra_job::mimetra_job(const Operation& operation, const Invocation& invocation,
                         std::shared_ptr<const DescribedTable> table)
    : operation_(operation), invocation_(invocation), context_{std::move(table)} {
  context_.log = invocation.log;
  // The user can cancel the toolkit's operations that the plugin calls; their progress is hidden.
  context_.context =
      Context().with_threads(invocation.context.threads()).with_progress([this](double) {
        return goes_on();
      });
  for (const auto& [name, values] : invocation.inputs) {
    for (const NamedData& value : values) {
      inputs_[name].push_back(
          std::make_unique<mimetra_data>(mimetra_data{std::make_shared<const Value>(value)}));
    }
  }
  outcome_.report = "{}";
}

const mimetra_data* mimetra_job::input(const std::string& name, int index) const {
  const auto found = inputs_.find(name);
  if (found == inputs_.end() || index < 0) return nullptr;
  const auto i = static_cast<std::size_t>(index);
  return i < found->second.size() ? found->second[i].get() : nullptr;
}

double mimetra_job::number(const std::string& name) {
  const auto known = numbers_.find(name);
  return known != numbers_.end() ? known->second : numbers_[name] = number_of(name);
}

double mimetra_job::number_of(const std::string& name) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Parameter* parameter = invocation_.parameters.find(name);
  if (!parameter) return kNone;
  const ParameterValue& value = invocation_.parameters.value(name);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    return static_cast<double>(*integer);
  }
  if (const auto* number = std::get_if<double>(&value)) return *number;
  const bool has_length =
      parameter->kind == ParameterKind::length && !std::holds_alternative<std::monostate>(value);
  if (!has_length) return kNone;
  for (const Input& input : operation_.inputs) {
    const mimetra_data* data = this->input(input.name, 0);
    const auto diameter = data ? diameter_of(data->value->named().data) : std::nullopt;
    if (diameter) return invocation_.parameters.length(name).in(*diameter);
  }
  return kNone;
}

const char* mimetra_job::text(const std::string& name) {
  if (!invocation_.parameters.find(name)) return nullptr;
  const ParameterValue& value = invocation_.parameters.value(name);
  if (std::holds_alternative<std::monostate>(value)) return nullptr;
  return texts_.try_emplace(name, to_text(value)).first->second.c_str();
}

bool mimetra_job::goes_on() {
  try {
    invocation_.context.report(share_);
  } catch (const Cancelled&) {
    cancelled_ = true;
  }
  return !cancelled_;
}

void mimetra_job::progress(double share) {
  if (!std::isnan(share)) share_ = std::clamp(share, 0.0, 1.0);
  if (!goes_on()) throw Cancelled();
}

void mimetra_job::log(LogLevel level, const std::string& text) const {
  if (invocation_.log) invocation_.log(level, operation_.name + ": " + printable(text));
}

void mimetra_job::fail(const std::string& text) {
  context_.message = printable(text);
}

const MeshSequence* mimetra_job::given_mesh(const Connectivity& faces, std::size_t index) const {
  for (const Input& input : operation_.inputs) {
    const auto values = invocation_.inputs.find(input.name);
    const std::size_t i = input.repeated ? index : 0;
    if (values == invocation_.inputs.end() || i >= values->second.size()) continue;
    const MeshSequence* sequence = sequence_of(values->second[i].data);
    const bool fits = sequence && sequence->vertices() == faces.vertices &&
                      sequence->triangles().rows() == faces.triangles.rows() &&
                      sequence->triangles() == faces.triangles;
    if (fits) return sequence;
  }
  return nullptr;
}

void mimetra_job::output(const std::string& name, const NamedData& value) {
  const auto declared = std::ranges::find(operation_.outputs, name, &Output::name);
  if (declared == operation_.outputs.end()) {
    throw UsageError("operation '" + operation_.name + "' has no output '" + name + "'");
  }
  const auto kind = kind_of(value.data);
  if (kind != declared->kind) {
    throw UsageError("output '" + name + "': expected the kind '" +
                     std::string(kind_name(declared->kind)) + "', found '" +
                     std::string(kind_name(kind)) + "'");
  }
  NamedData& made = outcome_.outputs[name].emplace_back(value);
  auto* regions = std::get_if<RegionData>(&made.data);
  if (!regions || !regions->faces) return;
  // Regions are shown on a sequence among the inputs, like the toolkit's own regions.
  const MeshSequence* mesh = given_mesh(*regions->faces, outcome_.outputs[name].size() - 1);
  if (mesh) regions->fields = {*mesh, fields_of(regions->regions), true};
}

void mimetra_job::report(const std::string& json, const std::string& summary) {
  try {
    if (!parse_json("the report", json).is_object()) {
      throw UsageError("the report is no JSON object: " + printable(json));
    }
  } catch (const IoError& error) {
    throw UsageError(printable(error.what()));
  }
  if (!is_text(summary)) throw UsageError("the summary is no UTF-8: " + printable(summary));
  outcome_.report = json;
  outcome_.summary = summary;
  if (!summary.empty() && summary.back() != '\n') outcome_.summary += '\n';
}

std::size_t mimetra_job::expected_count(const Output& output) const {
  if (!output.repeated) return 1;
  for (const Input& input : operation_.inputs) {
    const auto values = inputs_.find(input.name);
    if (input.repeated && values != inputs_.end()) return values->second.size();
  }
  return 1;
}

Outcome mimetra_job::outcome() && {
  for (const Output& output : operation_.outputs) {
    const auto made = outcome_.outputs.find(output.name);
    const std::size_t count = made == outcome_.outputs.end() ? 0 : made->second.size();
    if (count == 0 && output.optional) continue;
    const std::size_t expected = expected_count(output);
    if (count == expected) continue;
    throw std::runtime_error("made " + std::to_string(count) + " values of its output '" +
                             output.name + "', expected " + std::to_string(expected));
  }
  return std::move(outcome_);
}
