#pragma once

#include <functional>
#include <string>

#include "toolkit/mesh/note.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

// What the pipeline says, in the words of the command's options.

/// The invocation's context, whose notes become warnings that name the options which help. It keeps
/// copies of the parameters and of the log: set these first.
Context with_notes_as_warnings(const Invocation& invocation);

/// Throws what the command says where an option does not fit: UsageError, MismatchError.
[[noreturn]] void refuse(const OptionError& error, const Parameters& parameters);

/// Does `work` of the pipeline; its errors name the command's options.
template <typename Work>
auto in_command_terms(const Parameters& parameters, const Work& work) {
  try {
    return work();
  } catch (const OptionError& error) {
    refuse(error, parameters);
  }
}

/// A message in a host's words: what it says of options, "option 'overwrite'" as the libraries say
/// or "--source-rest" and "-k" as operations do, as `spelled` has it, given the name without
/// dashes. An unknown option stays as it was typed.
std::string with_options_spelled(const std::string& message,
                                 const std::function<std::string(const std::string&)>& spelled);

/// As the command has it: "--force" for 'overwrite', "-k" for 'k'.
std::string spelled_for_command(const std::string& option);

/// As the libraries say: "option 'overwrite'".
std::string spelled_for_library(const std::string& option);

}  // namespace mimetra
