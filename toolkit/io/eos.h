#pragma once

#include <filesystem>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Reads a pair of files of the eos library: the shape model (version 1) and its expressions.
/// Texture coordinates are kept where there is one for each vertex. Throws IoError that names the
/// version of a later one. Internal to model_file.h.
MorphableModel read_eos(const std::filesystem::path& shape,
                        const std::filesystem::path& expressions);

/// True where the file starts like a shape model: a version known to eos, then the size of a mean.
bool is_eos_shape(const std::filesystem::path& path);

}  // namespace mimetra
