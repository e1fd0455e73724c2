#pragma once

#include <string>
#include <string_view>

namespace mimetra {

/// Checks a .vtp file before VTK reads it. Throws IoError if VTK would crash on the file, or if its
/// counts cannot be true. This covers types that VTK does not know, and more points, faces or
/// values than the file's bytes can hold. It also covers blocks and offsets that lie outside the
/// file.
void check_vtp_header(const std::string& path, std::string_view text);

}  // namespace mimetra
