#include <mimetra/vtk/vtk_formats.h>

#include <mimetra/io/frame_files.h>
#include <mimetra/io/pending_output.h>
#include <mimetra/mesh/parallel.h>
#include <mimetra/operations/formats.h>
#include <mimetra/vtk/paraview_view.h>
#include <mimetra/vtk/picture.h>
#include <mimetra/vtk/render_operation.h>
#include <mimetra/vtk/report_operation.h>
#include <mimetra/vtk/vtp_formats.h>

namespace mimetra {

namespace {

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

std::vector<std::filesystem::path> write_text(const std::string& text,
                                              const WriteRequest& request) {
  return write_with_extra(request, [&] {
    write_file(request.target, text, request.overwrite);
    return std::vector{request.target};
  });
}

std::vector<std::filesystem::path> write_view(const Data& data, const WriteRequest& request) {
  return write_text(paraview_view(std::get<RegionView>(data)), request);
}

std::vector<std::filesystem::path> write_page(const Data& data, const WriteRequest& request) {
  return write_text(std::get<Page>(data).html, request);
}

}  // namespace

void add_vtk(OperationTable& table) {
  add_vtp(table);
  table.add(Writer{DataKind::picture, {".png"}, {}, write_picture});
  table.add(Writer{DataKind::pictures, {""}, {}, write_pictures});
  table.add(Writer{DataKind::view, {".py"}, {}, write_view});
  table.add(Writer{DataKind::page, {".html"}, {}, write_page});
  table.add(render_operation());
  table.add(report_operation());
}

}  // namespace mimetra
