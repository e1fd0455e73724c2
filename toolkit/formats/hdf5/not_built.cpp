#include "toolkit/formats/hdf5/hdf5_formats.h"

// In place of the other sources of this folder.

namespace mimetra {

std::vector<Format> hdf5_formats() {
  const auto missing = [](std::string name, DataKind kind, std::vector<std::string> extensions) {
    return Format{.name = std::move(name),
                  .kind = kind,
                  .extensions = std::move(extensions),
                  .built_by = "MIMETRA_HDF5"};
  };
  return {missing("SPLOCS sequence (HDF5)", DataKind::sequence, {".h5", ".hdf5"}),
          missing("VTKHDF over time", DataKind::sequence, {".vtkhdf"}),
          missing("VTKHDF over time with region fields", DataKind::regions, {".vtkhdf"}),
          missing("SPLOCS components (HDF5)", DataKind::components, {".h5", ".hdf5"})};
}

}  // namespace mimetra
