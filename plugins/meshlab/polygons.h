#pragma once

#include <common/meshmodel.h>

#include "plugins/meshlab/toolkit.h"

namespace mimetra_meshlab {

/// Fills in the faces of a mesh without deleted elements: polygons where MeshLab has marked inner
/// edges of triangles as faux. Each begins with the first vertex of its first triangle; triangles
/// whose marks enclose no simple polygon stay triangles.
void append_faces(const CMeshO& mesh, Frames& frames);

/// The polygons as fans of triangles whose inner edges are faux.
void add_polygons(const Frames& frames, CMeshO& mesh);

}  // namespace mimetra_meshlab
