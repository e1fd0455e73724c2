#pragma once

#include <filesystem>

#include "toolkit/splocs/decomposition.h"

namespace mimetra {

class PendingOutputs;

/// Writes components as HDF5 in the layout of the reference implementation (`default` N x 3,
/// `tris`, `comp000` ... = rest + component) plus `C`, `W`, `centers`, `support`, `energies` and
/// the options, `iteration` and `converged` as attributes. Atomic. Throws OutputError.
void write_components(const std::filesystem::path& path, const Components& components,
                      bool overwrite, PendingOutputs* together = nullptr);

/// Reads them back; what a file of the reference lacks is empty (weights, support, energies),
/// unknown (iteration, converged) or recomputed (centers: the vertex each component moves most).
/// Throws IoError.
Components read_components(const std::filesystem::path& path);

}  // namespace mimetra
