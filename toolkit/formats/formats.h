#pragma once

#include <filesystem>
#include <vector>

#include "toolkit/io/format.h"

namespace mimetra {

/// The table of file formats, in the order of lists for users. VTK, pictures and landmarks add
/// theirs to a program's OperationTable.
const std::vector<Format>& formats();

/// Format of sequences in a folder of mesh files.
const Format& folder_of_meshes();
/// Format of a path's extension whose sequences are read or written frame by frame, or that is not
/// built; null if there is none.
const Format* sequence_format(const std::filesystem::path& path);

}  // namespace mimetra
