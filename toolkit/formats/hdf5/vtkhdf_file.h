#pragma once

#include <filesystem>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"

namespace mimetra {

/// Writes a sequence with its fields as VTKHDF: PolyData over time, faces and fields once,
/// positions and displacements for each step. Numbers of a step are float32, or float64 by option
/// or if the rest pose is far from the origin. Streamed and atomic; returns the files.
///
/// Throws OutputError, Cancelled, the errors of reading the frames, and MismatchError for positions
/// that float32 cannot hold. Throws std::invalid_argument for fields that do not fit the mesh, and
/// for two fields with one name.
///
/// [Kitware. VTKHDF File Format, version 2.0]
std::vector<std::filesystem::path> write_vtkhdf(const FieldSequence& sequence,
                                                const std::filesystem::path& target,
                                                const WriteOptions& = {},
                                                const Context& context = {});

}  // namespace mimetra
