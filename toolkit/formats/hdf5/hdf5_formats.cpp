#include "toolkit/formats/hdf5/hdf5_formats.h"

#include "toolkit/formats/hdf5/components_file.h"
#include "toolkit/formats/hdf5/vtkhdf_file.h"
#include "toolkit/io/file_parameters.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using Paths = Format::Paths;

Paths write_vtkhdf_sequence(const Data& data, const fs::path& target, const WriteOptions& options,
                            const Context& context) {
  FieldSequence sequence = std::get<FieldSequence>(data);
  show_displacement(sequence);
  return write_vtkhdf(sequence, target, options, context);
}

Paths write_vtkhdf_regions(const Data& data, const fs::path& target, const WriteOptions& options,
                           const Context& context) {
  return write_vtkhdf(shown_regions(data, target), target, options, context);
}

ReadValue read_components_data(const std::string& text, const ReadOptions&, const Context&) {
  return {{text, read_components(text)}, {text}};
}

Paths write_components_data(const Data& data, const fs::path& target, const WriteOptions& options,
                            const Context&) {
  return write_components(target, std::get<Components>(data), options);
}

}  // namespace

std::vector<Format> hdf5_formats() {
  return {splocs_format(),
          {.name = "VTKHDF over time",
           .extensions = {".vtkhdf"},
           .writing = writing_parameters({"double"}),
           .write = write_vtkhdf_sequence,
           .fields = true,
           .displacements = true,
           .holds = [](const WriteOptions&) { return HeldParts{.polygons = true}; }},
          {.name = "VTKHDF over time with region fields",
           .kind = DataKind::regions,
           .extensions = {".vtkhdf"},
           .writing = writing_parameters({"double"}),
           .write = write_vtkhdf_regions},
          {.name = "SPLOCS components (HDF5)",
           .kind = DataKind::components,
           .extensions = {".h5", ".hdf5"},
           .read = read_components_data,
           .write = write_components_data}};
}

}  // namespace mimetra
