#include "toolkit/vtk/vtk_formats.h"

#include "toolkit/operations/formats.h"
#include "toolkit/vtk/vtp_formats.h"

namespace mimetra {

void add_vtk(OperationTable& table) {
  add_vtp(table);
  table.add(
      Writer{DataKind::document, {".py"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, std::get<Document>(data).text);
             }});
}

}  // namespace mimetra
