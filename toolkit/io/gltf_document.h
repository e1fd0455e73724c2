#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

/// What a glTF file says, as it says it. Internal to the format.
///
/// [Khronos. glTF 2.0 Specification. 2021]
namespace mimetra {

/// A view whose bytes are compressed. [EXT_meshopt_compression]
struct GltfCompression {
  enum class Mode { attributes, triangles, indices };
  enum class Filter { none, octahedral, quaternion, exponential };

  std::size_t buffer, offset, bytes, stride, count;
  Mode mode;
  Filter filter;
};

struct GltfView {
  std::size_t buffer, offset, bytes;
  std::size_t stride;  ///< 0 for numbers that stand close together
  std::optional<GltfCompression> compression;
};

/// Where numbers start.
struct GltfPlace {
  std::size_t view, offset;
};

/// Elements that replace others.
struct GltfSparse {
  std::size_t count;
  GltfPlace indices, values;
  int index_type;
};

struct GltfAccessor {
  std::optional<GltfPlace> place;  ///< zeros without one
  std::size_t count;
  int type;        ///< of a component: 5120 and so on
  int components;  ///< of an element
  bool normalized;
  std::optional<GltfSparse> sparse;
};

/// Attributes by their ids in the compressed mesh; none of those that their accessors hold.
/// [KHR_draco_mesh_compression]
struct GltfDraco {
  std::size_t view;
  std::optional<std::size_t> positions, texture;
  /// Joints and weights of each set of the primitive.
  std::vector<std::pair<std::optional<std::size_t>, std::optional<std::size_t>>> joints;
};

struct GltfPrimitive {
  int mode;
  std::optional<std::size_t> positions, texture, indices, material;
  /// Four joints of each vertex, and their weights; as many times as there are more.
  std::vector<std::pair<std::size_t, std::size_t>> joints;
  std::vector<std::optional<std::size_t>> targets;
  std::optional<GltfDraco> draco;
  /// Attributes that nothing here has a place for, by name.
  std::vector<std::string> unread;
  bool polygons;  ///< triangles that share their first corner are one polygon [FB_ngon_encoding]

  /// Equal for primitives that are faces on the same vertices.
  using Vertices = std::tuple<std::optional<std::size_t>, std::optional<std::size_t>,
                              std::vector<std::pair<std::size_t, std::size_t>>,
                              std::vector<std::optional<std::size_t>>>;
  Vertices vertices() const { return {positions, texture, joints, targets}; }
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<std::string> target_names;
  std::vector<double> weights;

  /// Of its primitives, which should all have as many.
  std::size_t most_targets() const;
};

struct GltfNode {
  std::string name;
  std::vector<std::size_t> children;
  std::optional<std::size_t> mesh, skin;
  Eigen::Matrix4d local;
  std::vector<double> weights;
};

struct GltfSkin {
  std::vector<std::size_t> joints;
  std::optional<std::size_t> inverse_bind;
};

struct GltfMaterial {
  std::string name;
  /// From stored to shown coordinates of the first of its pictures on TEXCOORD_0, its base colour
  /// before others. [KHR_texture_transform]
  Eigen::Matrix<double, 2, 3> texture;
};

struct GltfChannel {
  std::size_t node;
  bool drives_weights;  ///< otherwise it moves the node
  std::size_t times, values;
  std::string interpolation;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfChannel> channels;
  /// Pointers to weights that no channel has a place for. [KHR_animation_pointer]
  std::vector<std::string> unread;
};

struct GltfDocument {
  std::string path, generator;
  std::vector<std::filesystem::path> files;
  std::size_t file_bytes = 0;
  /// Bytes of each buffer; none of one that only stands for what is decompressed.
  std::vector<std::string> buffers;
  /// What to say of those whose files are not there, by number, where one is needed.
  std::map<std::size_t, std::string> missing_buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<GltfMaterial> materials;
  std::vector<GltfAnimation> animations;
  std::vector<std::size_t> roots;
  /// False where the file says that its rest pose is only the first frame.
  bool rest_is_known = true;
  std::vector<std::string> notes;
};

/// Reads a .glb or .gltf with its buffers, which must lie in the file's own folder, or in the one
/// that it links to. Indices of
/// everything but vertices are sound. Throws IoError.
GltfDocument read_gltf_document(const std::filesystem::path& path);

}  // namespace mimetra
