#pragma once

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/operations/data.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// A sequence's rest pose or a model's neutral as a head, with the landmarks that a file
/// landmarks68.txt or ibug_to_*.txt beside it names (the first where there is a landmarks68.txt;
/// not with `ignore_files`). A file that names vertices which the mesh has not is of another mesh:
/// that is said, and it is left out. Throws IoError for a file that is no mapping.
Head head_of(const NamedData& value, const Log& log, bool ignore_files = false);

}  // namespace mimetra
