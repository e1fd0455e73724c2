#pragma once

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

}  // namespace mimetra
