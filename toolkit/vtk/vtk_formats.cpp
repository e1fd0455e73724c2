#include <mimetra/vtk/vtk_formats.h>

#include <cmath>

#include <mimetra/io/frame_files.h>
#include <mimetra/io/pending_output.h>
#include <mimetra/mesh/parallel.h>
#include <mimetra/operations/formats.h>
#include <mimetra/vtk/picture.h>
#include <mimetra/vtk/render_operation.h>
#include <mimetra/vtk/report_operation.h>
#include <mimetra/vtk/vtp_series.h>

namespace mimetra {

namespace {

std::vector<std::filesystem::path> write(const FieldSequence& fields, const WriteRequest& request) {
  VtpOptions options;
  options.compression =
      request.parameters.text("compress") == "small" ? VtpCompression::zlib : VtpCompression::lz4;
  options.overwrite = request.overwrite;
  options.threads = request.threads;
  options.progress = request.progress;
  return write_with_extra(request,
                          [&] { return write_vtp_series(fields, request.target, options); });
}

std::vector<std::filesystem::path> write_picture(const Data& data, const WriteRequest& request) {
  return write_with_extra(request, [&] {
    write_file(request.target, png_of(std::get<Image>(data)), request.overwrite);
    return std::vector{request.target};
  });
}

std::vector<std::filesystem::path> write_pictures(const Data& data, const WriteRequest& request) {
  const auto& pictures = std::get<Pictures>(data);
  PendingOutput folder(request.target, PendingOutput::Kind::folder, request.overwrite);
  const auto name = [&](int i) { return frame_name(i, pictures.count, ".png"); };
  const auto write_one = [&](int i) {
    write_bytes(folder.path() / name(i), png_of(pictures.draw(i)));
  };
  parallel_for(pictures.count, request.threads, write_one, request.progress);
  for (const auto& [extra, content] : request.extra) write_bytes(folder.path() / extra, content);
  folder.commit();
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < pictures.count; ++i) files.push_back(request.target / name(i));
  return files;
}

std::vector<std::filesystem::path> write_page(const Data& data, const WriteRequest& request) {
  return write_with_extra(request, [&] {
    write_file(request.target, std::get<Page>(data).html, request.overwrite);
    return std::vector{request.target};
  });
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

void add_vtk(OperationTable& table) {
  const std::vector<Parameter> parameters = {{"compress",
                                              ParameterKind::choice,
                                              "fast",
                                              "compression of .vtp: fast (LZ4) or small (zlib)",
                                              "",
                                              {},
                                              {},
                                              {"fast", "small"}}};
  table.add(Writer{DataKind::regions,
                   {".pvd", ".vtp"},
                   parameters,
                   [](const Data& data, const WriteRequest& request) {
                     return write(std::get<RegionData>(data).fields, request);
                   }});
  table.add(Writer{DataKind::fields,
                   {".vtp", ".pvd"},
                   parameters,
                   [](const Data& data, const WriteRequest& request) {
                     return write(std::get<FieldSequence>(data), request);
                   }});
  table.add(RegionReader{{".vtp"}, read_regions_from_vtp});
  table.add(FieldReader{{".pvd", ".vtp", ".series"}, read_vtp_series, vtp_series_files});
  table.add(Writer{DataKind::picture, {".png"}, {}, write_picture});
  table.add(Writer{DataKind::pictures, {""}, {}, write_pictures});
  table.add(Writer{DataKind::page, {".html"}, {}, write_page});
  table.add(render_operation());
  table.add(report_operation());
}

}  // namespace mimetra
