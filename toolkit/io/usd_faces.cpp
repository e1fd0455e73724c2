#include "toolkit/io/usd_faces.h"

#include <algorithm>
#include <utility>

#include "toolkit/io/usd_values.h"

namespace mimetra {
namespace {

std::vector<int> counts_of(const std::string& path, const UsdPrim& prim, const std::string& name) {
  const UsdProperty& property = usd_needed(path, prim, name);
  for (const auto& [time, value] : property.samples) {
    if (value.numbers == property.samples.front().second.numbers) continue;
    usd_fail(path, property.line, name + " change over time, which is not read");
  }
  return usd_integers(path, property, name);
}

/// Without the faces that are not shown, and the coordinates of their corners.
void leave_out_holes(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  const UsdProperty* holes = usd_property(prim, "holeIndices");
  if (!holes) return;
  std::vector<bool> is_hole(static_cast<std::size_t>(part.polygons.size()), false);
  for (const int face : counts_of(path, prim, "holeIndices")) {
    if (face >= part.polygons.size()) {
      usd_fail(path, holes->line,
               "face " + std::to_string(face) + " of " + std::to_string(part.polygons.size()) +
                   " is no hole");
    }
    is_hole[static_cast<std::size_t>(face)] = true;
  }
  const Polygons all = std::exchange(part.polygons, {});
  const std::vector<int> texture = std::exchange(part.texture.corners, {});
  for (std::size_t face = 0; face < is_hole.size(); ++face) {
    if (is_hole[face]) continue;
    const int begin = all.offsets[face], end = all.offsets[face + 1];
    const auto append = [begin, end](std::vector<int>& to, const std::vector<int>& from) {
      to.insert(to.end(), from.begin() + begin, from.begin() + end);
    };
    append(part.polygons.corners, all.corners);
    if (!texture.empty()) append(part.texture.corners, texture);
    part.polygons.offsets.push_back(static_cast<int>(part.polygons.corners.size()));
  }
}

/// `primvars:st`, or the first that has the type of texture coordinates.
std::string texture_name(const UsdPrim& prim) {
  if (usd_property(prim, "primvars:st")) return "primvars:st";
  for (const auto& [name, property] : prim.properties) {
    if (name.starts_with("primvars:") && property.type.starts_with("texCoord2")) return name;
  }
  return {};
}

void fill_texture(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  const std::string name = texture_name(prim);
  if (name.empty()) return;
  const UsdProperty& texture = *usd_property(prim, name);
  const std::vector<double> numbers = usd_numbers(path, texture);
  if (numbers.size() % 2 != 0) usd_fail(path, texture.line, "a texture coordinate has no v");
  const std::size_t corners = part.polygons.corners.size();
  const bool by_corner = texture.interpolation == "faceVarying";
  if (!by_corner && texture.interpolation != "vertex" && texture.interpolation != "varying") {
    return;  // one for a whole face, or for the mesh
  }
  const std::size_t wanted = by_corner ? corners : static_cast<std::size_t>(part.positions.rows());
  std::vector<int> index;
  if (const UsdProperty* indices = usd_property(prim, name + ":indices")) {
    index = usd_integers(path, *indices, name + ":indices");
  } else {
    for (std::size_t i = 0; i < numbers.size() / 2; ++i) index.push_back(static_cast<int>(i));
  }
  if (index.size() != wanted) {
    usd_fail(
        path, texture.line,
        std::to_string(index.size()) + " texture coordinates, expected " + std::to_string(wanted));
  }
  for (const int i : index) {
    if (static_cast<std::size_t>(i) >= numbers.size() / 2) {
      usd_fail(path, texture.line, "there is no texture coordinate " + std::to_string(i));
    }
  }
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    part.texture.coordinates.emplace_back(numbers[i], numbers[i + 1]);
  }
  for (std::size_t corner = 0; corner < corners; ++corner) {
    const auto vertex = static_cast<std::size_t>(part.polygons.corners[corner]);
    part.texture.corners.push_back(index[by_corner ? corner : vertex]);
  }
}

}  // namespace

void turn_faces(ScenePart& part) {
  for (int face = 0; face < part.polygons.size(); ++face) {
    const auto begin = part.polygons.offsets[static_cast<std::size_t>(face)];
    const auto end = part.polygons.offsets[static_cast<std::size_t>(face) + 1];
    std::reverse(part.polygons.corners.begin() + begin + 1, part.polygons.corners.begin() + end);
    if (part.texture.corners.empty()) continue;
    std::reverse(part.texture.corners.begin() + begin + 1, part.texture.corners.begin() + end);
  }
}

void fill_usd_faces(const std::string& path, const UsdPrim& prim, ScenePart& part) {
  part.polygons.corners = counts_of(path, prim, "faceVertexIndices");
  std::size_t all = 0;
  const UsdProperty& counts = usd_needed(path, prim, "faceVertexCounts");
  for (const int count : counts_of(path, prim, "faceVertexCounts")) {
    all += static_cast<std::size_t>(count);
    if (all > part.polygons.corners.size()) break;
    part.polygons.offsets.push_back(static_cast<int>(all));
  }
  if (all != part.polygons.corners.size()) {
    usd_fail(path, counts.line,
             "the faces have other corners than the " +
                 std::to_string(part.polygons.corners.size()) + " that are named");
  }
  for (const int corner : part.polygons.corners) {
    if (corner < part.positions.rows()) continue;
    usd_fail(path, usd_needed(path, prim, "faceVertexIndices").line,
             "a face uses point " + std::to_string(corner) + " of " +
                 std::to_string(part.positions.rows()));
  }
  fill_texture(path, prim, part);
  leave_out_holes(path, prim, part);
  if (usd_is_word(prim, "orientation", "leftHanded")) turn_faces(part);
}

}  // namespace mimetra
