#pragma once

#include <filesystem>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Reads a model of the eos library from two files: the shape model (version 1) and its
/// expressions. Keeps texture coordinates if there is one per vertex. Throws IoError; for another
/// version, the message contains the version. Internal to model_file.h.
MorphableModel read_eos(const std::filesystem::path& shape,
                        const std::filesystem::path& expressions);

/// True if the file starts like a shape model: a version that eos uses (1 to 4), then the size of a
/// mean.
bool is_eos_shape(const std::filesystem::path& path);

}  // namespace mimetra
