#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "toolkit/formats/gltf/gltf_bytes.h"

/// Content of a glTF file, as stored. Internal to the format.
///
/// [Khronos. glTF 2.0 Specification. 2021]
namespace mimetra {

/// Compressed bytes of a view. [EXT_meshopt_compression, KHR_meshopt_compression]
struct GltfCompression {
  enum class Mode { attributes, triangles, indices };
  enum class Filter { none, octahedral, quaternion, exponential, color };

  std::size_t buffer, offset, bytes, stride, count;
  Mode mode;
  Filter filter;
};

struct GltfView {
  std::size_t buffer, offset, bytes;
  std::size_t stride;  ///< 0 for elements without gaps
  std::optional<GltfCompression> compression;
};

struct GltfPlace {
  std::size_t view, offset;
};

/// Elements of an accessor that replace others.
struct GltfSparse {
  std::size_t count;
  GltfPlace indices, values;
  int index_type;
};

struct GltfAccessor {
  std::optional<GltfPlace> place;  ///< if none, the numbers are 0
  std::size_t count;
  int type;        ///< component type, 5120 to 5126
  int components;  ///< components per element
  bool normalized;
  std::optional<GltfSparse> sparse;
};

/// Ids of attributes in the compressed mesh. An attribute without an id is stored in its accessor.
/// [KHR_draco_mesh_compression]
struct GltfDraco {
  std::size_t view;
  std::optional<std::size_t> positions, texture;
  /// Ids of joints and weights, one pair for each set of the primitive.
  std::vector<std::pair<std::optional<std::size_t>, std::optional<std::size_t>>> joints;
};

struct GltfPrimitive {
  int mode;
  std::optional<std::size_t> positions, texture, indices, material;
  /// Accessors of joints and their weights. Each set has four joints per vertex.
  std::vector<std::pair<std::size_t, std::size_t>> joints;
  std::vector<std::optional<std::size_t>> targets;
  std::optional<GltfDraco> draco;
  std::vector<std::string> unread;  ///< attributes that are present but not read
  bool polygons;  ///< successive triangles with one first corner are a polygon [FB_ngon_encoding]

  /// Key that is equal for primitives that share their vertices.
  auto vertices() const { return std::tuple(positions, texture, joints, targets); }
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<std::string> target_names;
  std::vector<double> weights;
  /// Largest number of targets of its primitives; valid files have the same number in all.
  std::size_t most_targets;
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
  /// Maps stored texture coordinates to coordinates in the picture. Taken from the first picture on
  /// TEXCOORD_0; the base colour comes first. [KHR_texture_transform]
  Eigen::Matrix<double, 2, 3> texture;
};

struct GltfChannel {
  std::size_t node;
  bool drives_weights;  ///< false if it moves the node
  std::size_t times, values;
  std::string interpolation;
};

struct GltfAnimation {
  std::string name;
  std::vector<GltfChannel> channels;
  /// Pointers to weights that no channel can represent. [KHR_animation_pointer]
  std::vector<std::string> unread;
};

struct GltfDocument {
  std::string path, generator;
  std::vector<std::filesystem::path> files;
  std::size_t file_bytes;  ///< bytes of all files
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<GltfMaterial> materials;
  std::vector<GltfAnimation> animations;
  std::vector<std::size_t> roots;
  bool rest_is_known;  ///< false if the file says that its rest pose is only the first frame
  std::vector<std::string> notes;
};

/// Reads a .glb or .gltf with its buffers, which must be in the file's folder or in the folder of
/// its link target. Checks all indices except those of vertices. Throws IoError.
GltfDocument read_gltf_document(const std::filesystem::path& path);

}  // namespace mimetra
