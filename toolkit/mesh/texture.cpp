#include "toolkit/mesh/texture.h"

#include <algorithm>

namespace mimetra {

bool has_texture(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  return !texture.coordinates.empty() &&
         std::ranges::any_of(texture.corners, [](int coordinates) { return coordinates >= 0; });
}

std::optional<std::vector<Eigen::Vector2d>> texture_of_vertices(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  if (!has_texture(connectivity)) return std::nullopt;
  const auto vertices = static_cast<std::size_t>(connectivity.vertices);
  std::vector<Eigen::Vector2d> of_vertices(vertices, Eigen::Vector2d::Zero());
  std::vector<char> is_known(vertices, 0);
  for (std::size_t corner = 0; corner < texture.corners.size(); ++corner) {
    if (texture.corners[corner] < 0) continue;
    const auto vertex = static_cast<std::size_t>(connectivity.polygons.corners[corner]);
    const Eigen::Vector2d& found =
        texture.coordinates[static_cast<std::size_t>(texture.corners[corner])];
    if (is_known[vertex] && of_vertices[vertex] != found) return std::nullopt;
    of_vertices[vertex] = found;
    is_known[vertex] = 1;
  }
  return of_vertices;
}

}  // namespace mimetra
