#pragma once

#include <string>
#include <string_view>

#include "toolkit/io/gltf_document.h"

namespace mimetra {

/// The bytes of a view that was compressed by meshoptimizer: compression.count elements of
/// compression.stride bytes. `what` names it in messages. Throws IoError.
std::string decompressed(const std::string& path, const std::string& what,
                         const GltfCompression& compression, std::string_view bytes);

}  // namespace mimetra
