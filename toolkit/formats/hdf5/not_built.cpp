#include "toolkit/formats/hdf5/hdf5_formats.h"
#include "toolkit/mesh/errors.h"

// In place of the other sources of this folder.

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNotBuilt =
    "HDF5 is not built into this program; build it with -DMIMETRA_HDF5=ON";

ReadValue refuse_to_read(const std::string& text, const ReadOptions&, const Context&) {
  throw IoError(text, kNotBuilt);
}

OpenSequence refuse_to_open(const fs::path& path, const ReadOptions&, const Context&) {
  throw IoError(path.string(), kNotBuilt);
}

Format::Paths refuse_to_write(const Data&, const fs::path& target, const WriteOptions&,
                              const Context&) {
  throw OutputError(target.string(), kNotBuilt);
}

}  // namespace

std::vector<Format> hdf5_formats() {
  return {
      {.name = "SPLOCS sequence (HDF5, not built)",
       .extensions = {".h5", ".hdf5"},
       .write = refuse_to_write,
       .open = refuse_to_open},
      {.name = "VTKHDF over time (not built)", .extensions = {".vtkhdf"}, .write = refuse_to_write},
      {.name = "SPLOCS components (HDF5, not built)",
       .kind = DataKind::components,
       .extensions = {".h5", ".hdf5"},
       .read = refuse_to_read,
       .write = refuse_to_write}};
}

}  // namespace mimetra
