#include "toolkit/formats/gltf/gltf_document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// Extensions that are read, or that do not affect where surfaces are. A file may require them.
constexpr std::string_view kKnownGltfExtensions[] = {
    "KHR_mesh_quantization", "EXT_meshopt_compression",    "KHR_meshopt_compression",
    "KHR_texture_transform", "FB_ngon_encoding",           "KHR_texture_basisu",
    "EXT_texture_webp",      "EXT_texture_avif",           "MSFT_texture_dds",
    "KHR_lights_punctual",   "KHR_draco_mesh_compression", "KHR_animation_pointer",
    "KHR_xmp_json_ld"};

/// Reads the JSON of a file. Values have a place below another: "sparse/indices". Messages begin
/// with the item that is being read and the last place in it.
class GltfParser {
 public:
  GltfDocument read(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    document_.path = path.string();
    document_.files.push_back(path);
    document_.file_bytes = bytes.size();
    const GltfChunks chunks = gltf_chunks(document_.path, bytes);
    // Some exporters pad with zeros; the specification requires spaces.
    const auto json = chunks.json.substr(0, chunks.json.find_last_not_of('\0') + 1);
    const Json root = parse_json(document_.path, json, "glTF");
    try {
      read_root(root, chunks.binary);
    } catch (const Json::exception& error) {
      fail(json_reason(error));
    }
    return std::move(document_);
  }

 private:
  /// Refuses the value that was looked at last.
  [[noreturn]] void fail(const std::string& problem) const {
    const std::string dot = item_.empty() || place_.empty() ? "" : ".";
    throw IoError(document_.path, item_ + dot + place_ + ": " + problem);
  }
  /// Stands for a value that is missing; null in a file is a value.
  static const Json& none() {
    static const Json value;
    return value;
  }
  /// The value at a place, or `otherwise` if there is none.
  const Json& at(const Json& value, const std::string& place, const Json& otherwise = none()) {
    place_ = place;
    const Json::json_pointer pointer(place.empty() ? place : '/' + place);
    return value.contains(pointer) ? value.at(pointer) : otherwise;
  }
  bool has(const Json& value, const std::string& place) { return &at(value, place) != &none(); }
  const Json& required(const Json& value, const std::string& place,
                       const Json& otherwise = none()) {
    const Json& found = at(value, place, otherwise);
    if (&found == &none()) fail("is missing");
    return found;
  }
  double number(const Json& value, const std::string& place, const Json& otherwise = none()) {
    return required(value, place, otherwise).get<double>();
  }
  std::size_t count(const Json& value, const std::string& place, const Json& otherwise = none()) {
    constexpr double kMost = 9007199254740992.;  // whole numbers are exact up to here
    const double found = number(value, place, otherwise);
    if (found < 0 || found > kMost || found != std::floor(found)) fail("expected a count");
    return static_cast<std::size_t>(found);
  }
  std::size_t index(const Json& value, const std::string& place, std::size_t size) {
    const std::size_t found = count(value, place);
    if (found < size) return found;
    fail("is " + std::to_string(found) + ", but there are " + std::to_string(size));
  }
  std::optional<std::size_t> maybe_index(const Json& value, const std::string& place,
                                         std::size_t size) {
    if (!has(value, place)) return {};
    return index(value, place, size);
  }
  std::string text(const Json& value, const std::string& place, const Json& otherwise = none()) {
    return required(value, place, otherwise).get<std::string>();
  }
  /// Text of at most 1000 bytes, because names may be copied many times.
  std::string name(const Json& value, const std::string& place = "name") {
    constexpr std::size_t kLongest = 1000;
    std::string found = text(value, place, "");
    if (found.size() > kLongest) fail("has " + std::to_string(found.size()) + " bytes");
    return found;
  }
  /// Number of a word among known ones.
  std::size_t choice(const std::string& word, std::initializer_list<std::string_view> known) const {
    const auto found = std::ranges::find(known, word);
    if (found == known.end()) fail("is '" + word + "', which is not read");
    return static_cast<std::size_t>(found - known.begin());
  }
  bool flag(const Json& value, const std::string& place) {
    return at(value, place, false).get<bool>();
  }
  /// As many numbers as `otherwise` has, or any number of them if it is empty.
  std::vector<double> numbers(const Json& value, const std::string& place,
                              const std::vector<double>& otherwise) {
    auto found = at(value, place, otherwise).get<std::vector<double>>();
    if (otherwise.empty() || found.size() == otherwise.size()) return found;
    fail("has " + std::to_string(found.size()) + " numbers, expected " +
         std::to_string(otherwise.size()));
  }
  /// Reads each item of an array; none if it is missing.
  template <typename Read>
  auto items(const Json& value, const std::string& place, const Read& read) {
    const Json& list = at(value, place);
    if (&list != &none() && !list.is_array()) fail("expected an array");
    const std::string outer = item_, start = (outer.empty() ? "" : outer + '.') + place + '[';
    std::vector<decltype(read(list))> items;
    for (const Json& item : list) {
      item_ = start + std::to_string(items.size()) + ']';
      place_.clear();
      items.push_back(read(item));
    }
    item_ = outer;
    return items;
  }
  std::vector<std::size_t> indices(const Json& value, const std::string& place, std::size_t size) {
    if (!at(value, "").is_object()) fail("expected an object");
    return items(value, place, [&](const Json& item) { return index(item, "", size); });
  }

  /// Place of the compression of a view or buffer. Both names stand for the same content.
  /// [EXT_meshopt_compression, KHR_meshopt_compression]
  std::string meshopt(const Json& value) {
    const std::string ratified = "extensions/KHR_meshopt_compression";
    return has(value, ratified) ? ratified : "extensions/EXT_meshopt_compression";
  }

  GltfBuffer buffer(const Json& value, const std::optional<std::string_view>& binary) {
    GltfBuffer buffer;
    if (flag(value, meshopt(value) + "/fallback")) {
      buffer.missing = "a view needs a buffer that only stands for compressed data";
    } else if (has(value, "uri")) {
      buffer = read_gltf_buffer(document_.path, text(value, "uri"));
    } else if (binary) {
      buffer.bytes = *binary;
    } else {
      buffer.missing = "a view needs a buffer that has no 'uri'";
    }
    const std::size_t bytes = count(value, "byteLength"), held = buffer.bytes.size();
    if (held < bytes && buffer.missing.empty()) {
      fail("is truncated: " + std::to_string(held) + " bytes, expected " + std::to_string(bytes));
    }
    buffer.bytes.resize(std::min(held, bytes));
    document_.file_bytes += buffer.bytes.size();
    if (!buffer.file.empty()) document_.files.push_back(buffer.file);
    return buffer;
  }

  GltfView view(const Json& value) {
    const std::size_t buffers = document_.buffers.size();
    GltfView view{.buffer = index(value, "buffer", buffers),
                  .offset = count(value, "byteOffset", 0),
                  .bytes = count(value, "byteLength"),
                  .stride = count(value, "byteStride", 0),
                  .compression = {}};
    const Json& packed = at(value, meshopt(value));
    if (&packed == &none()) return view;
    const std::size_t mode = choice(text(packed, "mode"), {"ATTRIBUTES", "TRIANGLES", "INDICES"});
    const std::size_t filter = choice(text(packed, "filter", "NONE"),
                                      {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"});
    view.compression = GltfCompression{.buffer = index(packed, "buffer", buffers),
                                       .offset = count(packed, "byteOffset", 0),
                                       .bytes = count(packed, "byteLength"),
                                       .stride = count(packed, "byteStride"),
                                       .count = count(packed, "count"),
                                       .mode = GltfCompression::Mode(mode),
                                       .filter = GltfCompression::Filter(filter)};
    return view;
  }

  GltfPlace place(const Json& value) {
    return {index(value, "bufferView", document_.views.size()), count(value, "byteOffset", 0)};
  }
  int component_type(const Json& value) {
    const std::size_t type = count(value, "componentType");
    if (type >= 5120 && type <= 5126 && type != 5124) return static_cast<int>(type);
    fail("is " + std::to_string(type) + ", which is not a component type");
  }
  GltfAccessor accessor(const Json& value) {
    constexpr int kComponents[] = {1, 2, 3, 4, 4, 9, 16};
    const std::size_t shape =
        choice(text(value, "type"), {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
    GltfAccessor accessor{.place = {},
                          .count = count(value, "count"),
                          .type = component_type(value),
                          .components = kComponents[shape],
                          .normalized = flag(value, "normalized"),
                          .sparse = {}};
    if (has(value, "bufferView")) accessor.place = place(value);
    if (has(value, "sparse")) {
      const Json &indices = at(value, "sparse/indices"), &values = at(value, "sparse/values");
      accessor.sparse = GltfSparse{count(value, "sparse/count"), place(indices), place(values),
                                   component_type(indices)};
    }
    const std::size_t least = accessor.sparse ? accessor.sparse->count : 0;
    if (count(value, "count") >= std::max<std::size_t>(least, 1)) return accessor;
    fail("is " + std::to_string(accessor.count) + ", which is too few elements");
  }

  GltfPrimitive primitive(const Json& value) {
    constexpr std::size_t kModes = 7, kTriangles = 4, kMostIds = std::numeric_limits<int>::max();
    const std::size_t accessors = document_.accessors.size();
    const Json& attributes = required(value, "attributes");
    GltfPrimitive primitive{};
    primitive.mode = static_cast<int>(maybe_index(value, "mode", kModes).value_or(kTriangles));
    primitive.positions = maybe_index(attributes, "POSITION", accessors);
    primitive.texture = maybe_index(attributes, "TEXCOORD_0", accessors);
    for (const char* unread : {"TEXCOORD_1", "COLOR_0"}) {
      if (has(attributes, unread)) primitive.unread.emplace_back(unread);
    }
    primitive.indices = maybe_index(value, "indices", accessors);
    primitive.material = maybe_index(value, "material", document_.materials.size());
    primitive.targets = items(value, "targets", [&](const Json& target) {
      return maybe_index(target, "POSITION", accessors);
    });
    primitive.polygons = has(value, "extensions/FB_ngon_encoding");
    const Json& draco = at(value, "extensions/KHR_draco_mesh_compression");
    const bool is_packed = &draco != &none();
    const Json& ids = is_packed ? required(draco, "attributes") : draco;
    for (const char* own : {"TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"}) {
      if (!has(ids, own) || has(attributes, own)) continue;
      fail("is compressed, but the primitive does not have it");
    }
    if (is_packed) {
      primitive.draco = GltfDraco{index(draco, "bufferView", document_.views.size()),
                                  maybe_index(ids, "POSITION", kMostIds),
                                  maybe_index(ids, "TEXCOORD_0", kMostIds),
                                  {}};
    }
    for (std::size_t set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const auto joints = maybe_index(attributes, "JOINTS_" + number, accessors);
      const auto weights = maybe_index(attributes, "WEIGHTS_" + number, accessors);
      if (!joints || !weights) return primitive;
      primitive.joints.emplace_back(*joints, *weights);
      if (!primitive.draco) continue;
      primitive.draco->joints.emplace_back(maybe_index(ids, "JOINTS_" + number, kMostIds),
                                           maybe_index(ids, "WEIGHTS_" + number, kMostIds));
    }
  }

  /// Names of targets; empty for other content, which belongs to other programs.
  std::vector<std::string> target_names(const Json& value) {
    if (!at(value, "extras/targetNames").is_array()) return {};
    return items(value, "extras/targetNames", [&](const Json& item) {
      return item.is_string() ? name(item, "") : std::string();
    });
  }
  GltfMesh mesh(const Json& value) {
    GltfMesh mesh{name(value), {}, target_names(value), numbers(value, "weights", {}), 0};
    required(value, "primitives");
    mesh.primitives = items(value, "primitives", [&](const Json& item) {
      if (mesh.target_names.empty()) mesh.target_names = target_names(item);
      GltfPrimitive read = primitive(item);
      mesh.most_targets = std::max(mesh.most_targets, read.targets.size());
      return read;
    });
    return mesh;
  }

  Eigen::Matrix4d transform(const Json& value) {
    if (has(value, "matrix")) {
      return Eigen::Matrix4d(numbers(value, "matrix", std::vector<double>(16)).data());
    }
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    transform.translate(Eigen::Vector3d(numbers(value, "translation", {0, 0, 0}).data()));
    Eigen::Quaterniond rotation(numbers(value, "rotation", {0, 0, 0, 1}).data());
    if (rotation.norm() == 0) fail("is no rotation of length 1");
    transform.rotate(rotation.normalized());
    transform.scale(Eigen::Vector3d(numbers(value, "scale", {1, 1, 1}).data()));
    return transform.matrix();
  }
  GltfNode node(const Json& value) {
    return {name(value),
            indices(value, "children", nodes_),
            maybe_index(value, "mesh", document_.meshes.size()),
            maybe_index(value, "skin", skins_),
            transform(value),
            numbers(value, "weights", {})};
  }
  GltfSkin skin(const Json& value) {
    required(value, "joints");
    return {indices(value, "joints", nodes_),
            maybe_index(value, "inverseBindMatrices", document_.accessors.size())};
  }

  GltfMaterial material(const Json& value) {
    GltfMaterial material{name(value), Eigen::Matrix<double, 2, 3>::Identity()};
    const std::string glossy = "extensions/KHR_materials_pbrSpecularGlossiness/";
    for (const std::string& place : std::initializer_list<std::string>{
             "pbrMetallicRoughness/baseColorTexture", glossy + "diffuseTexture",
             glossy + "specularGlossinessTexture", "pbrMetallicRoughness/metallicRoughnessTexture",
             "normalTexture", "occlusionTexture", "emissiveTexture"}) {
      if (!has(value, place)) continue;
      const Json& picture = at(value, place);
      const Json& transform = at(picture, "extensions/KHR_texture_transform");
      if (count(transform, "texCoord", count(picture, "texCoord", 0)) != 0) continue;
      const Eigen::Vector2d scale(numbers(transform, "scale", {1, 1}).data());
      const Eigen::Vector2d offset(numbers(transform, "offset", {0, 0}).data());
      material.texture << Eigen::Rotation2Dd(-number(transform, "rotation", 0)).matrix() *
                              scale.asDiagonal(),
          offset;
      break;
    }
    return material;
  }

  GltfAnimation animation(const Json& value) {
    const std::size_t accessors = document_.accessors.size();
    required(value, "channels");
    const Json& samplers = required(value, "samplers");
    if (!samplers.is_array()) fail("expected an array");
    GltfAnimation animation{name(value), {}, {}};
    items(value, "channels", [&](const Json& channel) {
      required(channel, "target");
      const std::string extension = "target/extensions/KHR_animation_pointer";
      std::optional<std::pair<std::size_t, std::string>> target;  // node and property
      if (has(channel, "target/node")) {
        target = {index(channel, "target/node", nodes_), text(channel, "target/path")};
      } else if (has(channel, extension)) {
        required(channel, extension + "/pointer");
        const std::string pointer = name(channel, extension + "/pointer");
        target = pointed(pointer);
        const bool is_unread = !target && pointer.find("/weights") != std::string::npos;
        if (is_unread) animation.unread.push_back("'" + pointer + "'");
      }
      if (!target) return false;  // lights, materials and other targets
      const std::string sampler =
          "samplers/" + std::to_string(index(channel, "sampler", samplers.size())) + '/';
      animation.channels.push_back({target->first, target->second == "weights",
                                    index(value, sampler + "input", accessors),
                                    index(value, sampler + "output", accessors),
                                    text(value, sampler + "interpolation", "LINEAR")});
      return true;
    });
    return animation;
  }
  /// Reads a pointer such as "/nodes/3/weights"; none for pointers to other values.
  std::optional<std::pair<std::size_t, std::string>> pointed(const std::string& pointer) const {
    const std::string start = "/nodes/";
    if (!pointer.starts_with(start)) return {};
    std::size_t node = 0;
    std::from_chars(pointer.data() + start.size(), pointer.data() + pointer.size(), node);
    const std::string parent = start + std::to_string(node) + '/';
    const bool is_own = pointer.starts_with(parent) && pointer.rfind('/') == parent.size() - 1;
    if (!is_own || node >= nodes_) return {};
    return std::pair(node, pointer.substr(parent.size()));
  }

  void read_root(const Json& root, std::optional<std::string_view> binary) {
    const std::string version = text(root, "asset/version");
    if (!version.starts_with("2.")) fail("is glTF " + version + ", and only 2.0 is read");
    items(root, "extensionsRequired", [&](const Json& needed) {
      const std::string extension = text(needed, "");
      const bool is_known = std::ranges::count(kKnownGltfExtensions, extension) > 0;
      if (is_known || extension.starts_with("KHR_materials_")) return true;
      fail("needs the extension " + extension + ", which is not read; export without it");
    });
    document_.generator = text(root, "asset/generator", "");
    document_.rest_is_known = !flag(root, "asset/extras/restIsFirstFrame");
    // Only the first buffer may be the binary chunk.
    document_.buffers = items(root, "buffers", [&](const Json& value) {
      return buffer(value, std::exchange(binary, std::nullopt));
    });
    skins_ = at(root, "skins").size();
    nodes_ = at(root, "nodes").size();
    const auto read = [&](auto& list, const char* place, auto item) {
      list = items(root, place, [&](const Json& value) { return (this->*item)(value); });
    };
    read(document_.views, "bufferViews", &GltfParser::view);
    read(document_.accessors, "accessors", &GltfParser::accessor);
    read(document_.materials, "materials", &GltfParser::material);
    read(document_.meshes, "meshes", &GltfParser::mesh);
    read(document_.nodes, "nodes", &GltfParser::node);
    read(document_.skins, "skins", &GltfParser::skin);
    read(document_.animations, "animations", &GltfParser::animation);
    document_.roots = roots(root);
  }

  std::vector<std::size_t> roots(const Json& root) {
    const Json& scenes = at(root, "scenes");
    if (&scenes != &none() && !scenes.is_array()) fail("expected an array");
    if (!scenes.empty()) {
      const std::size_t shown = maybe_index(root, "scene", scenes.size()).value_or(0);
      if (scenes.size() > 1) {
        document_.notes.push_back(document_.path + ": scene " + std::to_string(shown) + " of " +
                                  std::to_string(scenes.size()) + " is read");
      }
      return indices(scenes[shown], "nodes", nodes_);
    }
    std::vector<std::size_t> parents(nodes_, 0), roots;
    for (const GltfNode& node : document_.nodes) {
      for (const std::size_t child : node.children) parents[child] += 1;
    }
    for (std::size_t n = 0; n < nodes_; ++n) {
      if (parents[n] == 0) roots.push_back(n);
    }
    return roots;
  }

  GltfDocument document_{};
  std::size_t nodes_ = 0, skins_ = 0;
  std::string item_, place_;
};

}  // namespace

GltfDocument read_gltf_document(const std::filesystem::path& path) {
  return GltfParser().read(path);
}

}  // namespace mimetra
