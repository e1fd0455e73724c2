#pragma once

#include <filesystem>

#include "toolkit/io/format.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// Writes components as HDF5 in the layout of the reference implementation: `default` (N x 3),
/// `tris` and `comp000`, ... (rest + component). Adds `C`, `W`, `centers`, `support` and
/// `energies`; the options, `iteration` and `converged` are attributes. Atomic; returns the files.
/// Throws OutputError.
Format::Paths write_components(const std::filesystem::path& path, const Components& components,
                               const WriteOptions& = {});

/// Reads components from HDF5. In files of the reference implementation, weights, support and
/// energies are empty, and iteration and converged are unknown. Missing centers are recomputed: the
/// vertex that a component moves most, -1 if it moves none. Throws IoError.
Components read_components(const std::filesystem::path& path);

}  // namespace mimetra
