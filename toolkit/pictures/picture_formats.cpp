#include "toolkit/pictures/picture_formats.h"

#include "toolkit/drawing/picture.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/operations/formats.h"
#include "toolkit/pictures/render_operation.h"
#include "toolkit/pictures/table_chart.h"

namespace mimetra {

namespace {

std::vector<std::filesystem::path> write_picture(const Data& data, const WriteRequest& request,
                                                 const Context&) {
  return write_text(request, png_of(std::get<Pictures>(data).draw(0)));
}

std::vector<std::filesystem::path> write_table(const Data& data, const WriteRequest& request,
                                               const Context&) {
  return write_text(request, png_of(draw({chart_of(std::get<Table>(data))})));
}

std::vector<std::filesystem::path> write_pictures(const Data& data, const WriteRequest& request,
                                                  const Context& context) {
  const auto& pictures = std::get<Pictures>(data);
  PendingOutputs outputs(request.overwrite, request.inputs, request.together);
  const std::filesystem::path folder = outputs.add(request.target, PendingOutput::Kind::folder);
  const auto name = [&](int i) { return frame_name(i, pictures.count, ".png"); };
  const auto write_one = [&](int i) { write_bytes(folder / name(i), png_of(pictures.draw(i))); };
  parallel_for(pictures.count, write_one, context);
  for (const auto& [extra, content] : request.extra) write_bytes(folder / extra, content);
  outputs.commit();
  std::vector<std::filesystem::path> files;
  files.reserve(static_cast<std::size_t>(pictures.count));
  for (int i = 0; i < pictures.count; ++i) files.push_back(request.target / name(i));
  return files;
}

}  // namespace

void add_pictures(OperationTable& table) {
  table.add(Format{.name = "picture",
                   .kind = DataKind::pictures,
                   .extensions = {".png"},
                   .write = write_picture});
  table.add(Format{.name = "folder of pictures",
                   .kind = DataKind::pictures,
                   .extensions = {Format::kFolder},
                   .write = write_pictures});
  table.add(Format{.name = "picture of a table",
                   .kind = DataKind::table,
                   .extensions = {".png"},
                   .write = write_table});
  table.add(render_operation());
}

}  // namespace mimetra
