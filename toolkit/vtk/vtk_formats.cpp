#include "toolkit/vtk/vtk_formats.h"

#include "toolkit/operations/formats.h"
#include "toolkit/vtk/vtp_formats.h"

namespace mimetra {

void add_vtk(OperationTable& table) {
  add_vtp(table);
  table.add(Format{.name = "script for ParaView",
                   .kind = DataKind::document,
                   .extensions = {".py"},
                   .write = write_document});
}

}  // namespace mimetra
