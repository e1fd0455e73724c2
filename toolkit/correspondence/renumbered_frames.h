#pragma once

#include <memory>

#include "toolkit/correspondence/renumbering.h"
#include "toolkit/mesh/fields.h"

namespace mimetra {

/// The frames and the rest pose of a sequence as vertices of another mesh, carried when they are
/// read: vertex v is vertices[v] of the source. Throws std::invalid_argument unless there is one of
/// them for each vertex of the connectivity.
std::shared_ptr<const FrameSource> renumbered(std::shared_ptr<const FrameSource> source,
                                              std::shared_ptr<const Connectivity> connectivity,
                                              std::vector<VertexIndex> vertices);

/// The values of a field of the vertices, likewise. \pre of the vertices
Field renumbered(const Field& field, const std::vector<VertexIndex>& vertices);

}  // namespace mimetra
