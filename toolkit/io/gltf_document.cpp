#include "toolkit/io/gltf_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "toolkit/io/bytes.h"
#include "toolkit/io/gltf_json.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// True for extensions that are read, or that do not affect where surfaces are. A file may require
/// any of them.
bool is_known_extension(const std::string& extension) {
  static const std::vector<std::string> known = {
      "KHR_mesh_quantization", "EXT_meshopt_compression",    "KHR_meshopt_compression",
      "KHR_texture_transform", "FB_ngon_encoding",           "KHR_texture_basisu",
      "EXT_texture_webp",      "EXT_texture_avif",           "MSFT_texture_dds",
      "KHR_lights_punctual",   "KHR_draco_mesh_compression", "KHR_animation_pointer",
      "KHR_xmp_json_ld"};
  return extension.starts_with("KHR_materials_") ||
         std::find(known.begin(), known.end(), extension) != known.end();
}

/// The two chunks of a .glb. A .gltf is all JSON.
struct GltfChunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

std::uint32_t gltf_word(std::string_view bytes, std::size_t at) {
  return number_at<std::uint32_t>(bytes.data() + at, std::endian::little);
}

GltfChunks gltf_chunks(const std::string& path, std::string_view bytes) {
  constexpr std::string_view kMagic = "glTF";
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  if (!bytes.starts_with(kMagic)) return {bytes, std::nullopt};
  if (bytes.size() < kHeader) throw IoError(path, "is truncated in its header");
  if (gltf_word(bytes, 4) != 2) {
    throw IoError(
        path, "is glTF " + std::to_string(gltf_word(bytes, 4)) + ", and only version 2 is read");
  }
  const std::size_t length = gltf_word(bytes, 8);
  if (length > bytes.size()) {
    throw IoError(path, "is truncated: " + std::to_string(bytes.size()) + " bytes, expected " +
                            std::to_string(length));
  }
  GltfChunks chunks;
  for (std::size_t at = kHeader; at < length;) {
    if (length - at < kChunkHeader) throw IoError(path, "ends within the header of a chunk");
    const std::size_t size = gltf_word(bytes, at);
    const std::uint32_t type = gltf_word(bytes, at + 4);
    at += kChunkHeader;
    if (size > length - at) throw IoError(path, "a chunk is longer than the file");
    if (chunks.json.empty() && type != kJson) throw IoError(path, "does not start with JSON");
    if (type == kJson && chunks.json.empty()) chunks.json = bytes.substr(at, size);
    if (type == kBinary && !chunks.binary) chunks.binary = bytes.substr(at, size);
    at += size;
  }
  if (chunks.json.empty()) throw IoError(path, "holds no JSON");
  return chunks;
}

Json gltf_json(const std::string& path, std::string_view text) {
  // Some exporters pad with zeros; the specification requires spaces.
  while (text.ends_with('\0')) text.remove_suffix(1);
  return parse_json(path, text, "glTF");
}

void check_asset(const GltfValue& root) {
  const std::string version = root.at("asset").text_or("version", "");
  if (!version.starts_with("2.")) root.fail("is glTF " + version + ", and only 2.0 is read");
  for (const GltfValue& item : root.list("extensionsRequired")) {
    if (is_known_extension(item.text())) continue;
    root.fail("needs the extension " + item.text() + ", which is not read; export without it");
  }
}

int gltf_components(const GltfValue& accessor) {
  static const std::vector<std::pair<std::string, int>> kinds = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const std::string type = accessor.at("type").text();
  for (const auto& [name, components] : kinds) {
    if (name == type) return components;
  }
  accessor.fail("has type '" + type + "'");
}

int component_type_of(const GltfValue& value) {
  const std::size_t type = value.count("componentType");
  const bool known = type >= 5120 && type <= 5126 && type != 5124;
  if (!known) value.fail("has component type " + std::to_string(type));
  return static_cast<int>(type);
}

/// Compression of a view or buffer. Both names stand for the same content.
/// [EXT_meshopt_compression, KHR_meshopt_compression]
std::optional<GltfValue> meshopt_extension(const GltfValue& value) {
  const auto ratified = value.extension("KHR_meshopt_compression");
  return ratified ? ratified : value.extension("EXT_meshopt_compression");
}

GltfCompression gltf_compression(const GltfValue& value, std::size_t buffers) {
  GltfCompression compression{value.index("buffer", buffers), value.count_or("byteOffset", 0),
                              value.count("byteLength"),      value.count("byteStride"),
                              value.count("count"),           GltfCompression::Mode::attributes,
                              GltfCompression::Filter::none};
  const std::string mode = value.at("mode").text(), filter = value.text_or("filter", "NONE");
  if (mode == "TRIANGLES") {
    compression.mode = GltfCompression::Mode::triangles;
  } else if (mode == "INDICES") {
    compression.mode = GltfCompression::Mode::indices;
  } else if (mode != "ATTRIBUTES") {
    value.fail("has mode '" + mode + "'");
  }
  if (filter == "OCTAHEDRAL") {
    compression.filter = GltfCompression::Filter::octahedral;
  } else if (filter == "QUATERNION") {
    compression.filter = GltfCompression::Filter::quaternion;
  } else if (filter == "EXPONENTIAL") {
    compression.filter = GltfCompression::Filter::exponential;
  } else if (filter == "COLOR") {
    compression.filter = GltfCompression::Filter::color;
  } else if (filter != "NONE") {
    value.fail("has filter '" + filter + "'");
  }
  return compression;
}

GltfView gltf_view(const GltfValue& value, std::size_t buffers) {
  GltfView view{value.index("buffer", buffers),
                value.count_or("byteOffset", 0),
                value.count("byteLength"),
                value.count_or("byteStride", 0),
                {}};
  if (const auto extension = meshopt_extension(value)) {
    view.compression = gltf_compression(*extension, buffers);
  }
  return view;
}

GltfPlace gltf_place(const GltfValue& value, std::size_t views) {
  return {value.index("bufferView", views), value.count_or("byteOffset", 0)};
}

GltfAccessor gltf_accessor(const GltfValue& value, std::size_t views) {
  GltfAccessor accessor{{},
                        value.count("count"),
                        component_type_of(value),
                        gltf_components(value),
                        value.flag("normalized"),
                        {}};
  if (accessor.count == 0) value.fail("has no elements");
  if (value.has("bufferView")) accessor.place = gltf_place(value, views);
  if (value.has("sparse")) {
    const GltfValue sparse = value.at("sparse");
    accessor.sparse =
        GltfSparse{sparse.count("count"), gltf_place(sparse.at("indices"), views),
                   gltf_place(sparse.at("values"), views), component_type_of(sparse.at("indices"))};
    if (accessor.sparse->count > accessor.count) sparse.fail("replaces more than there is");
  }
  return accessor;
}

std::string joints_name(std::size_t set) {
  return "JOINTS_" + std::to_string(set);
}

std::string weights_name(std::size_t set) {
  return "WEIGHTS_" + std::to_string(set);
}

/// Accessors of joints and their weights, set by set.
std::vector<std::pair<std::size_t, std::size_t>> joint_sets(const GltfValue& attributes,
                                                            std::size_t size) {
  std::vector<std::pair<std::size_t, std::size_t>> sets;
  for (std::size_t set = 0;; ++set) {
    const auto joints = attributes.maybe_index(joints_name(set).c_str(), size);
    const auto weights = attributes.maybe_index(weights_name(set).c_str(), size);
    if (!joints || !weights) return sets;
    sets.emplace_back(*joints, *weights);
  }
}

GltfPrimitive gltf_primitive(const GltfValue& value, const GltfDocument& document,
                             std::size_t materials) {
  const std::size_t accessors = document.accessors.size();
  GltfPrimitive primitive{};
  const std::size_t mode = value.count_or("mode", 4);
  if (mode > 6) value.fail("has mode " + std::to_string(mode));
  primitive.mode = static_cast<int>(mode);
  const GltfValue attributes = value.at("attributes");
  primitive.positions = attributes.maybe_index("POSITION", accessors);
  primitive.texture = attributes.maybe_index("TEXCOORD_0", accessors);
  for (const char* name : {"TEXCOORD_1", "COLOR_0"}) {
    if (attributes.has(name)) primitive.unread.emplace_back(name);
  }
  primitive.joints = joint_sets(attributes, accessors);
  primitive.indices = value.maybe_index("indices", accessors);
  primitive.material = value.maybe_index("material", materials);
  for (const GltfValue& target : value.list("targets")) {
    primitive.targets.push_back(target.maybe_index("POSITION", accessors));
  }
  primitive.polygons = value.extension("FB_ngon_encoding").has_value();
  if (const auto draco = value.extension("KHR_draco_mesh_compression")) {
    const GltfValue ids = draco->at("attributes");
    for (const char* name : {"TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"}) {
      if (!ids.has(name) || attributes.has(name)) continue;
      ids.fail(std::string("names ") + name + ", which the primitive itself does not");
    }
    constexpr std::size_t kMostIds = std::numeric_limits<int>::max();
    primitive.draco = GltfDraco{draco->index("bufferView", document.views.size()),
                                ids.maybe_index("POSITION", kMostIds),
                                ids.maybe_index("TEXCOORD_0", kMostIds),
                                {}};
    for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
      primitive.draco->joints.emplace_back(ids.maybe_index(joints_name(set).c_str(), kMostIds),
                                           ids.maybe_index(weights_name(set).c_str(), kMostIds));
    }
  }
  return primitive;
}

/// Reads the names of targets. Other content of `extras` belongs to other programs.
std::vector<std::string> target_names(const GltfValue& value) {
  std::vector<std::string> names;
  if (!value.has("extras") || !value.at("extras").has("targetNames")) return names;
  const GltfValue given = value.at("extras").at("targetNames");
  if (!given.is_array()) return names;
  for (const GltfValue& name : given.items()) {
    names.push_back(name.is_text() ? name.name() : std::string());
  }
  return names;
}

GltfMesh gltf_mesh(const GltfValue& value, const GltfDocument& document, std::size_t materials) {
  GltfMesh mesh{value.name_or_nothing(), {}, target_names(value), value.numbers("weights")};
  for (const GltfValue& item : value.at("primitives").items()) {
    mesh.primitives.push_back(gltf_primitive(item, document, materials));
    if (mesh.target_names.empty()) mesh.target_names = target_names(item);
  }
  return mesh;
}

Eigen::Matrix4d gltf_transform(const GltfValue& value) {
  if (value.has("matrix")) {
    const auto columns = value.numbers_or<16>("matrix", {});
    return Eigen::Map<const Eigen::Matrix4d>(columns.data());
  }
  const auto move = value.numbers_or<3>("translation", {0, 0, 0});
  const auto turn = value.numbers_or<4>("rotation", {0, 0, 0, 1});
  const auto scale = value.numbers_or<3>("scale", {1, 1, 1});
  Eigen::Quaterniond rotation(turn[3], turn[0], turn[1], turn[2]);
  if (rotation.norm() == 0) value.fail("has no rotation of length 1");
  rotation.normalize();
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.translate(Eigen::Vector3d(move[0], move[1], move[2]));
  transform.rotate(rotation);
  transform.scale(Eigen::Vector3d(scale[0], scale[1], scale[2]));
  return transform.matrix();
}

GltfNode gltf_node(const GltfValue& value, const GltfDocument& document, std::size_t nodes,
                   std::size_t skins) {
  GltfNode node{value.name_or_nothing(),
                {},
                value.maybe_index("mesh", document.meshes.size()),
                value.maybe_index("skin", skins),
                gltf_transform(value),
                value.numbers("weights")};
  for (const GltfValue& child : value.list("children")) node.children.push_back(child.index(nodes));
  return node;
}

GltfSkin gltf_skin(const GltfValue& value, const GltfDocument& document) {
  GltfSkin skin{{}, value.maybe_index("inverseBindMatrices", document.accessors.size())};
  for (const GltfValue& joint : value.at("joints").items()) {
    skin.joints.push_back(joint.index(document.nodes.size()));
  }
  return skin;
}

/// Pictures of a material, its base colour first.
std::vector<GltfValue> gltf_pictures(const GltfValue& material) {
  std::vector<GltfValue> pictures;
  const auto add = [&pictures](const GltfValue& surface, const char* name) {
    if (surface.has(name)) pictures.push_back(surface.at(name));
  };
  const bool is_metallic = material.has("pbrMetallicRoughness");
  if (is_metallic) add(material.at("pbrMetallicRoughness"), "baseColorTexture");
  if (const auto glossy = material.extension("KHR_materials_pbrSpecularGlossiness")) {
    add(*glossy, "diffuseTexture");
    add(*glossy, "specularGlossinessTexture");
  }
  if (is_metallic) add(material.at("pbrMetallicRoughness"), "metallicRoughnessTexture");
  for (const char* name : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
    add(material, name);
  }
  return pictures;
}

GltfMaterial gltf_material(const GltfValue& value) {
  GltfMaterial material{value.name_or_nothing(), Eigen::Matrix<double, 2, 3>::Identity()};
  for (const GltfValue& picture : gltf_pictures(value)) {
    const auto transform = picture.extension("KHR_texture_transform");
    const std::size_t set = picture.count_or("texCoord", 0);
    if ((transform ? transform->count_or("texCoord", set) : set) != 0) continue;
    if (!transform) break;
    const auto offset = transform->numbers_or<2>("offset", {0, 0});
    const auto scale = transform->numbers_or<2>("scale", {1, 1});
    const double angle = transform->has("rotation") ? transform->at("rotation").number() : 0;
    const double c = std::cos(angle), s = std::sin(angle);
    material.texture << c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1],
        offset[1];
    break;
  }
  return material;
}

/// A node and the property that an animation changes.
struct GltfTarget {
  std::size_t node;
  std::string property;
};

/// Target of an animation channel; none for lights, materials and other targets that are not nodes.
std::optional<GltfTarget> gltf_target(const GltfValue& target, std::size_t nodes,
                                      std::vector<std::string>& unread) {
  if (target.has("node")) return GltfTarget{target.index("node", nodes), target.at("path").text()};
  const auto extension = target.extension("KHR_animation_pointer");
  if (!extension) return std::nullopt;
  const std::string pointer = extension->at("pointer").name();
  constexpr std::string_view kNodes = "/nodes/";
  if (pointer.starts_with(kNodes)) {
    std::size_t node = 0;
    const char* last = pointer.data() + pointer.size();
    const auto [end, error] = std::from_chars(pointer.data() + kNodes.size(), last, node);
    const std::string_view rest(end, static_cast<std::size_t>(last - end));
    const bool is_whole = error == std::errc() && rest.rfind('/') == 0;
    if (is_whole && node < nodes) return GltfTarget{node, std::string(rest.substr(1))};
  }
  if (pointer.find("/weights") != std::string::npos) unread.push_back("'" + pointer + "'");
  return std::nullopt;
}

GltfAnimation gltf_animation(const GltfValue& value, const GltfDocument& document) {
  GltfAnimation animation{value.name_or_nothing(), {}, {}};
  const std::vector<GltfValue> samplers = value.at("samplers").items();
  for (const GltfValue& channel : value.at("channels").items()) {
    const auto target = gltf_target(channel.at("target"), document.nodes.size(), animation.unread);
    if (!target) continue;
    const GltfValue& sampler = samplers[channel.index("sampler", samplers.size())];
    const std::size_t accessors = document.accessors.size();
    animation.channels.push_back(
        {target->node, target->property == "weights", sampler.index("input", accessors),
         sampler.index("output", accessors), sampler.text_or("interpolation", "LINEAR")});
  }
  return animation;
}

std::vector<std::size_t> gltf_roots(const GltfValue& root, GltfDocument& document) {
  const std::vector<GltfValue> scenes = root.list("scenes");
  std::vector<std::size_t> roots;
  if (scenes.empty()) {
    std::vector<bool> is_child(document.nodes.size(), false);
    for (const GltfNode& node : document.nodes) {
      for (const std::size_t child : node.children) is_child[child] = true;
    }
    for (std::size_t n = 0; n < is_child.size(); ++n) {
      if (!is_child[n]) roots.push_back(n);
    }
    return roots;
  }
  const std::size_t shown = root.has("scene") ? root.index("scene", scenes.size()) : 0;
  if (scenes.size() > 1) {
    document.notes.push_back(document.path + ": scene " + std::to_string(shown) + " of " +
                             std::to_string(scenes.size()) + " is read");
  }
  for (const GltfValue& node : scenes[shown].list("nodes")) {
    roots.push_back(node.index(document.nodes.size()));
  }
  return roots;
}

void read_gltf_buffers(const GltfValue& root, const std::optional<std::string_view>& binary,
                       GltfDocument& document) {
  for (const GltfValue& buffer : root.list("buffers")) {
    const std::size_t bytes = buffer.count("byteLength");
    std::string content;
    const bool is_chunk = !buffer.has("uri") && document.buffers.empty() && binary;
    // Fallback for programs that do not support the compression. Its bytes may be missing.
    const auto compression = meshopt_extension(buffer);
    const bool stands_for_another =
        compression && (compression->flag("fallback") || !(buffer.has("uri") || is_chunk));
    if (!stands_for_another && buffer.has("uri")) {
      GltfBuffer read = read_gltf_buffer(document.path, buffer.at("uri").text());
      if (read.file) document.files.push_back(*read.file);
      if (!read.missing.empty()) document.missing_buffers[document.buffers.size()] = read.missing;
      content = std::move(read.bytes);
    } else if (is_chunk && !stands_for_another) {
      content = std::string(*binary);
    } else if (!stands_for_another) {
      buffer.fail("has no 'uri'");
    }
    const bool is_needed =
        !stands_for_another && !document.missing_buffers.contains(document.buffers.size());
    if (content.size() < bytes && is_needed) {
      buffer.fail("is truncated: " + std::to_string(content.size()) + " bytes, expected " +
                  std::to_string(bytes));
    }
    if (content.size() > bytes) content.resize(bytes);
    document.file_bytes += content.size();
    document.buffers.push_back(std::move(content));
  }
}

}  // namespace

std::size_t GltfMesh::most_targets() const {
  std::size_t most = 0;
  for (const GltfPrimitive& primitive : primitives) {
    most = std::max(most, primitive.targets.size());
  }
  return most;
}

GltfDocument read_gltf_document(const fs::path& path) {
  GltfDocument document;
  document.path = path.string();
  document.files.push_back(path);
  const std::string bytes = read_file(path);
  document.file_bytes = bytes.size();
  const GltfChunks chunks = gltf_chunks(document.path, bytes);
  const Json json = gltf_json(document.path, chunks.json);
  const GltfValue root(document.path, "", json);
  check_asset(root);
  read_gltf_buffers(root, chunks.binary, document);
  const auto fill = [&root](auto& list, const char* name, const auto& made) {
    for (const GltfValue& value : root.list(name)) list.push_back(made(value));
  };
  const std::size_t skins = root.list("skins").size(), materials = root.list("materials").size();
  const std::size_t nodes = root.list("nodes").size();
  fill(document.views, "bufferViews",
       [&](const GltfValue& value) { return gltf_view(value, document.buffers.size()); });
  fill(document.accessors, "accessors",
       [&](const GltfValue& value) { return gltf_accessor(value, document.views.size()); });
  fill(document.materials, "materials", gltf_material);
  fill(document.meshes, "meshes",
       [&](const GltfValue& value) { return gltf_mesh(value, document, materials); });
  fill(document.nodes, "nodes",
       [&](const GltfValue& value) { return gltf_node(value, document, nodes, skins); });
  fill(document.skins, "skins", [&](const GltfValue& value) { return gltf_skin(value, document); });
  fill(document.animations, "animations",
       [&](const GltfValue& value) { return gltf_animation(value, document); });
  document.roots = gltf_roots(root, document);
  const GltfValue asset = root.at("asset");
  document.generator = asset.text_or("generator", "");
  document.rest_is_known = !(asset.has("extras") && asset.at("extras").flag("restIsFirstFrame"));
  return document;
}

}  // namespace mimetra
