#pragma once

#include <string_view>

namespace mimetra {

/// The 3D viewer of reports: JavaScript with all that it needs, and nothing that could end its
/// script element. Empty in a build without npm.
std::string_view viewer_script();

}  // namespace mimetra
