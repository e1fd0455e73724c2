#pragma once

#include <functional>
#include <string>

#include "toolkit/mesh/note.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

// Translates messages of the pipeline to the spelling of the command's options.

/// Returns the invocation's context. Its notes become warnings that name helpful options. The
/// context copies the parameters and the log, so set these first.
Context with_notes_as_warnings(const Invocation& invocation);

/// Throws the command's error for an option that does not fit: UsageError or MismatchError.
[[noreturn]] void refuse(const OptionError& error, const Parameters& parameters);

/// Calls `work`, which uses the pipeline, and translates its errors to the command's options.
template <typename Work>
auto in_command_terms(const Parameters& parameters, const Work& work) {
  try {
    return work();
  } catch (const OptionError& error) {
    refuse(error, parameters);
  }
}

/// Returns a message with the options in a host's spelling. The message may mention options as
/// libraries do ("option 'overwrite'") or as operations do ("--source-rest", "-k"). `spelled`
/// receives the name without dashes. An unknown option keeps its spelling.
std::string with_options_spelled(const std::string& message,
                                 const std::function<std::string(const std::string&)>& spelled);

/// Spelling of an option on the command line: "--force" for 'overwrite', "-k" for 'k'.
std::string spelled_for_command(const std::string& option);

/// Spelling of an option in libraries: "option 'overwrite'".
std::string spelled_for_library(const std::string& option);

}  // namespace mimetra
