#include "toolkit/correspondence/polygon_split.h"

#include <numeric>
#include <vector>

#include "toolkit/mesh/face_order.h"

namespace mimetra {
namespace {

int corners_of(const Polygons& polygons, int face) {
  return polygons.offsets[face + 1] - polygons.offsets[face];
}

}  // namespace

std::optional<Polygons> joined_like(const Polygons& coarse, const Polygons& fine) {
  Polygons joined;
  int at = 0;
  for (int face = 0; face < coarse.size(); ++face) {
    // A polygon of c corners is worth c - 2 triangles.
    int wanted = corners_of(coarse, face) - 2;
    const int first = at;
    for (; wanted > 0 && at < fine.size(); ++at) wanted -= corners_of(fine, at) - 2;
    if (wanted != 0) return {};
    std::vector<int> faces(static_cast<std::size_t>(at - first));
    std::iota(faces.begin(), faces.end(), first);
    const std::vector<VertexIndex> cycle = outline(fine, faces);
    if (static_cast<int>(cycle.size()) != corners_of(coarse, face)) return {};
    joined.corners.insert(joined.corners.end(), cycle.begin(), cycle.end());
    joined.offsets.push_back(static_cast<int>(joined.corners.size()));
  }
  if (at != fine.size()) return {};
  return joined;
}

}  // namespace mimetra
