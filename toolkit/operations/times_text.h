#pragma once

#include <string>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// The last time minus the first.
double seconds(const FrameSource& sequence);

/// "0.5 to 2 s"; or that nobody knows.
std::string times_text(const FrameSource& sequence);

/// Where the option `smoothness`, a time, is on and the input `name` says nothing of time, warns of
/// the rate that is taken for its.
void warn_of_guessed_rate(const Invocation& invocation, const std::string& name,
                          bool times_are_known);

}  // namespace mimetra
