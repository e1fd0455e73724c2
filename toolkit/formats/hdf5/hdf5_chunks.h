#pragma once

#include <cstdint>
#include <vector>

#include "toolkit/formats/hdf5/hdf5_fields.h"

/// Blocks of a dataset, which HDF5 calls chunks. Internal to the reader of HDF5.
namespace mimetra {

struct Hdf5Chunk {
  std::uint64_t address = kNowhere;
  std::uint64_t stored_bytes = 0;
  /// Bit i is set if filter i was not applied.
  std::uint64_t left_out = 0;
};

/// Blocks of equal size. The last ones of a dimension may reach beyond the dataset.
struct Hdf5Grid {
  std::vector<std::uint64_t> sizes;    ///< numbers of the dataset in each dimension
  std::vector<std::uint64_t> extents;  ///< numbers of a block in each dimension, not 0
  std::vector<std::uint64_t> counts;   ///< blocks in each dimension
  std::vector<std::uint64_t> most;     ///< blocks that may be added up to, kNowhere if unlimited
  std::uint64_t block_bytes;           ///< without filters

  std::uint64_t count() const;
};

/// Finds all blocks in C order; fewer if some are missing. A dataset of HDF5's default format lists
/// them in a B-tree of version 1. Throws IoError.
std::vector<Hdf5Chunk> hdf5_chunks_of_tree(const Hdf5Bytes& file, const Hdf5Grid& grid,
                                           std::uint64_t tree);

/// Same for the latest format. `layout` are the fields of the layout message after the extents.
std::vector<Hdf5Chunk> hdf5_chunks_of_index(const Hdf5Bytes& file, const Hdf5Grid& grid,
                                            Hdf5Fields layout, std::uint64_t flags,
                                            bool is_filtered);

}  // namespace mimetra
