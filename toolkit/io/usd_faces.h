#pragma once

#include <string>

#include "toolkit/io/scene.h"
#include "toolkit/io/usd_text.h"

/// Faces of a mesh of USD. Internal to the format.
namespace mimetra {

/// The faces that the mesh `prim` shows, with texture coordinates, where `part` has its points.
/// Throws IoError with the line of what does not fit.
void fill_usd_faces(const std::string& path, const UsdPrim& prim, ScenePart& part);

/// Turns the faces, each with the coordinates of its corners.
void turn_faces(ScenePart& part);

}  // namespace mimetra
