#include "toolkit/vtk/vtp_formats.h"

#include <cmath>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/operations/formats.h"
#include "toolkit/vtk/vtp_series.h"

namespace mimetra {

namespace {

std::vector<std::filesystem::path> write(const FieldSequence& fields, const WriteRequest& request) {
  VtpOptions options;
  options.compression = request.parameters.choice<VtpCompression>("compress");
  options.overwrite = request.overwrite;
  options.inputs = request.inputs;
  options.threads = request.threads;
  options.progress = request.progress;
  return write_with_extra(request,
                          [&] { return write_vtp_series(fields, request.target, options); });
}

/// Regions on their sequence, which is in memory from now on.
FieldSequence shown_regions(const RegionData& regions, const WriteRequest& request) {
  FieldSequence shown = regions.fields;
  if (regions.stream) shown.sequence = MeshSequence(*regions.stream, {.threads = request.threads});
  return shown;
}

/// One region: the vertices where the field `roi` is not 0.
Regions read_regions_from_vtp(const std::filesystem::path& path, int vertices,
                              const Triangles& triangles) {
  const Eigen::MatrixXd mask = read_vtp_field(path, "roi");
  if (mask.rows() != vertices) {
    throw MismatchError(path.string() + ": " + std::to_string(mask.rows()) +
                        " vertices, expected " + std::to_string(vertices) + " as in the source");
  }
  std::vector<VertexIndex> inside;
  for (int v = 0; v < vertices; ++v) {
    if (!std::isfinite(mask(v, 0))) {
      throw IoError(path.string(), "the field 'roi' of vertex " + std::to_string(v) + " is " +
                                       std::to_string(mask(v, 0)) + ", expected 0 or 1");
    }
    if (mask(v, 0) != 0) inside.push_back(v);
  }
  return regions_from_vertices(vertices, triangles, {inside});
}

}  // namespace

void add_vtp(OperationTable& table) {
  const std::vector<Parameter> parameters = {choice_parameter(
      "compress", VtpOptions{}.compression, "compression of .vtp: fast (LZ4) or small (zlib)")};
  table.add(Writer{DataKind::regions,
                   {".pvd", ".vtp"},
                   parameters,
                   [](const Data& data, const WriteRequest& request) {
                     const FieldSequence shown = shown_regions(std::get<RegionData>(data), request);
                     if (shown.sequence.frames() > 0) return write(shown, request);
                     throw MismatchError(request.target.string() +
                                         ": the regions come without a mesh to show them on; "
                                         "write .json or .csv");
                   },
                   true});
  table.add(Writer{DataKind::fields,
                   {".vtp", ".pvd"},
                   parameters,
                   [](const Data& data, const WriteRequest& request) {
                     return write(std::get<FieldSequence>(data), request);
                   }});
  table.add(RegionReader{{".vtp"}, read_regions_from_vtp});
  const auto read = [](const std::filesystem::path& path, const auto& selected,
                       const Progress& progress) {
    return read_vtp_series(path, {.selected = selected, .progress = progress});
  };
  table.add(FieldReader{{".pvd", ".vtp", ".series"}, read, vtp_series_files});
}

}  // namespace mimetra
