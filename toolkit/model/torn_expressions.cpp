#include "toolkit/model/torn_expressions.h"

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/stray_vertices.h"
#include "toolkit/mesh/triangle_quality.h"

namespace mimetra {

std::vector<std::string> torn_expressions(const Positions& neutral, const Triangles& triangles,
                                          const ShapeBasis& expressions) {
  constexpr double kTurned = 0.1;
  const Triangles sound = with_area(neutral, triangles);
  if (sound.rows() == 0) return {};
  const StrayVertices strays(neutral, sound);
  const Positions normals = triangle_normals(neutral, sound);
  const Eigen::VectorXd areas = normals.rowwise().norm();
  const double size = diameter(neutral, triangles);
  std::vector<std::string> torn;
  for (int j = 0; j < expressions.size(); ++j) {
    const auto field = expressions.displacements.col(j);
    const Eigen::Map<const Positions> moves(field.data(), neutral.rows(), 3);
    const Positions pose = neutral + moves;
    const Eigen::VectorXd along =
        triangle_normals(pose, sound).cwiseProduct(normals).rowwise().sum();
    const double turned = (along.array() < 0).select(areas, 0).sum();
    VertexIndex farthest = 0;
    const double distance =
        strays.distances(PositionsView(pose.data(), pose.rows(), 3)).maxCoeff(&farthest);
    if (turned > kTurned * areas.sum() || strays.is_torn_off(farthest, distance, size)) {
      torn.push_back(expressions.names[static_cast<std::size_t>(j)]);
    }
  }
  return torn;
}

}  // namespace mimetra
