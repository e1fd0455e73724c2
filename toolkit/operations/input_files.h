#pragma once

#include <filesystem>
#include <vector>

#include "toolkit/mesh/context.h"

namespace mimetra {

/// The files of what was named: files, what is read of models, and the files below other folders,
/// those of each in order of their names.
std::vector<std::filesystem::path> input_files(const std::vector<std::filesystem::path>& inputs);

/// Compares the files of all ranks with the first one's by their number, sizes, and first and last
/// 64 kB. Throws MismatchError on ranks that have others.
void check_same_inputs(const std::vector<std::filesystem::path>& inputs, const Context& context);

}  // namespace mimetra
