#include "toolkit/pipeline/moving_parts.h"

#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/triangle_quality.h"
#include "toolkit/splocs/decomposition_options.h"

namespace mimetra {

std::vector<VertexIndex> moving_vertices(const FrameSource& sequence) {
  const std::vector<VertexIndex> surface = surface_vertices(sequence.rest(), sequence.triangles());
  const double least = kLeastMotion * sequence.diameter();
  std::vector<bool> moves(surface.size(), false);
  for (int f = 0; f < sequence.frames(); ++f) {
    const FrameBlock block(sequence, f, 1);
    const PositionsView pose = block.frame(0);
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const VertexIndex v = surface[i];
      if ((pose.row(v) - sequence.rest().row(v)).squaredNorm() > least * least) moves[i] = true;
    }
  }
  std::vector<VertexIndex> moving;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (moves[i]) moving.push_back(surface[i]);
  }
  return moving;
}

MovingParts moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                         const Triangles& triangles) {
  const double size = diameter_of_parts(rest, triangles, moving);
  MovingParts found{{}, size};
  if (moving.empty()) return found;
  const SurfaceParts parts = surface_parts(rest, triangles);
  if (size < diameter(rest, triangles)) {
    found.vertices.assign(static_cast<std::size_t>(rest.rows()), false);
    for (const VertexIndex v : vertices_of_parts(parts, moving)) found.vertices[v] = true;
  }
  const Subject subject = subject_around(rest, parts, moving);
  if (subject.is_section) {
    found.is_section = true;
    found.diameter = subject.growth() * diameter(rest(moving, Eigen::all));
  }
  return found;
}

}  // namespace mimetra
