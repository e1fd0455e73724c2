#include "plugins/c/plugin_operation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "plugins/c/interface.h"
#include "plugins/c/job.h"
#include "plugins/c/make_data.h"
#include "plugins/c/utf8.h"
#include "plugins/c/whole_struct.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// What every command takes besides what its operation declares.
constexpr std::array<std::string_view, 13> kTaken = {
    "h",    "help",     "q",       "quiet",  "v",     "verbose", "o",
    "json", "progress", "threads", "config", "force", "dry-run"};

/// Names are typed as commands and options: letters, digits and '-'.
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

/// Choices are typed in shells too: letters, digits, '-', '_' and '.'.
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

/// One line of text; empty for none.
std::string line_of(const char* text, const std::string& what) {
  const std::string_view line = text ? text : "";
  if (!is_line(line)) throw UsageError(what + ": its text is no line of UTF-8");
  return std::string(line);
}

template <typename Struct, typename Visit>
void for_each(const Struct* const* list, Visit visit) {
  for (; list && *list; ++list) visit(whole(**list));
}

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

void check_names(const Operation& operation) {
  const auto check = [](const std::string& name) {
    if (std::ranges::find(kTaken, name) != kTaken.end()) {
      throw UsageError("the name '" + name + "' is an option of every command");
    }
  };
  for (const Input& input : operation.inputs) check(input.name);
  for (const Output& output : operation.outputs) check(output.name);
  for (const Parameter& parameter : operation.parameters) check(parameter.name);
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

Outcome run(const mimetra_operation& described, const Operation& operation,
            const std::string& subject, const std::shared_ptr<const DescribedTable>& toolkit,
            const Invocation& invocation) {
  mimetra_job job(operation, invocation, toolkit);
  mimetra_status status = MIMETRA_FAILED;
  try {
    status = described.run(&toolkit_interface(), &job, described.user);
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
  const std::string subject = plugin + ": " + operation.name;
  operation.run = [described, operation, subject, toolkit](const Invocation& invocation) {
    return run(described, operation, subject, toolkit, invocation);
  };
  return operation;
}

}  // namespace mimetra
