#pragma once

#include <string>
#include <string_view>

namespace mimetra {

/// Throws IoError for a .vtp file that VTK would crash on, or whose counts cannot be true: other
/// types than VTK knows, more points, faces or values than so many bytes can hold, blocks and
/// offsets that lie outside of the file.
void check_vtp_header(const std::string& path, std::string_view text);

}  // namespace mimetra
