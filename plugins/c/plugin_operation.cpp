#include "plugins/c/plugin_operation.h"

#include "plugins/c/make_data.h"
#include "plugins/c/plugin_description.h"
#include "plugins/c/plugin_run.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

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

/// A command's words end where a repeated input begins.
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

}  // namespace mimetra
