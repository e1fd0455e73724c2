#pragma once

#include <string>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// The last time minus the first.
double seconds(const FrameSource& sequence);

/// "0.5 to 2 s"; or that nobody knows.
std::string times_text(const FrameSource& sequence);

}  // namespace mimetra
