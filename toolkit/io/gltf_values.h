#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/gltf_document.h"
#include "toolkit/mesh/frame_source.h"

/// The numbers of a glTF file, compressed or not. Internal to the format.
namespace mimetra {

/// The numbers that a glTF file's accessors describe. Views are decompressed when they are needed.
/// Throws IoError for what does not lie in its buffer.
class GltfValues {
 public:
  /// Keeps a reference.
  explicit GltfValues(const GltfDocument& document) : document_(document) {}

  /// count x components, integers scaled as they are normalised. Throws IoError unless they are
  /// `components` each, and for what is not finite.
  Frames read(std::size_t accessor, int components);
  /// The same of `count` elements.
  Frames read(std::size_t accessor, int components, Eigen::Index count);
  /// Numbers that are stored elsewhere for an accessor, scaled as it normalises them.
  Frames scaled(std::size_t accessor, Frames stored) const;
  /// Indices below `size`.
  std::vector<int> indices(std::size_t accessor, Eigen::Index size);
  /// Bytes of a view.
  std::string_view bytes(std::size_t view);

 private:
  /// Elements of `type` that stand one after the other from `place` on.
  Frames stored(const std::string& what, const GltfPlace& place, Eigen::Index count, int components,
                int type);
  void replace_sparse(const std::string& what, const GltfAccessor& accessor, Frames& values);
  [[noreturn]] void fail(const std::string& what, const std::string& message) const;

  const GltfDocument& document_;
  std::map<std::size_t, std::string> decompressed_;
  std::size_t decompressed_bytes_ = 0;
};

/// The bytes of a view that was compressed by meshoptimizer: compression.count elements of
/// compression.stride bytes. `what` names it in messages. Throws IoError.
std::string decompressed(const std::string& path, const std::string& what,
                         const GltfCompression& compression, std::string_view bytes);

/// Four joints of each vertex, and their weights (N x 4).
struct VertexJoints {
  Frames joints, weights;
};

/// What a primitive's compressed mesh holds, integers as they are stored: its accessors say whether
/// they are normalised. Numbers that it does not hold have no rows.
struct DracoMesh {
  Triangles triangles;
  Frames positions;  ///< N x 3
  Frames texture;    ///< N x 2
  std::vector<VertexJoints> joints;
};

/// Decodes `bytes` with the attributes that `draco` names. `what` names the mesh in messages.
/// Throws IoError, also where this program was built without the library.
DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco& draco,
                       std::string_view bytes);

}  // namespace mimetra
