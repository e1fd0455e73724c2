#pragma once

#include <filesystem>
#include <vector>

#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"

namespace mimetra {

/// Writes a sequence with its fields as VTKHDF: PolyData over time, faces and fields once,
/// positions (float32, or float64 by option or far from the origin) and displacements for each
/// step. Streamed and atomic; returns the files. Throws what reading the frames throws,
/// OutputError, Cancelled, MismatchError for what float32 cannot hold, and std::invalid_argument
/// for fields that do not fit the mesh, or two of one name.
///
/// [Kitware. VTKHDF File Format, version 2.0]
std::vector<std::filesystem::path> write_vtkhdf(const FieldSequence& sequence,
                                                const std::filesystem::path& target,
                                                const SequenceWriteOptions& = {},
                                                const ExtraFiles& extra = {},
                                                const Context& context = {});

}  // namespace mimetra
