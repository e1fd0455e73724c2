#include "plugins/c/plugin_description.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "plugins/c/crossing.h"
#include "plugins/c/interface.h"
#include "plugins/c/job.h"
#include "plugins/c/make_data.h"
#include "toolkit/io/format.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

namespace {

/// Choices are also typed in shells, so they contain only letters, digits, '-', '_' and '.'.
std::string choice_of(const char* choice, const std::string& what) {
  const std::string_view text = choice;
  const auto fits = [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '-' || c == '_' || c == '.');
  };
  if (text.empty() || text.front() == '-' || !std::ranges::all_of(text, fits)) {
    throw UsageError(what + " has the choice '" + (is_line(text) ? std::string(text) : "") +
                     "', expected letters, digits, '-', '_' and '.', not '-' first");
  }
  return std::string(text);
}

/// Names are typed as commands and options, so they contain only small letters, digits and '-'.
std::string name_of(const char* name, const std::string& what) {
  const std::string_view text = name ? name : "";
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  if (text.empty() || text.front() < 'a' || text.front() > 'z' ||
      !std::ranges::all_of(text, fits)) {
    throw UsageError(what + " has the name '" + (is_line(text) ? std::string(text) : "") +
                     "', expected small letters, digits and '-'");
  }
  return std::string(text);
}

/// One line of text; empty for NULL.
std::string line_of(const char* text, const std::string& what) {
  const std::string_view line = text ? text : "";
  if (!is_line(line)) throw UsageError(what + ": its text is no line of UTF-8");
  return std::string(line);
}

Parameter parameter_of(const mimetra_parameter& described) {
  Parameter parameter{name_of(described.name, "a parameter"), ParameterKind::flag, {}, ""};
  const std::string what = "parameter '" + parameter.name + "'";
  if (described.kind < MIMETRA_FLAG || described.kind > MIMETRA_FILE) {
    throw UsageError(what + ": the kind " + std::to_string(described.kind) +
                     " is none of mimetra.h");
  }
  parameter.kind = static_cast<ParameterKind>(described.kind - MIMETRA_FLAG);
  parameter.help = line_of(described.help, what);
  parameter.unit = line_of(described.unit, what);
  if (described.minimum < described.maximum) {
    if (std::isfinite(described.minimum)) parameter.minimum = described.minimum;
    if (std::isfinite(described.maximum)) parameter.maximum = described.maximum;
  }
  const bool is_whole =
      parameter.kind == ParameterKind::integer || parameter.kind == ParameterKind::integer_list;
  if (is_whole) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    if (parameter.minimum) parameter.minimum = std::clamp(*parameter.minimum, -kMost, kMost);
    if (parameter.maximum) parameter.maximum = std::clamp(*parameter.maximum, -kMost, kMost);
  }
  for (const char* const* choice = described.choices; choice && *choice; ++choice) {
    parameter.choices.push_back(choice_of(*choice, what));
    if (std::ranges::count(parameter.choices, parameter.choices.back()) > 1) {
      throw UsageError(what + " has the choice '" + *choice + "' twice");
    }
  }
  if (parameter.kind == ParameterKind::choice && parameter.choices.empty()) {
    throw UsageError(what + " has no choices");
  }
  if (described.fallback) {
    parameter.fallback = parse_value(parameter, line_of(described.fallback, what));
  } else if (parameter.kind == ParameterKind::flag) {
    parameter.fallback = false;
  }
  return parameter;
}

/// Options of every command.
constexpr std::array<std::string_view, 13> kTaken = {
    "h",    "help",     "q",       "quiet",  "v",     "verbose", "o",
    "json", "progress", "threads", "config", "force", "dry-run"};

/// Throws UsageError if a name is an option of every command.
void check_not_taken(const std::string& name) {
  if (std::ranges::find(kTaken, name) == kTaken.end()) return;
  throw UsageError("the name '" + name + "' is an option of every command");
}

/// Calls `visit` with each struct of a list that ends with NULL.
template <typename Struct, typename Visit>
void for_each(const Struct* const* list, Visit visit) {
  for (; list && *list; ++list) visit(whole(**list));
}

/// Function of a plugin that runs as an operation.
struct PluginFunction {
  mimetra_run run;
  void* user;
  /// "the plugin: the operation", for messages.
  std::string subject;
  /// Operations that a run may call.
  std::shared_ptr<const DescribedTable> toolkit;

  /// Runs the function as `operation`. Errors of the plugin end the run with an exception that
  /// names the plugin, and have no other effect.
  Outcome operator()(const Operation& operation, const Invocation& invocation) const {
    mimetra_job job(operation, invocation, toolkit);
    mimetra_status status = MIMETRA_FAILED;
    try {
      status = run(&toolkit_interface(), &job, user);
    } catch (...) {
      if (job.cancelled()) throw Cancelled();
      const Failure failure = failure_of(std::current_exception());
      throw std::runtime_error(subject + ": threw an exception: " + failure.message);
    }
    const std::string& message = job.context().message;
    if (status != MIMETRA_OK) {
      if (job.cancelled()) throw Cancelled();
      throw_failure(status, subject, message.empty() ? "failed and does not say why" : message);
    }
    try {
      return std::move(job).outcome();
    } catch (const std::exception& error) {
      throw std::runtime_error(subject + ": " + error.what() +
                               (message.empty() ? "" : "; its last error: " + message));
    }
  }
};

template <typename Port>
Port port_of(const mimetra_port& port, const std::string& what) {
  Port made;
  made.name = name_of(port.name, what);
  made.kind = kind_of(port.kind);
  made.help = line_of(port.help, what + " '" + made.name + "'");
  made.optional = (port.flags & MIMETRA_OPTIONAL) != 0;
  made.repeated = (port.flags & MIMETRA_REPEATED) != 0;
  made.fields = (port.flags & MIMETRA_WITH_FIELDS) != 0;
  return made;
}

void check_names(const Operation& operation) {
  for (const Input& input : operation.inputs) check_not_taken(input.name);
  for (const Output& output : operation.outputs) check_not_taken(output.name);
  for (const Parameter& parameter : operation.parameters) check_not_taken(parameter.name);
}

/// On the command line, a repeated input takes all remaining words.
void check_repeated(const Operation& operation) {
  bool ended = false;
  for (const Input& input : operation.inputs) {
    const bool is_option = input.optional || input.named;
    if ((ended && !is_option) || (input.repeated && is_option)) {
      throw UsageError("input '" + input.name +
                       "': only the last one that is neither optional nor named can be repeated");
    }
    ended = ended || input.repeated;
  }
}

}  // namespace

Operation plugin_operation(const mimetra_operation& described, const std::string& plugin,
                           std::shared_ptr<const DescribedTable> toolkit) {
  Operation operation;
  operation.name = name_of(described.name, "an operation");
  operation.summary = line_of(described.summary, "operation '" + operation.name + "'");
  if (!described.run) throw UsageError("operation '" + operation.name + "' has no function to run");
  for_each(described.inputs, [&](const mimetra_port& port) {
    operation.inputs.push_back(port_of<Input>(port, "an input"));
    operation.inputs.back().named = (port.flags & MIMETRA_NAMED) != 0;
    operation.inputs.back().identities = true;
  });
  for_each(described.outputs, [&](const mimetra_port& port) {
    operation.outputs.push_back(port_of<Output>(port, "an output"));
  });
  for_each(described.parameters, [&](const mimetra_parameter& parameter) {
    operation.parameters.push_back(parameter_of(parameter));
  });
  for (const char* const* example = described.examples; example && *example; ++example) {
    operation.examples.push_back(line_of(*example, "an example"));
  }
  check_names(operation);
  check_repeated(operation);
  const PluginFunction function{described.run, described.user, plugin + ": " + operation.name,
                                std::move(toolkit)};
  operation.run = [function, operation](const Invocation& invocation) {
    return function(operation, invocation);
  };
  return operation;
}

namespace {

namespace fs = std::filesystem;

/// Names that functions of formats use for the file and the value.
constexpr auto kPath = "path", kValue = "value";

/// Ending of file names, as ".mesh".
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

/// Input of one run: the file and its options.
Invocation invocation_of(const std::string& path, const std::vector<Parameter>& options,
                         const Parameters* given, const Context& context) {
  std::vector<Parameter> declared = options;
  declared.push_back({kPath, ParameterKind::text, {}, ""});
  Invocation invocation;
  invocation.parameters = Parameters(std::move(declared));
  for (const Parameter& option : options) {
    if (given) invocation.parameters.set(option.name, given->value(option.name));
  }
  invocation.parameters.set(kPath, path);
  invocation.context = context;
  return invocation;
}

/// Drops data that the reader did not request, and checks the number of vertices.
void fit_to(const ReadOptions& options, const std::string& text, Data& data) {
  if (auto* sequence = std::get_if<FieldSequence>(&data); sequence && !options.fields) {
    sequence->fields.clear();
  }
  if (auto* held = std::get_if<ModelData>(&data); held && !options.identities) {
    *held = ModelData{MorphableModel(held->model.person())};
  }
  const auto* held = std::get_if<RegionData>(&data);
  if (held && held->regions.vertices != options.vertices) {
    throw MismatchError(text + ": regions of a mesh of " + std::to_string(held->regions.vertices) +
                        " vertices, expected " + std::to_string(options.vertices));
  }
}

ReadValue read_by(PluginFunction function, const Operation& operation, const std::string& text,
                  const ReadOptions& options, const Context& context) {
  if (!fs::exists(text)) fail_missing(text);
  function.subject = text + " (" + function.subject + ")";
  ReadValue read;
  Invocation invocation = invocation_of(text, operation.parameters, options.parameters, context);
  invocation.log = [&read](LogLevel level, const std::string& note) {
    if (level == LogLevel::warning) read.notes.push_back(note);
  };
  Outcome outcome = function(operation, invocation);
  read.value = std::move(outcome.outputs.at(kValue).front());
  read.value.name = text;
  read.files = {text};
  fit_to(options, text, read.value.data);
  return read;
}

Format::Paths write_by(PluginFunction function, const Operation& operation, const Data& data,
                       const fs::path& target, const WriteOptions& options,
                       const Context& context) {
  check_inputs_stay(target, options.inputs);
  function.subject = target.string() + " (" + function.subject + ")";
  return write_with_extra(target, options, [&]() -> Format::Paths {
    PendingOutputs outputs(options.overwrite, options.inputs, options.together);
    const fs::path file = outputs.add(target, PendingOutput::Kind::file);
    Invocation invocation = invocation_of(file, operation.parameters, options.parameters, context);
    // Functions of plugins cannot stream.
    invocation.inputs[kValue] = {{target.stem().string(), in_memory(data, context.part(0, 0))}};
    function(operation, invocation);
    std::error_code unreadable;
    const auto bytes = fs::file_size(file, unreadable);
    if (unreadable || bytes == 0) {
      throw OutputError(function.subject, "wrote nothing");
    }
    outputs.commit();
    return {target};
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
    format.read = [read, operation](const std::string& text, const ReadOptions& options,
                                    const Context& context) {
      return read_by(read, operation, text, options, context);
    };
  }
  if (described.write) {
    operation.parameters = format.writing;
    operation.outputs.clear();
    operation.inputs = {{kValue, format.kind, ""}};
    const PluginFunction write{described.write, described.user, plugin, toolkit};
    format.write = [write, operation](const Data& data, const fs::path& target,
                                      const WriteOptions& options, const Context& context) {
      return write_by(write, operation, data, target, options, context);
    };
  }
  return format;
}

}  // namespace mimetra
