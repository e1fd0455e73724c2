#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/formats/gltf/gltf_document.h"
#include "toolkit/mesh/frame_source.h"

/// Numbers of a glTF file, compressed or not. Internal to the format.
namespace mimetra {

/// Reads the numbers that accessors describe. Views are decompressed when they are first used.
/// Throws IoError if numbers are outside of their buffer.
class GltfValues {
 public:
  /// Keeps a reference to the document.
  explicit GltfValues(const GltfDocument& document) : document_(document) {}

  /// Numbers of an accessor (count x components); normalised integers are scaled. Throws IoError
  /// unless each element has `components` finite numbers and, if given, the count is `count`.
  Frames read(std::size_t accessor, int components, std::optional<Eigen::Index> count = {});
  /// Scales numbers that are stored outside the accessor if it normalises them.
  Frames scaled(std::size_t accessor, Frames stored) const;
  /// Indices below `size`.
  std::vector<int> indices(std::size_t accessor, Eigen::Index size);
  std::string_view bytes(std::size_t view);

 private:
  /// Elements of `type` from `place` on, unscaled.
  Frames stored(std::size_t accessor, const GltfPlace& place, std::size_t count, int components,
                int type);
  [[noreturn]] void fail(std::size_t accessor, const std::string& message) const;

  const GltfDocument& document_;
  std::map<std::size_t, std::string> decompressed_;
  std::size_t decompressed_bytes_ = 0;
};

/// Decompresses a view of meshoptimizer to compression.count elements of compression.stride bytes.
/// Messages call the view `what`. Throws IoError.
std::string decompressed(const std::string& path, const std::string& what,
                         const GltfCompression& compression, std::string_view bytes);

/// Four joints of each vertex and their weights (N x 4 each).
struct VertexJoints {
  Frames joints, weights;
};

/// Content of a primitive's compressed mesh. Integers are not scaled, because only their accessors
/// tell if they are normalised. Missing attributes have no rows.
struct DracoMesh {
  Triangles triangles;
  Frames positions;  ///< N x 3
  Frames texture;    ///< N x 2
  std::vector<VertexJoints> joints;
};

/// Decodes the attributes of `draco` from `bytes`. Messages call the mesh `what`. Throws IoError,
/// also if this program was built without Draco.
DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco& draco,
                       std::string_view bytes);

}  // namespace mimetra
