#pragma once

#include <vector>

#include "toolkit/io/format.h"

namespace mimetra {

/// SPLOCS sequences.
Format splocs_format();

/// All formats in HDF5: sequences and components of SPLOCS, and VTKHDF, with region fields, too.
std::vector<Format> hdf5_formats();

}  // namespace mimetra
