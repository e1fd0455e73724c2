#include "plugins/c/stored_data.h"

#include "toolkit/operations/loading.h"

namespace mimetra {

namespace {

/// Replaces what exists; no parameter of any operation.
const Parameter kForce = {"force", ParameterKind::flag, false, "replace what an earlier run wrote"};

Parameters parameters_of(std::vector<Parameter> declared, const char* const* settings) {
  Parameters parameters(std::move(declared));
  for (; settings && *settings; ++settings) {
    const std::string text = *settings;
    const auto end = text.find('=');
    const Parameter* parameter =
        end == std::string::npos ? nullptr : parameters.find(text.substr(0, end));
    if (!parameter) {
      std::string known;
      for (const Parameter& each : parameters.declared()) {
        known += (known.empty() ? "" : ", ") + each.name;
      }
      throw UsageError("setting '" + text + "': expected NAME=VALUE with one of " + known);
    }
    parameters.set(parameter->name, parse_value(*parameter, text.substr(end + 1)));
  }
  return parameters;
}

}  // namespace

NamedData loaded_data(const mimetra_context& context, DataKind kind, const std::string& text,
                      const char* const* settings) {
  if (kind == DataKind::regions) {
    throw UsageError(text + ": regions speak of a mesh; read them as an input of a call");
  }
  const OperationTable& table = context.table->operations();
  Operation reading;
  reading.inputs = {{"input", kind, ""}};
  reading.inputs.front().fields = reading.inputs.front().identities = true;
  const Parameters parameters = parameters_of(table.reader(kind, text).reading, settings);
  LoadedInputs loaded = load_inputs(table, reading, parameters, {{"input", {text}}}, context.log,
                                    {}, false, context.context);
  return std::move(loaded.data.at("input").front());
}

void write_data(const mimetra_context& context, const Data& data, const std::string& path,
                const char* const* settings) {
  const OperationTable& table = context.table->operations();
  Output output{"output", kind_of(data), ""};
  output.weights = output.kind == DataKind::table;
  const Format& format = table.writer(output, path);
  std::vector<Parameter> declared = format.writing;
  declared.push_back(kForce);
  const Parameters parameters = parameters_of(std::move(declared), settings);
  const WriteRequest request{path, parameters, parameters.flag("force")};
  for (const std::string& note : notes_on_losses(format, data, request)) {
    if (context.log) context.log(LogLevel::warning, note);
  }
  format.write(data, request, context.context);
}

}  // namespace mimetra
