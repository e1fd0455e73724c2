#pragma once

#include <functional>
#include <string>

namespace mimetra {

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
