#include "toolkit/formats/gltf/gltf_values.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco&,
                       std::string_view) {
  throw IoError(path, what +
                          " is compressed by Draco, which this program was built without; export "
                          "it without compression, or build with libdraco-dev");
}

}  // namespace mimetra
