#include "plugins/c/plugin_format.h"

#include <algorithm>

#include "plugins/c/make_data.h"
#include "plugins/c/plugin_description.h"
#include "plugins/c/plugin_run.h"
#include "toolkit/io/missing_path.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/formats.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// As its functions know them.
constexpr auto kPath = "path", kValue = "value";

/// ".mesh": what the names of its files end in.
std::string extension_of(const char* extension, const std::string& what) {
  const std::string text = line_of(extension, what);
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (text.size() < 2 || text.front() != '.' || !std::all_of(text.begin() + 1, text.end(), fits)) {
    throw UsageError(what + " has the extension '" + text +
                     "', expected a dot and small letters, digits, '_' or '-'");
  }
  return text;
}

/// One run of a function: the file and the options that it has.
Invocation invocation_of(const std::string& path, const std::vector<Parameter>& options,
                         const Parameters& given, const Context& context) {
  std::vector<Parameter> declared = options;
  declared.push_back({kPath, ParameterKind::text, {}, ""});
  Invocation invocation;
  invocation.parameters = Parameters(std::move(declared));
  for (const Parameter& option : options) {
    invocation.parameters.set(option.name, given.value(option.name));
  }
  invocation.parameters.set(kPath, path);
  invocation.context = context;
  return invocation;
}

/// The value with all frames, as functions of plugins see it.
Data in_memory(const Data& data, const Context& context) {
  const auto* streamed = std::get_if<FieldSequence>(&data);
  if (!streamed || streamed->is_in_memory()) return data;
  return FieldSequence(MeshSequence(*streamed->frames, context.part(0, 0)), streamed->fields,
                       streamed->displacement);
}

/// What the one who reads it asked for.
void fit_to(const ReadRequest& request, const std::string& text, Data& data) {
  if (auto* sequence = std::get_if<FieldSequence>(&data); sequence && !request.fields) {
    sequence->fields.clear();
  }
  if (auto* held = std::get_if<ModelData>(&data); held && !request.identities) {
    *held = ModelData{MorphableModel(held->model.person())};
  }
  const auto* held = std::get_if<RegionData>(&data);
  if (held && held->regions.vertices != request.vertices) {
    throw MismatchError(text + ": regions of a mesh of " + std::to_string(held->regions.vertices) +
                        " vertices, expected " + std::to_string(request.vertices));
  }
}

ReadValue read_by(PluginFunction function, const Operation& operation, const std::string& text,
                  const ReadRequest& request, const Context& context) {
  if (!fs::exists(text)) fail_missing(text);
  function.subject = text + " (" + function.subject + ")";
  ReadValue read;
  Invocation invocation = invocation_of(text, operation.parameters, request.parameters, context);
  invocation.log = [&read](LogLevel level, const std::string& note) {
    if (level == LogLevel::warning) read.notes.push_back(note);
  };
  Outcome outcome = function(operation, invocation);
  read.value = std::move(outcome.outputs.at(kValue).front());
  read.value.name = text;
  read.files = {text};
  fit_to(request, text, read.value.data);
  return read;
}

std::vector<fs::path> write_by(PluginFunction function, const Operation& operation,
                               const Data& data, const WriteRequest& request,
                               const Context& context) {
  check_inputs_stay(request.target, request.inputs);
  function.subject = request.target.string() + " (" + function.subject + ")";
  return write_with_extra(request, [&]() -> std::vector<fs::path> {
    PendingOutputs outputs(request.overwrite, request.inputs, request.together);
    const fs::path file = outputs.add(request.target, PendingOutput::Kind::file);
    Invocation invocation = invocation_of(file, operation.parameters, request.parameters, context);
    invocation.inputs[kValue] = {{request.target.stem().string(), in_memory(data, context)}};
    function(operation, invocation);
    std::error_code unreadable;
    const auto bytes = fs::file_size(file, unreadable);
    if (unreadable || bytes == 0) {
      throw OutputError(function.subject, "wrote nothing");
    }
    outputs.commit();
    return {request.target};
  });
}

}  // namespace

Format plugin_format(const mimetra_format& described, const std::string& plugin,
                     const std::shared_ptr<const DescribedTable>& toolkit) {
  Format format;
  format.name = line_of(described.name, "a format");
  if (format.name.empty()) throw UsageError("a format has no name");
  const std::string what = "format '" + format.name + "'";
  format.kind = kind_of(described.kind);
  for (const char* const* extension = described.extensions; extension && *extension; ++extension) {
    format.extensions.push_back(extension_of(*extension, what));
  }
  if (format.extensions.empty()) throw UsageError(what + " has no extensions");
  if (!described.read && !described.write) {
    throw UsageError(what + " has no function to read or to write");
  }
  for_each(described.parameters, [&](const mimetra_parameter& one) {
    const Parameter parameter = parameter_of(one);
    check_not_taken(parameter.name);
    if (parameter.name == kPath) throw UsageError(what + ": the name 'path' is that of the file");
    if (one.of_files & MIMETRA_READING) format.reading.push_back(parameter);
    if (one.of_files & MIMETRA_WRITING) format.writing.push_back(parameter);
    if (one.of_files & (MIMETRA_READING | MIMETRA_WRITING)) return;
    throw UsageError(what + ": parameter '" + parameter.name +
                     "' is neither of reading nor of writing");
  });
  format.fields = (described.flags & MIMETRA_WITH_FIELDS) != 0;
  Operation operation;
  operation.name = format.name;
  if (described.read) {
    operation.parameters = format.reading;
    operation.outputs = {{kValue, format.kind, ""}};
    const PluginFunction read{described.read, described.user, plugin, toolkit};
    format.read = [read, operation](const std::string& text, const ReadRequest& request,
                                    const Context& context) {
      return read_by(read, operation, text, request, context);
    };
  }
  if (described.write) {
    operation.parameters = format.writing;
    operation.outputs.clear();
    operation.inputs = {{kValue, format.kind, ""}};
    const PluginFunction write{described.write, described.user, plugin, toolkit};
    format.write = [write, operation](const Data& data, const WriteRequest& request,
                                      const Context& context) {
      return write_by(write, operation, data, request, context);
    };
  }
  return format;
}

}  // namespace mimetra
