#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/operations/parameter.h"

namespace mimetra {

/// Options, inputs and outputs of an operation that do not go together:
///
///     {{"falloff", "regions-out"}, {"full"}, "there are no regions with --full"}
///
/// A term is the name of an input, an output or an option. It holds if the call has it: an output
/// that is asked for, a flag that is true, a list of files that names one, any other option that is
/// set. NAME=VALUE holds if the option has this value, also by default. A "!" negates a term.
struct Exclusion {
  /// None of these may hold
  std::vector<std::string> refused;
  /// beside one of these. "curve !per-region" holds if both parts do.
  std::vector<std::string> beside;
  std::string reason;
};

/// Whether a call has an input, or asks for an output, of this name.
using HasValue = std::function<bool(const std::string& name)>;

/// The message for the first term that is refused, "--falloff: there are no regions with --full";
/// none if all that the call has goes together.
std::optional<std::string> refusal(const std::vector<Exclusion>& exclusions,
                                   const Parameters& parameters, const HasValue& has_value);

/// All elements of some lists, in order.
template <typename Element>
std::vector<Element> concatenated(std::initializer_list<std::vector<Element>> lists) {
  std::vector<Element> all;
  for (const std::vector<Element>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace mimetra
